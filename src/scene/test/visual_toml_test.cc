// [[visual]] tables and the bump maps of [[material]] tables.

#include <gmock/gmock.h>

#include "gloam/scene.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;

class VisualToml : public testing::Test {
 protected:
  VisualToml() {
    folder_.write("lamp.glb", "glTF");
    folder_.write("heights.png", "PNG");
  }
  Result<Scene> load(const std::string& text, const FileAccess& access = {}) {
    return load_scene(folder_.write("scene.toml", text), access);
  }
  /// The error of one visual with these further lines, "" if it loads.
  std::string error_of(const std::string& lines) {
    const auto scene = load("[[visual]]\nname = \"lamp\"\nfile = \"lamp.glb\"\n" + lines);
    return scene.ok() ? "" : scene.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(VisualToml, ReadsEveryField) {
  const auto scene = load(R"(
[[visual]]
name = "lamp"
file = "lamp.glb"
body = "table"
position = [1, 2, 3]
orientation = [0, 0, 0, 2]
scale = 0.5
up = "z"
unit = 0.001
casts_shadow = false
[[visual]]
name = "other"
file = "lamp.glb"
scale = [1, 2, 3]
[[material]]
name = "lamp/glass"
base_color = [0.5, 0.25, 1]
emission = [100, 100, 100]
bump = "heights.png"
bump_scale = 0.01
)");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  ASSERT_EQ(scene->visuals.size(), 2u);
  const VisualOptions& v = scene->visuals[0];
  EXPECT_EQ(v.name, "lamp");
  EXPECT_EQ(v.file, folder_.path() / "lamp.glb");
  EXPECT_EQ(v.body, "table");
  EXPECT_EQ(v.X_BV.p, (Vec3{1, 2, 3}));
  EXPECT_EQ(v.X_BV.q, (Quat{0, 0, 0, 1}));
  EXPECT_EQ(v.scale, (Vec3{0.5, 0.5, 0.5}));
  EXPECT_EQ(v.up, "z");
  EXPECT_EQ(v.unit, 0.001);
  EXPECT_FALSE(v.casts_shadow);
  EXPECT_EQ(v.loc.line, 2);
  EXPECT_EQ(scene->visuals[1].scale, (Vec3{1, 2, 3}));
  const MaterialOptions& m = scene->materials.at(0);
  EXPECT_EQ(m.bump, folder_.path() / "heights.png");
  EXPECT_EQ(m.bump_scale, 0.01);
  EXPECT_FALSE(m.coat_weight.has_value()) << "what is not said stays the file's";
}

TEST_F(VisualToml, RefusesWhatCannotBe) {
  EXPECT_EQ(error_of(""), "");
  EXPECT_THAT(error_of("scale = 0\n"),
              HasSubstr("'scale' of visual 'lamp' has a number that is zero"));
  EXPECT_EQ(error_of("scale = [1, -1, 1]\n"), "") << "mirrored";
  EXPECT_THAT(error_of("scale = [1, -1e9, 1]\n"), HasSubstr("'scale[1]' is -1"));
  EXPECT_THAT(error_of("scale = [1, 1]\n"), HasSubstr("must have 3 numbers"));
  EXPECT_THAT(error_of("scale = nan\n"), HasSubstr("'scale'"));
  EXPECT_THAT(error_of("up = \"w\"\n"), HasSubstr("'up' cannot be 'w'"));
  EXPECT_THAT(error_of("unit = 0\n"), HasSubstr("'unit' is 0"));
  EXPECT_THAT(error_of("positon = [0, 0, 0]\n"), HasSubstr("did you mean 'position'?"));
  EXPECT_THAT(error_of("[[visual]]\nname = \"lamp\"\nfile = \"lamp.glb\"\n"),
              HasSubstr("two visuals named 'lamp'"));
  EXPECT_THAT(error_of("[[visual]]\nname = \"b\"\nfile = \"lmp.glb\"\n"),
              HasSubstr("did you mean 'lamp.glb'?"));
  EXPECT_THAT(error_of("[[material]]\nname = \"m\"\nbump = \"none.png\"\n"),
              HasSubstr("there is no file 'none.png'"));
}

TEST_F(VisualToml, FilesLieInTheScenesRoot) {
  folder_.write("../outside.glb", "glTF");
  const std::string text = "[[visual]]\nname = \"lamp\"\nfile = \"../outside.glb\"\n";
  FileAccess strict;
  strict.strict = true;
  const auto scene = load(text, strict);
  ASSERT_FALSE(scene.ok());
  EXPECT_THAT(scene.error().to_string(), HasSubstr("outside the folder"));
  const auto bump = load(
      "[[visual]]\nname = \"a\"\nfile = \"lamp.glb\"\n[[material]]\nname = \"m\"\nbump = "
      "\"/etc/passwd\"\n",
      strict);
  ASSERT_FALSE(bump.ok());
  EXPECT_THAT(bump.error().to_string(), HasSubstr("outside the folder"));
}

TEST_F(VisualToml, OneOptionCanBeChanged) {
  auto scene = load("[[visual]]\nname = \"lamp\"\nfile = \"lamp.glb\"\n");
  ASSERT_TRUE(scene.ok());
  EXPECT_TRUE(set_option(*scene, "visual.lamp.scale", "[1, 2, 3]").ok());
  EXPECT_EQ(scene->visuals[0].scale, (Vec3{1, 2, 3}));
  EXPECT_TRUE(set_option(*scene, "visual.lamp.scale", "-1").ok()) << "mirrored";
  EXPECT_FALSE(set_option(*scene, "visual.lamp.scale", "-1e9").ok());
}

}  // namespace
}  // namespace gloam
