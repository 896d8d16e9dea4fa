#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gloam/world.h"
#include "scene/files/urdf_text.h"
#include "scene/test/temp_folder.h"
#include "world/export/model_compare.h"
#include "world/world.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// base - (hinge) - arm - (fixed) - tool; every link is drawn, base and arm collide.
std::string robot_urdf(const std::string& base_mesh, const std::string& arm_visual) {
  const std::string inertial =
      "<inertial><mass value='1'/><inertia ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/>"
      "</inertial>";
  return "<robot name='r'>\n<link name='base'>" + inertial +
         "<collision><geometry><mesh filename='" + base_mesh + "'/></geometry></collision>" +
         "<visual><geometry><mesh filename='" + base_mesh + "'/></geometry></visual></link>\n" +
         "<link name='arm'>" + inertial +
         "<collision><origin xyz='0 0 .1'/><geometry><sphere "
         "radius='.05'/></geometry></collision>\n"
         "<visual><origin xyz='0 0 .2'/><geometry><mesh filename='" +
         arm_visual +
         "'/></geometry></visual></link>\n"
         "<joint name='hinge' type='revolute'><parent link='base'/><child link='arm'/>"
         "<origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/><axis xyz='0 1 0'/>"
         "<limit lower='-1' upper='1' effort='5' velocity='1'/></joint>\n"
         "<link name='tool'><visual><origin xyz='.3 0 0'/><geometry><box size='.1 .1 .1'/>"
         "</geometry></visual></link>\n"
         "<joint name='weld' type='fixed'><parent link='arm'/><child link='tool'/>"
         "<origin xyz='0 0 .5'/></joint>\n</robot>\n";
}

