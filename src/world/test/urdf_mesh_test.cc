// Meshes of URDFs that MuJoCo does not read: drawn by Gloam's own readers, felt as copies.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/cache_writer.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A corner of a box: faces at x = 0, y = 0, z = 0 and across, in `unit`s and with its own colour.
std::string dae(double unit) {
  return "<COLLADA version='1.4.1'><asset><unit meter='" + std::to_string(unit) +
         "'/><up_axis>Z_UP</up_axis></asset>"
         "<library_effects><effect id='e'><profile_COMMON><technique><lambert><diffuse><color>"
         "1 0 0 1</color></diffuse></lambert></technique></profile_COMMON></effect>"
         "</library_effects><library_materials><material id='red'><instance_effect url='#e'/>"
         "</material></library_materials>"
         "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='a'>"
         "0 0 0 200 0 0 0 300 0 0 0 400</float_array><technique_common>"
         "<accessor source='#a' count='4' stride='3'/></technique_common></source>"
         "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
         "<triangles material='red'><input semantic='VERTEX' source='#v' offset='0'/>"
         "<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene id='s'><node><instance_geometry url='#g'/></node>"
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
         "</COLLADA>";
}

// A plate without thickness, as STL text: MuJoCo's compiler takes neither.
const char* const kPlate =
    "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid plate\n";

std::string urdf(const std::string& visual, const std::string& collision,
                 const std::string& attributes = "") {
  return "<robot name='r'>\n<link name='base'><inertial><mass value='1'/><inertia ixx='.1' "
         "iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/></inertial>\n<visual><origin xyz='0 0 1'/>"
         "<geometry><mesh filename='" +
         visual + "' " + attributes +
         "/></geometry><material name='blue'><color rgba='0 0 1 1'/></material></visual>\n"
         "<collision><geometry>" +
         collision + "</geometry></collision></link></robot>\n";
}
const char* const kBox = "<box size='.1 .1 .1'/>";

class UrdfMeshTest : public testing::Test {
 protected:
  UrdfMeshTest() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("mm.dae", dae(0.001));
    folder_.write("plate.stl", kPlate);
  }
  ~UrdfMeshTest() override {
    finish_cache_writes();
    ::unsetenv("GLOAM_CACHE");
  }
  Result<World> compile(const std::string& text) {
    GLOAM_TRY(const Scene scene, load_scene(folder_.write("r.urdf", text)));
    return World::compile(scene);
  }
  /// Of what is drawn of a mesh, lowest and highest corner in the world's body, and its colour.
  void expect_drawn(const Result<World>& world, Vec3f low, Vec3f high, Vec3f color) {
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    const Result<RenderDescription> out = describe_for_rendering(*world->compiled());
    ASSERT_TRUE(out.ok()) << out.error().to_string();
    for (const InstanceDescription& in : out->instances) {
      if (in.shape != ShapeType::kMesh || !in.shown) continue;
      Vec3f least{1e9f, 1e9f, 1e9f}, most = -least;
      for (const Vec3f& p_G : out->meshes[static_cast<size_t>(in.mesh)].positions) {
        const Vec3f p = transform_point(in.X_BG, p_G);
        least = {min(least.x, p.x), min(least.y, p.y), min(least.z, p.z)};
        most = {max(most.x, p.x), max(most.y, p.y), max(most.z, p.z)};
      }
      EXPECT_LT(length(least - low), 1e-5f) << least.x << ' ' << least.y << ' ' << least.z;
      EXPECT_LT(length(most - high), 1e-5f) << most.x << ' ' << most.y << ' ' << most.z;
      const Vec3f c = out->materials[static_cast<size_t>(in.material)].base_color;
      EXPECT_LT(length(c - color), 1e-5f) << c.x << ' ' << c.y << ' ' << c.z;
      return;
    }
    ADD_FAILURE() << "no mesh is drawn";
  }
  TempFolder folder_;
};

TEST_F(UrdfMeshTest, ColladaIsDrawnWithItsUnitScaleAndColour) {
  const Result<World> world = compile(urdf("mm.dae", kBox));
  expect_drawn(world, {0, 0, 1}, {0.2f, 0.3f, 1.4f}, {1, 0, 0});
  EXPECT_THAT(world->info().unsupported, IsEmpty());
  EXPECT_EQ(world->info().triangles, 4);
  // Again, out of the cache.
  expect_drawn(compile(urdf("mm.dae", kBox)), {0, 0, 1}, {0.2f, 0.3f, 1.4f}, {1, 0, 0});
  expect_drawn(compile(urdf("mm.dae", kBox, "scale='-1 2 1'")), {-0.2f, 0, 1}, {0, 0.6f, 1.4f},
               {1, 0, 0});
}

TEST_F(UrdfMeshTest, PlatesAndStlTextAreDrawnInTheVisualsColour) {
  expect_drawn(compile(urdf("plate.stl", kBox)), {0, 0, 1}, {1, 1, 1}, {0, 0, 1});
}

TEST_F(UrdfMeshTest, ColladaCollides) {
  const Result<World> world = compile(urdf("mm.dae", "<mesh filename='mm.dae'/>"));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  ASSERT_EQ(m.nmesh, 1);
  EXPECT_EQ(m.mesh_facenum[0], 4);
  const Result<World> bad = compile(urdf("mm.dae", "<mesh filename='gone.dae'/>"));
  ASSERT_FALSE(bad.ok());
  folder_.write("bad.dae", "<COLLADA>");
  const Result<World> damaged = compile(urdf("mm.dae", "<mesh filename='bad.dae'/>"));
  ASSERT_FALSE(damaged.ok());
  EXPECT_THAT(damaged.error().to_string(), HasSubstr("r.urdf:4: the collision mesh"));
  EXPECT_THAT(damaged.error().to_string(), HasSubstr("bad.dae"));
}

TEST_F(UrdfMeshTest, MeshFilesAreNoModels) {
  const Result<Scene> scene = load_scene(folder_.path() / "mm.dae");
  ASSERT_FALSE(scene.ok());
  EXPECT_THAT(scene.error().to_string(), HasSubstr("[[visual]]"));
}

}  // namespace
}  // namespace gloam
