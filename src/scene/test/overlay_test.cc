// Overlays: scene files laid over a Scene.

#include <gmock/gmock.h>

#include "gloam/options.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;

constexpr const char* kBase = R"([[robot]]
name = "toy"
file = "toy.xml"
[weather]
visibility = 500
rain = 2
[[camera]]
name = "eye"
width = 64
height = 48
[[light]]
name = "lamp"
type = "spot"
position = [0, 0, 2]
look_at = [1, 0, 0]
flux = 700
angle = 24
[override.toy.joint.knee]
damping = 1
)";

class Overlays : public testing::Test {
 protected:
  Overlays() {
    folder_.write("toy.xml", "<mujoco/>");
    folder_.write("s.toml", kBase);
    scene_ = *load_scene(folder_.path() / "s.toml");
  }
  Result<Scene> over(const char* text) { return overlay_scene(scene_, text, "night.toml"); }

  TempFolder folder_;
  Scene scene_;
};

TEST_F(Overlays, ReplaceValuesAndJoinTables) {
  const auto scene = over("[weather]\nvisibility = 8\n[override.toy.joint.knee]\narmature = 2\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  EXPECT_EQ(scene->weather->visibility, 8);
  EXPECT_EQ(scene->weather->rain, 2);
  EXPECT_EQ(scene->overrides.size(), 2u);
  EXPECT_EQ(scene->name, scene_.name);
  EXPECT_EQ(scene->robots.front().file, scene_.robots.front().file);
}

TEST_F(Overlays, ChangeElementsOfOneNameAndAddOthers) {
  const auto scene =
      over("[[camera]]\nname = \"eye\"\nheight = 30\n[[camera]]\nname = \"second\"\nwidth = 10\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  ASSERT_EQ(scene->cameras.size(), 2u);
  EXPECT_EQ(scene->cameras[0].width, 64);
  EXPECT_EQ(scene->cameras[0].height, 30);
  EXPECT_EQ(scene->cameras[1].name, "second");
  EXPECT_EQ(scene->lights.size(), 1u);
}

TEST_F(Overlays, OfNothingChangeNothing) {
  const auto scene = over("[sim]\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  EXPECT_EQ(to_toml(*scene), to_toml(scene_));
}

TEST_F(Overlays, ErrorsNameTheOverlayAndItsLine) {
  const auto typo = over("[weather]\n\nvisibilty = 8\n");
  ASSERT_FALSE(typo.ok());
  EXPECT_THAT(typo.error().to_string(), HasSubstr("night.toml:3"));
  EXPECT_THAT(typo.error().to_string(), HasSubstr("visibility"));
  EXPECT_THAT(over("[[camera\n").error().to_string(), HasSubstr("night.toml:1"));
  EXPECT_THAT(over("camera = 3\n").error().to_string(), HasSubstr("night.toml"));
}

}  // namespace
}  // namespace gloam
