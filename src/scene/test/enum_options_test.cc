// Options whose values are enums: their names in files, in programs and in messages.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gloam/options.h"
#include "gloam/scene.h"
#include "gloam/text.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <NamedEnum Enum>
void expect_names_to_come_back() {
  for (const std::string& name : enum_names<Enum>()) {
    const Result<Enum> value = enum_named<Enum>(name);
    ASSERT_TRUE(value.ok()) << name;
    EXPECT_EQ(to_string(*value), name);
  }
  EXPECT_FALSE(find_enum<Enum>("").has_value());
  EXPECT_FALSE(enum_named<Enum>("").ok());
  EXPECT_STREQ(to_string(std::optional<Enum>()), "");
}

TEST(EnumOptions, NamesComeBack) {
  expect_names_to_come_back<RenderTier>();
  expect_names_to_come_back<RenderDevice>();
  expect_names_to_come_back<RenderLook>();
  expect_names_to_come_back<LightType>();
}

TEST(EnumOptions, UnknownNamesAreErrorsWithASuggestion) {
  const Result<RenderTier> far = enum_named<RenderTier>("raster");
  ASSERT_FALSE(far.ok());
  EXPECT_EQ(far.error().message, "there is no render tier 'raster'");
  EXPECT_EQ(far.error().hint, "one of: path, interactive, direct");
  const Result<RenderDevice> near = enum_named<RenderDevice>("cud");
  ASSERT_FALSE(near.ok());
  EXPECT_EQ(near.error().message, "there is no render device 'cud'");
  EXPECT_EQ(near.error().hint, "did you mean 'cuda'?");
  EXPECT_FALSE(enum_named<RenderLook>("Studio").ok()) << "names have one spelling";
}

TEST(EnumOptions, AreReadAndWrittenByName) {
  Scene scene;
  ASSERT_TRUE(set_option(scene, "render.tier", "direct").ok());
  ASSERT_TRUE(set_option(scene, "render.device", "\"cuda\"").ok());
  ASSERT_TRUE(set_option(scene, "render.look", "studio").ok());
  EXPECT_EQ(scene.render.tier, RenderTier::kDirect);
  EXPECT_EQ(scene.render.device, RenderDevice::kCuda);
  EXPECT_EQ(scene.render.look, RenderLook::kStudio);
  EXPECT_THAT(*get_option(scene, "render.tier"), HasSubstr("direct"));
  const std::string text = to_toml(scene);
  EXPECT_THAT(text, HasSubstr("tier = 'direct'"));
  EXPECT_THAT(text, HasSubstr("device = 'cuda'"));
  EXPECT_THAT(text, HasSubstr("look = 'studio'"));
  EXPECT_THAT(set_option(scene, "render.look", "modle").error().to_string(),
              HasSubstr("'look' cannot be 'modle' (did you mean 'model'?)"));
}

// "" is the absent tier; the other options have no absent value.
TEST(EnumOptions, TheTierCanBeAbsent) {
  Scene scene;
  EXPECT_EQ(*get_option(scene, "render.tier"), "''");
  EXPECT_EQ(to_toml(scene).find("tier"), std::string::npos);
  EXPECT_EQ(scene.render.tier_or_default(true), RenderTier::kInteractive);
  EXPECT_EQ(scene.render.tier_or_default(false), RenderTier::kPath);
  scene.render.error = 0.1;
  EXPECT_EQ(scene.render.tier_or_default(true), RenderTier::kPath);
  scene.render.error.reset();
  scene.render.tier = RenderTier::kDirect;
  ASSERT_TRUE(set_option(scene, "render.tier", "\"\"").ok());
  EXPECT_EQ(scene.render.tier, std::nullopt);
  EXPECT_THAT(set_option(scene, "render.device", "\"\"").error().to_string(),
              HasSubstr("'device' cannot be ''"));
}

TEST(EnumOptions, ValuesOutsideOfTheEnumAreErrors) {
  Scene scene;
  scene.render.look = static_cast<RenderLook>(17);
  const Status status = validate_scene(scene);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().to_string(), HasSubstr("'look' of [render] cannot be ''"));
  EXPECT_THAT(status.error().to_string(), HasSubstr("auto, studio, model"));
}

TEST(EnumOptions, ListsFollowTheTables) {
  std::map<std::string, std::vector<std::string>> choices;
  for (const OptionInfo& option : list_options(Scene())) choices[option.path] = option.choices;
  EXPECT_THAT(choices["render.tier"], ElementsAre("path", "interactive", "direct"));
  EXPECT_THAT(choices["render.device"], ElementsAre("auto", "cpu", "cuda"));
  EXPECT_THAT(choices["render.look"], ElementsAre("auto", "studio", "model"));
}

}  // namespace
}  // namespace gloam
