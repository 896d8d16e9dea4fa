// What is said of model files that cannot be loaded, and of what they list.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gloam/world.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ModelWordsTest : public ::testing::Test {
 protected:
  ModelWordsTest() { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  Result<World> compile(const std::string& name, const std::string& text) {
    GLOAM_TRY(const Scene scene, load_scene(folder_.write(name, text)));
    return World::compile(scene);
  }
  std::string error_of(const std::string& name, const std::string& text) {
    const Result<World> world = compile(name, text);
    return world.ok() ? "" : world.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(ModelWordsTest, OfWhatIsGoneFromMuJoCo) {
  const std::string error =
      error_of("m.xml",
               "<mujoco><worldbody>\n<composite type='cable' curve='s' count='11 1 1' size='1'>"
               "<geom type='capsule' size='.01'/></composite></worldbody></mujoco>");
  EXPECT_THAT(error, HasSubstr("m.xml:2"));
  EXPECT_THAT(error, HasSubstr("MuJoCo 4 no longer has <composite>"));
  EXPECT_THAT(error, HasSubstr("<flexcomp dim=\"1\">"));
}

TEST_F(ModelWordsTest, OfPluginsThatAreNotMuJoCos) {
  EXPECT_THAT(
      error_of("m.xml", "<mujoco><extension><plugin plugin='acme.motor'/></extension></mujoco>"),
      HasSubstr("Gloam loads only the plugins that come with MuJoCo"));
}

TEST_F(ModelWordsTest, OfXacro) {
  const std::string error =
      error_of("r.urdf.xacro",
               "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n"
               "<xacro:include filename='base.xacro'/></robot>");
  EXPECT_THAT(error, HasSubstr("r.urdf.xacro:2"));
  EXPECT_THAT(error, HasSubstr("xacro is not expanded"));
  EXPECT_THAT(error, HasSubstr("run xacro first"));
  EXPECT_THAT(error_of("s.urdf", "<robot name='r'>\n<link name='${prefix}base'/></robot>"),
              HasSubstr("s.urdf:2: <link>: xacro is not expanded"));
  EXPECT_EQ(error_of("t.urdf",
                     "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>"
                     "<link name='base'><collision><geometry><sphere radius='.1'/></geometry>"
                     "</collision></link></robot>"),
            "")
      << "an expanded file may keep the name space";
}

TEST_F(ModelWordsTest, OfMeshesGivenAsModels) {
  EXPECT_THAT(error_of("part.obj", tetrahedron_obj()),
              HasSubstr("is a mesh, but a model is expected here"));
}

TEST_F(ModelWordsTest, OfFilesThatAreGitLfsPointers) {
  folder_.write("part.stl",
                "version https://git-lfs.github.com/spec/v1\noid sha256:12\nsize 12345\n");
  const std::string error =
      error_of("m.xml",
               "<mujoco><asset>\n<mesh name='part' file='part.stl'/></asset><worldbody>"
               "<geom type='mesh' mesh='part'/></worldbody></mujoco>");
  EXPECT_THAT(error, HasSubstr("is a Git LFS pointer, not the file itself"));
  EXPECT_THAT(error, HasSubstr("git lfs pull"));
}

TEST_F(ModelWordsTest, OfPicturesThatMuJoCoDoesNotRead) {
  const std::string jpeg = "\xFF\xD8\xFF\xE0 no more of it";
  const auto model = [](const std::string& file) {
    return "<mujoco><asset>\n<texture name='t' type='2d' file='" + file +
           "'/><material name='m' texture='t'/></asset><worldbody><geom size='1' material='m'/>"
           "</worldbody></mujoco>";
  };
  for (const char* name : {"skin.jpg", "skin.png"}) {
    folder_.write(name, jpeg);
    const std::string error = error_of("m.xml", model(name));
    EXPECT_THAT(error, HasSubstr("m.xml:2: the image '" + std::string(name) + "'"));
    EXPECT_THAT(error, HasSubstr("is a JPEG; MuJoCo supports only PNG and KTX"));
    EXPECT_THAT(error, HasSubstr("convert it"));
  }
}

TEST_F(ModelWordsTest, OfMomentsThatNoBodyHas) {
  EXPECT_THAT(error_of("m.xml",
                       "<mujoco><worldbody><body><freejoint/><inertial pos='0 0 0' mass='1' "
                       "diaginertia='1 .1 .1'/></body></worldbody></mujoco>"),
              HasSubstr("[override.ROBOT.compiler] balanceinertia = true"));
}

TEST_F(ModelWordsTest, ListsNameWhatAModelHolds) {
  const Result<World> world = compile("m.xml", R"(<mujoco><asset>
    <texture name="t" type="2d" builtin="flat" width="8" height="4"/></asset><worldbody>
    <camera name="ortho" projection="orthographic" fovy="3"/>
    <camera name="own" resolution="64 48"/>
    <site name="p" size=".1"/><body name="b"><joint name="j"/><joint name="k" axis="1 0 0"/>
    <geom size=".1"/><site name="q" pos="1 0 0"/></body></worldbody>
    <tendon><spatial name="rope" width=".01"><site site="p"/><site site="q"/></spatial>
    <fixed name="gear"><joint joint="j" coef="1"/></fixed></tendon>
    <equality><joint name="same" joint1="j" joint2="k"/></equality>
    <keyframe><key name="home" qpos="0 0"/></keyframe></mujoco>)");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const WorldInfo info = world->info();
  ASSERT_EQ(info.sites.size(), 2u);
  EXPECT_EQ(info.sites[1].detail, "sphere, group 0, on 'b'");
  ASSERT_EQ(info.tendons.size(), 2u);
  EXPECT_THAT(info.tendons[0].detail, HasSubstr("spatial, 0.02 m wide"));
  EXPECT_THAT(info.tendons[1].detail, HasSubstr("fixed, of 1 joint"));
  ASSERT_EQ(info.equalities.size(), 1u);
  EXPECT_EQ(info.equalities[0].detail, "joint 'j' 'k'");
  ASSERT_EQ(info.keyframes.size(), 1u);
  EXPECT_EQ(info.keyframes[0].name, "home");
  ASSERT_EQ(info.textures.size(), 1u);
  EXPECT_EQ(info.textures[0].detail, "2d, 8x4");
  EXPECT_THAT(info.cameras[0].detail, HasSubstr("orthographic, 3 m high"));
  EXPECT_THAT(info.cameras[0].detail, ::testing::Not(HasSubstr("1x1")));
  EXPECT_THAT(info.cameras[1].detail, HasSubstr("64x48"));
}

}  // namespace
}  // namespace gloam
