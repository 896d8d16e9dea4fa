// Near planes, backs of surfaces and hidden bodies, which cameras and LiDARs do not see.

#include <gmock/gmock.h>

#include "scene/test/temp_folder.h"
#include "visual_test_model.h"
#include "world/sensors/authored_lidar.h"

namespace gloam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class HiddenBodiesTest : public ::testing::Test {
 protected:
  HiddenBodiesTest() {
    folder_.write("m.xml", R"(<mujoco><statistic extent="2"/><visual><map znear="0.05"/></visual>
<worldbody><light pos="0 0 3"/>
<body name="head"><geom name="shell" size=".1"/><camera name="eye"/>
  <body name="lid"><geom name="glass" size=".1"/></body></body>
<body name="arm" pos="1 0 0"><geom name="rod" size=".1"/></body></worldbody></mujoco>)");
  }
  Result<World> compile(const std::string& lines) {
    GLOAM_TRY(const Scene scene, load_scene(folder_.write("s.toml", R"([[robot]]
name = "r"
file = "m.xml"
)" + lines)));
    return World::compile(scene);
  }
  std::string error_of(const std::string& lines) {
    const Result<World> world = compile(lines);
    return world.ok() ? "" : world.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(HiddenBodiesTest, ACameraHidesBodiesAndWhatHangsOnThem) {
  const auto world = compile("[[camera]]\nname = \"r/eye\"\nhide = [\"r/he*\"]\nnear = 0.2\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const RenderDescription out = visual_test::describe(*world->compiled());
  const CameraDescription& eye = out.cameras.front();
  ASSERT_EQ(eye.name, "r/eye");
  EXPECT_FLOAT_EQ(eye.near, 0.2f);
  EXPECT_FALSE(eye.culls_backs) << "scenes have no backs unless asked";
  ASSERT_NE(eye.hidden, nullptr);
  std::vector<std::string> hidden;
  for (size_t i = 0; i < out.instances.size(); ++i)
    if ((*eye.hidden)[i] != 0) hidden.push_back(out.instances[i].label.geom);
  EXPECT_THAT(hidden, ElementsAre("r/shell", "r/glass"));
  EXPECT_EQ(out.cameras.back().hidden, nullptr) << "the free camera hides nothing";
}

TEST_F(HiddenBodiesTest, ALidarHidesBodiesAndWhatHangsOnThem) {
  const auto world = compile("[[lidar]]\nname = \"l\"\nbody = \"r/head\"\nhide = [\"r/head\"]\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const auto lidars = describe_lidars(*world->compiled());
  ASSERT_TRUE(lidars.ok());
  EXPECT_THAT(lidars->front().hidden, ElementsAre(0, 1, 1, 0));
}

TEST_F(HiddenBodiesTest, NamesThatFitNoBodyAreErrors) {
  const std::string camera = error_of("[[camera]]\nname = \"r/eye\"\nhide = [\"r/haed\"]\n");
  EXPECT_THAT(camera, HasSubstr("s.toml:4"));
  EXPECT_THAT(camera, HasSubstr("camera 'r/eye' hides 'r/haed'"));
  EXPECT_THAT(camera, HasSubstr("r/head"));
  const std::string lidar = error_of("[[lidar]]\nname = \"l\"\nhide = [\"x*\"]\n");
  EXPECT_THAT(lidar, HasSubstr("s.toml:4"));
  EXPECT_THAT(lidar, HasSubstr("lidar 'l' hides 'x*'"));
  EXPECT_THAT(error_of("[[camera]]\nname = \"r/eye\"\nnear = -1\n"), HasSubstr("near"));
}

// MuJoCo's renderer: znear times extent, and GL_CULL_FACE.
TEST_F(HiddenBodiesTest, BareModelsHaveMujocosNearPlaneAndBackFaces) {
  const auto scene = load_scene(folder_.path() / "m.xml");
  ASSERT_TRUE(scene.ok());
  const auto world = World::compile(*scene);
  ASSERT_TRUE(world.ok());
  const RenderDescription out = visual_test::describe(*world->compiled());
  EXPECT_FLOAT_EQ(out.cameras.front().near, 0.05f * 2);
  EXPECT_TRUE(out.cameras.front().culls_backs);
  EXPECT_EQ(out.cameras.back().near, 0) << "the free camera stands where nothing is in its way";
}

}  // namespace
}  // namespace gloam
