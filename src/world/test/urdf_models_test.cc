// Whole robots in URDF, written for this test (urdf/): each is stock MuJoCo's model in every array,
// and comes back from an export as it went.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "base/test/source_dir.h"
#include "gloam/model_tools.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/world.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// As tetrahedron_obj(), binary.
std::string tetrahedron_stl() {
  static_assert(std::endian::native == std::endian::little);
  constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  constexpr uint32_t kCount = 4;
  constexpr size_t kHead = 80, kNormal = 12;
  std::string text(kHead, ' ');
  text.append(reinterpret_cast<const char*>(&kCount), sizeof(kCount));
  for (const auto& face : kFaces) {
    text.append(kNormal, '\0');
    for (const int corner : face)
      text.append(reinterpret_cast<const char*>(kCorners[corner]), sizeof(kCorners[corner]));
    text.append(2, '\0');
  }
  return text;
}

struct Robot {
  const char* name;
  int bodies, joints, geoms, meshes, equalities, visual_geoms;  // as stock fuses and discards
};
void PrintTo(const Robot& robot, std::ostream* out) { *out << robot.name; }

class UrdfModels : public ::testing::TestWithParam<Robot> {
 protected:
  UrdfModels() { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  // In a package `legs`, with the meshes in `meshes`, a folder below it.
  fs::path place(const std::string& name, const std::string& meshes) const {
    folder_.write("legs/package.xml", "<package><name>legs</name></package>");
    folder_.write("legs/" + meshes + "/block.obj", tetrahedron_obj());
    folder_.write("legs/" + meshes + "/wedge.stl", tetrahedron_stl());
    const fs::path file = folder_.path() / "legs/urdf" / (name + ".urdf");
    fs::create_directories(file.parent_path());
    fs::copy_file(source_dir() / "src/world/test/urdf" / (name + ".urdf"), file);
    return file;
  }
  ModelCheck check(const fs::path& file) const {
    return check_model(file, {}, folder_.path() / "out");
  }
  TempFolder folder_;
};

TEST_P(UrdfModels, AreStockAndComeBack) {
  const Robot& robot = GetParam();
  const fs::path file = place(robot.name, "urdf/meshes");
  const ModelCheck model = check(file);
  ASSERT_TRUE(model.status.ok()) << model.status.error().to_string();
  EXPECT_EQ(model.stock_refusal, "");
  EXPECT_THAT(model.unlike_stock, IsEmpty());
  EXPECT_THAT(model.unlike_export, IsEmpty());
  EXPECT_EQ(model.bodies, robot.bodies);
  EXPECT_EQ(model.joints, robot.joints);
  EXPECT_EQ(model.geoms, robot.geoms);
  const World world = World::compile(load_scene(file).value()).value();
  const mjModel* m = world.compiled()->model.get();
  EXPECT_EQ(m->nmesh, robot.meshes);
  EXPECT_EQ(m->neq, robot.equalities);
  EXPECT_EQ(static_cast<int>(world.compiled()->visual_only.size()), robot.visual_geoms);
}
INSTANTIATE_TEST_SUITE_P(
    Own, UrdfModels,
    ::testing::Values(Robot{"arm", 4, 3, 4, 0, 0, 4}, Robot{"bench", 1, 0, 4, 0, 0, 1},
                      Robot{"cart", 4, 5, 3, 0, 0, 1}, Robot{"drone", 4, 2, 6, 0, 0, 0},
                      Robot{"gripper", 3, 2, 4, 3, 1, 4}, Robot{"leg", 2, 1, 3, 2, 0, 2}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_F(UrdfModels, MeshesOfAPackageAreFoundWhereStockDoesNotLook) {
  const ModelCheck model = check(place("leg", "meshes"));
  EXPECT_TRUE(model.passed()) << model.status.error().to_string();
  EXPECT_THAT(model.stock_refusal.value(), HasSubstr("block.obj"));
  EXPECT_EQ(model.geoms, 3);
}

TEST_F(UrdfModels, PicturesOfMaterialsAreListed) {
  const World world = World::compile(load_scene(place("drone", "meshes")).value()).value();
  const std::vector<Error> unsupported = world.info().unsupported;
  ASSERT_EQ(unsupported.size(), 1u);
  EXPECT_THAT(unsupported[0].to_string(),
              HasSubstr("drone.urdf:10: the image 'meshes/checks.png' of material 'checks' is "
                        "not drawn"));
}

struct Fault {
  const char* name;
  const char* content;  // from line 2 on
  const char* error;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

#define INERTIAL                                                                    \
  "<inertial><mass value='1'/><inertia ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' " \
  "iyz='0'/></inertial>"

class UrdfFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(UrdfFaults, AreRefusedByStockAndNamedByGloam) {
  const TempFolder folder;
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  folder.write("part.dae", "<COLLADA/>");
  const fs::path file = folder.write(
      "r.urdf", "<robot name='r'>\n" + std::string(GetParam().content) + "\n</robot>\n");
  const ModelCheck model = check_model(file, {}, folder.path() / "out");
  EXPECT_NE(model.stock_refusal.value(), "");
  ASSERT_FALSE(model.status.ok());
  EXPECT_THAT(model.status.error().to_string(), HasSubstr(GetParam().error));
}
INSTANTIATE_TEST_SUITE_P(
    Own, UrdfFaults,
    ::testing::Values(
        Fault{"TwoLinksOfOneName", "<link name='a'/>\n<link name='a'/>",
              "r.urdf:3: the link 'a' is defined twice, first on line 2"},
        Fault{"TwoParents",
              "<link name='a'/><link name='b'>" INERTIAL "</link><link name='c'>" INERTIAL
              "</link>\n<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint>\n"
              "<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint>",
              "r.urdf:4: the link 'c' is the child of two joints, 'j' and 'k'"},
        Fault{"Loop",
              "<link name='a'>" INERTIAL "</link><link name='b'>" INERTIAL "</link>\n"
              "<joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>\n"
              "<joint name='k' type='revolute'><parent link='b'/><child link='a'/></joint>",
              "r.urdf:3: every link is the child of a joint: the joints form a loop"},
        Fault{"NoSuchLink",
              "<link name='a'/>\n<joint name='j' type='fixed'><parent link='a'/>"
              "<child link='b'/></joint>",
              "r.urdf:3: URDF joint parent or child missing"},
        Fault{"NoAxis",
              "<link name='a'/><link name='b'>" INERTIAL "</link>\n<joint name='j' "
              "type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 0'/></joint>",
              "r.urdf:3: axis too small in joint, in 'j'"},
        Fault{"MovesWithoutMass",
              "<link name='a'/><link name='b'/>\n<joint name='j' type='revolute'>"
              "<parent link='a'/><child link='b'/></joint>",
              "r.urdf:2: mass and inertia of moving bodies must be larger than mjMINVAL, in 'b'"},
        Fault{"ImpossibleInertia",
              "<link name='a'/><link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='.1' "
              "izz='.1' ixy='0' ixz='0' iyz='0'/></inertial></link>\n<joint name='j' "
              "type='revolute'><parent link='a'/><child link='b'/></joint>",
              "r.urdf:2: inertia must satisfy A + B >= C"},
        Fault{"NoShape", "<link name='a'>\n<collision><geometry/></collision></link>",
              "r.urdf:3: visual geometry specification not found"},
        Fault{"Collada",
              "<link name='a'>\n<collision><geometry><mesh filename='part.dae'/></geometry>"
              "</collision></link>",
              "has no triangles"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace gloam
