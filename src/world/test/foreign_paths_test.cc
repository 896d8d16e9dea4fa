// Paths of meshes as other systems write them, in URDF and MJCF.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/cache_writer.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/world.h"

namespace gloam {
namespace {

using testing::IsEmpty;

class ForeignPaths : public testing::Test {
 protected:
  ForeignPaths() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("my meshes/part a.obj", tetrahedron_obj());
    folder_.write("package.xml", "<package><name>arm</name></package>");
  }
  ~ForeignPaths() override {
    finish_cache_writes();
    ::unsetenv("GLOAM_CACHE");
  }
  Result<World> compile(const std::string& name, const std::string& text) {
    GLOAM_TRY(const Scene scene, load_scene(folder_.write(name, text)));
    return World::compile(scene);
  }
  TempFolder folder_;
};

TEST_F(ForeignPaths, OfUrdfMeshesAreDrawnAndCollide) {
  for (const std::string name :
       {"my meshes/part a.obj", "my meshes\\part a.obj", ".\\my meshes\\part a.obj",
        "my%20meshes/part%20a.obj", "my%20meshes\\part%20a.obj",
        "package://arm/my%20meshes/part%20a.obj", "package://arm\\my meshes\\part a.obj",
        "package://arm/my meshes\\part a.obj"}) {
    const std::string mesh = "<geometry><mesh filename='" + name + "'/></geometry>";
    const Result<World> world =
        compile("r.urdf",
                "<robot name='r'><link name='b'><inertial><mass value='1'/><inertia ixx='.1' "
                "iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/></inertial><visual>" +
                    mesh + "</visual><collision>" + mesh + "</collision></link></robot>");
    ASSERT_TRUE(world.ok()) << name << ": " << world.error().to_string();
    EXPECT_THAT(world->info().unsupported, IsEmpty()) << name;
    EXPECT_EQ(world->compiled()->visual_only.size(), 1u) << name;
    EXPECT_EQ(world->compiled()->model->nmesh, 1) << name;
  }
}

TEST_F(ForeignPaths, OfMjcfMeshesAndIncludesAreFound) {
  folder_.write("my parts/one.xml", "<mujoco><worldbody><body name='b'/></worldbody></mujoco>");
  for (const std::string divider : {"/", "\\", "%5C", "%2F"})
    for (const std::string space : {" ", "%20"}) {
      const std::string mesh = "my" + space + "meshes" + divider + "part" + space + "a.obj";
      const std::string part = "my" + space + "parts" + divider + "one.xml";
      const Result<World> world =
          compile("m.xml", "<mujoco><asset><mesh name='m' file='" + mesh +
                               "'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody>"
                               "<include file='" +
                               part + "'/></mujoco>");
      ASSERT_TRUE(world.ok()) << mesh << ": " << world.error().to_string();
      EXPECT_EQ(world->compiled()->model->nbody, 2) << part;
    }
}

}  // namespace
}  // namespace gloam