class UrdfTest : public ::testing::Test {
 protected:
  UrdfTest() { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  Result<World> compile(const fs::path& file, const FileAccess& access = {}) {
    GLOAM_TRY(const Scene scene, load_scene(file, access));
    return World::compile(scene);
  }
  std::string error_of(const fs::path& file) {
    const Result<World> world = compile(file);
    return world.ok() ? "" : world.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(UrdfTest, PhysicsEqualsStockAndVisualsAreKept) {
  folder_.write("part.obj", tetrahedron_obj());
  const fs::path file = folder_.write("r.urdf", robot_urdf("part.obj", "part.obj"));
  const Result<World> world = compile(file);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const CompiledWorld& compiled = *world->compiled();
  char error[1000] = "";
  const ModelPtr stock(mj_loadXML(file.c_str(), nullptr, error, sizeof(error)));
  ASSERT_NE(stock, nullptr) << error;
  EXPECT_THAT(compare_models(stock.get(), compiled.model.get()), IsEmpty());

  ASSERT_NE(compiled.visual_model, nullptr);
  ASSERT_EQ(compiled.visual_only.size(), 3u);
  const int arm = world->find_body("arm")->id;
  // Stock MuJoCo fuses the tool into the arm and the base into the world.
  EXPECT_FALSE(world->find_body("tool").ok());
  const VisualOnlyGeom& tool = compiled.visual_only[2];
  EXPECT_EQ(tool.body, arm);
  EXPECT_NEAR(tool.X_BG.p.x, 0.3, 1e-9);
  EXPECT_NEAR(tool.X_BG.p.y, 0, 1e-9);
  EXPECT_NEAR(tool.X_BG.p.z, 0.5, 1e-9);
  EXPECT_NEAR(std::abs(tool.X_BG.q.w), 1, 1e-9);
  EXPECT_EQ(compiled.visual_only[0].body, 0);
  EXPECT_EQ(compiled.visual_model->geom_type[tool.geom], mjGEOM_BOX);
  EXPECT_THAT(compiled.unsupported, IsEmpty());
  EXPECT_EQ(world->info().triangles, 4 + 4 + 4);
}

TEST_F(UrdfTest, PackagePathsAreFound) {
  folder_.write("../package.xml", "<package><name>my_robot</name></package>");
  folder_.write("../meshes/part.obj", tetrahedron_obj());
  const fs::path file = folder_.write(
      "r.urdf", robot_urdf("package://my_robot/meshes/part.obj", "../meshes/part.obj"));
  const Result<World> world = compile(file);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_EQ(world->compiled()->model->nmesh, 1);
  EXPECT_EQ(world->compiled()->visual_only.size(), 3u);
  const Status exported = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(exported.ok()) << exported.error().to_string();
}

TEST_F(UrdfTest, PackagesCanBeNamed) {
  const fs::path elsewhere = folder_.write("../../../../../elsewhere/part.obj", tetrahedron_obj());
  const fs::path file =
      folder_.write("r.urdf", robot_urdf("package://other/part.obj", "package://other/part.obj"));
  EXPECT_THAT(error_of(file),
              HasSubstr("r.urdf:2: the folder of package 'other' is not known (specify "
                        "it with --package other=FOLDER)"));
  FileAccess access;
  access.packages = {{"other", elsewhere.parent_path()}};
  const Result<World> world = compile(file, access);
  EXPECT_TRUE(world.ok()) << world.error().to_string();
  fs::remove_all(elsewhere.parent_path());
}

TEST_F(UrdfTest, WhatCannotBeDrawnIsListedNotFatal) {
  folder_.write("part.obj", tetrahedron_obj());
  folder_.write("arm.dae", "<COLLADA/>");
  const Result<World> world = compile(folder_.write("r.urdf", robot_urdf("part.obj", "arm.dae")));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_EQ(world->compiled()->visual_only.size(), 2u);
  ASSERT_EQ(world->info().unsupported.size(), 1u);
  EXPECT_THAT(world->info().unsupported[0].to_string(),
              AllOf(HasSubstr("r.urdf:4: the visual mesh"), HasSubstr("arm.dae")));
}

TEST_F(UrdfTest, WhatMuJoCoIgnoresIsListed) {
  const Result<World> world = compile(folder_.write(
      "r.urdf",
      "<robot name='r'><link name='world'/><link name='base'><inertial><mass value='1'/><inertia "
      "ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/></inertial></link>\n<joint name='float' "
      "type='floating'><parent link='world'/><child link='base'/><mimic "
      "joint='x'/></joint></robot>"));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_THAT(world->info().unsupported, IsEmpty()) << "Gloam lacks nothing here";
  ASSERT_EQ(world->info().notes.size(), 1u);
  EXPECT_THAT(world->info().notes[0].to_string(),
              HasSubstr("MuJoCo: <mimic> on joint 'float' ignored"));
}

TEST_F(UrdfTest, MissingCollisionMeshIsAnErrorWithItsLine) {
  EXPECT_THAT(
      error_of(folder_.write("r.urdf", robot_urdf("none.obj", "none.obj"))),
      HasSubstr("r.urdf:2: '" + (folder_.path() / "none.obj").string() + "' does not exist"));
  EXPECT_THAT(error_of(folder_.write("h.urdf", robot_urdf("http://x/none.obj", "a.obj"))),
              HasSubstr("h.urdf:2: the mesh 'http://x/none.obj' is not a file"));
  EXPECT_THAT(error_of(folder_.write("f.urdf", robot_urdf("file:///etc/passwd", "a.obj"))),
              HasSubstr("lies outside"));
}

TEST_F(UrdfTest, JoinsAScene) {
  folder_.write("part.obj", tetrahedron_obj());
  folder_.write("r.urdf", robot_urdf("part.obj", "part.obj"));
  const Result<World> world = compile(folder_.write(
      "s.toml",
      "[[robot]]\nname = \"a\"\nfile = \"r.urdf\"\nposition = [1, 0, 0]\n[[robot]]\nname = "
      "\"b\"\nfile = \"r.urdf\"\norientation = [0.7071067811865476, 0.7071067811865476, 0, 0]\n"));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const CompiledWorld& compiled = *world->compiled();
  EXPECT_EQ(compiled.visual_only.size(), 6u);
  EXPECT_TRUE(world->find_joint("a/hinge").ok());
  const VisualOnlyGeom& tool = compiled.visual_only[5];
  EXPECT_EQ(tool.body, world->find_body("b/tool")->id);
  EXPECT_NEAR(tool.X_BG.p.x, 0.3, 1e-9);
  EXPECT_NEAR(tool.X_BG.p.z, 0, 1e-9);
  const Status exported = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(exported.ok()) << exported.error().to_string();
}

}  // namespace
}  // namespace gloam
