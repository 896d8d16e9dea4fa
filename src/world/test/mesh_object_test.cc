#include "world/compile/mesh_object.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "base/cache_writer.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/export/export_mjcf.h"
#include "world/render_description.h"

namespace gloam {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

/// A closed box as a group of an OBJ file; `first` = number of its first vertex.
std::string obj_box(const std::string& group, Vec3 low, Vec3 high, int first) {
  std::string text = "g " + group + "\n";
  for (int i = 0; i < 8; ++i)
    text += fmt::format("v {} {} {}\n", i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                        i & 4 ? high.z : low.z);
  constexpr std::array<std::array<int, 4>, 6> kFaces = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : kFaces)
    text += fmt::format("f {} {} {} {}\n", f[0] + first, f[1] + first, f[2] + first, f[3] + first);
  return text;
}

class MeshObjectTest : public testing::Test {
 protected:
  MeshObjectTest() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("box.obj", obj_box("crate", {-0.1, -0.2, 0}, {0.1, 0.2, 0.6}, 1));
    folder_.write("two.obj", obj_box("slab", {-2, -2, -0.1}, {2, 2, 0}, 1) +
                                 obj_box("pillar", {1, 1, 0}, {1.2, 1.2, 2}, 9));
  }
  ~MeshObjectTest() override {
    finish_cache_writes();
    ::unsetenv("GLOAM_CACHE");
  }
  /// Two nodes called "leg", a tetrahedron of 1 m; the second is mirrored and 5 m along x.
  void write_twins() {
    folder_.write("twins.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
"scenes": [{"nodes": [0, 1]}],
"nodes": [{"name": "leg", "mesh": 0},
          {"name": "leg", "mesh": 0, "translation": [5, 0, 0], "scale": [-1, 1, 1]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
               "min": [0, 0, 0], "max": [1, 1, 1]},
              {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAAADAAIAAQACAAMA"}]})");
  }
  Result<World> compile(const std::string& text) {
    folder_.write("scene.toml", text);
    Result<Scene> scene = load_scene(folder_.path() / "scene.toml");
    if (!scene.ok()) return scene.error();
    return World::compile(*scene);
  }
  std::string error(const std::string& text) {
    const Result<World> world = compile(text);
    return world.ok() ? "no error" : world.error().to_string();
  }
  static std::vector<std::string> notes(const World& world) {
    std::vector<std::string> out;
    for (const Error& e : world.notes()) out.push_back(e.message);
    return out;
  }
  TempFolder folder_;
};

constexpr const char* kCrate = R"([[object]]
name = "crate"
file = "box.obj"
position = [0, 0, 1]
density = 500
friction = [0.4, 0.01, 0.002]
)";

TEST_F(MeshObjectTest, IsAFreeBodyWithTheMassOfItsVolume) {
  const Result<World> world = compile(kCrate);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  const int body = mj_name2id(&m, mjOBJ_BODY, "crate");
  ASSERT_GT(body, 0);
  const double mass = 500 * 0.2 * 0.4 * 0.6;
  EXPECT_NEAR(m.body_mass[body], mass, 1e-4);
  EXPECT_NEAR(m.body_ipos[3 * body + 2], 0.3, 1e-6);
  std::vector<double> inertia(m.body_inertia + 3 * body, m.body_inertia + 3 * body + 3);
  std::sort(inertia.begin(), inertia.end());
  EXPECT_NEAR(inertia[0], mass / 12 * (0.04 + 0.16), 1e-4);
  EXPECT_NEAR(inertia[2], mass / 12 * (0.16 + 0.36), 1e-4);
  EXPECT_EQ(m.jnt_type[m.body_jntadr[body]], mjJNT_FREE);
  const int geom = mj_name2id(&m, mjOBJ_GEOM, "crate/collider_1");
  ASSERT_GE(geom, 0);
  EXPECT_EQ(m.geom_type[geom], mjGEOM_BOX);
  EXPECT_EQ(m.geom_group[geom], 3);
  EXPECT_EQ(m.geom_friction[3 * geom], 0.4);
  EXPECT_GE(mj_name2id(&m, mjOBJ_GEOM, "floor"), 0);  // something to stand on
}

TEST_F(MeshObjectTest, FallsAndComesToRestOnItsFace) {
  const Result<World> world = compile(kCrate);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel* m = world->compiled()->model.get();
  mjData* d = mj_makeData(m);
  for (int i = 0; i < 1500; ++i) mj_step(m, d);
  const int body = mj_name2id(m, mjOBJ_BODY, "crate");
  EXPECT_NEAR(d->xpos[3 * body + 2], 0, 2e-3);
  mj_deleteData(d);
}

TEST_F(MeshObjectTest, MotionAndMassAndColliders) {
  const Result<World> world = compile(std::string(kCrate) + R"(mass = 2
[[object]]
name = "fixed"
file = "box.obj"
motion = "static"
colliders = "hull"
[[object]]
name = "moved"
file = "box.obj"
motion = "mocap"
colliders = "sphere"
[[object]]
name = "shown"
file = "box.obj"
motion = "static"
colliders = "none"
[override.environment.geom."fixed/collider_1"]
margin = 0.01
)");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  const auto body = [&](const char* name) { return mj_name2id(&m, mjOBJ_BODY, name); };
  EXPECT_NEAR(m.body_mass[body("crate")], 2, 1e-12);
  EXPECT_EQ(m.body_dofnum[body("fixed")], 0);
  EXPECT_GE(m.body_mocapid[body("moved")], 0);
  EXPECT_EQ(m.body_geomnum[body("shown")], 0);
  const int hull = mj_name2id(&m, mjOBJ_GEOM, "fixed/collider_1");
  EXPECT_EQ(m.geom_type[hull], mjGEOM_MESH);
  EXPECT_EQ(m.geom_margin[hull], 0.01);
  EXPECT_EQ(m.mesh_vertnum[m.geom_dataid[hull]], 8);
  const Result<RenderDescription> shown = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(shown.ok()) << shown.error().to_string();
  for (const char* name : {"crate", "fixed", "moved", "shown"})
    EXPECT_THAT(shown->instances, Contains(Field(&InstanceDescription::label,
                                                 Field(&LabelRow::instance_name, name))));
}

TEST_F(MeshObjectTest, TakesOneNodeAndNamesTheNearest) {
  const std::string object = "[[object]]\nname = 'a'\nfile = 'two.obj'\nnode = ";
  const Result<World> world = compile(object + "'pillar'\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  EXPECT_NEAR(m.body_mass[mj_name2id(&m, mjOBJ_BODY, "a")], 1000 * 0.2 * 0.2 * 2, 1e-2);
  EXPECT_THAT(error(object + "'pilar'\n"),
              AllOf(HasSubstr("no node 'pilar'"), HasSubstr("pillar")));
}

TEST_F(MeshObjectTest, ExportsAsStockMujocoLoadsIt) {
  const Result<World> turned = compile(std::string(kCrate) + R"(colliders = "hull"
orientation = [0.8, 0.6, 0, 0]
)");
  ASSERT_TRUE(turned.ok()) << turned.error().to_string();
  const Result<ExportedModel> exported = write_mjcf(*turned->compiled(), folder_.path() / "out");
  ASSERT_TRUE(exported.ok()) << exported.error().to_string();
  EXPECT_THAT(exported->differing, IsEmpty());
}

TEST_F(MeshObjectTest, PlacesHaveABodyForEachNode) {
  const Result<World> world = compile("[environment]\nfile = 'two.obj'\nunit = 0.5\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  const int slab = mj_name2id(&m, mjOBJ_GEOM, "slab/collider_1");
  ASSERT_GE(slab, 0);
  EXPECT_EQ(m.geom_type[slab], mjGEOM_BOX);
  EXPECT_NEAR(m.geom_rbound[slab], 0.5 * std::sqrt(4 + 4 + 0.0025), 1e-4);
  EXPECT_GT(mj_name2id(&m, mjOBJ_BODY, "pillar"), 0);
  EXPECT_EQ(m.nv, 0);
  const Result<RenderDescription> shown = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(shown.ok());
  EXPECT_THAT(shown->instances, Contains(Field(&InstanceDescription::label,
                                               Field(&LabelRow::semantic_name, "pillar"))));
}

TEST_F(MeshObjectTest, NodesOfAPlaceGiveWayToNamesOfTheScene) {
  const Result<World> world =
      compile("[environment]\nfile = 'two.obj'\n[[object]]\nname = 'pillar'\nfile = 'box.obj'\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_GT(mj_name2id(world->compiled()->model.get(), mjOBJ_BODY, "pillar_2"), 0);
  EXPECT_THAT(notes(*world), Contains(HasSubstr("node 'pillar' is renamed to 'pillar_2'")));
}

constexpr const char* kClash = R"([environment]
file = 'two.obj'
clash = '{}'
[[object]]
name = 'pillar'
file = 'box.obj'
)";

TEST_F(MeshObjectTest, ClashesAreRefusedOnRequest) {
  EXPECT_THAT(error(fmt::format(kClash, "refuse")),
              AllOf(HasSubstr("scene.toml:1"), HasSubstr("node 'pillar' and object 'pillar'"),
                    HasSubstr("clash = \"rename\"")));
  folder_.write("two.obj", obj_box("box", {0, 0, 0}, {1, 1, 1}, 1) +
                               obj_box("other", {2, 0, 0}, {3, 1, 1}, 9));
  EXPECT_EQ(error(fmt::format(kClash, "refuse")), "no error");
  EXPECT_THAT(error(fmt::format(kClash, "merge")), HasSubstr("cannot be 'merge'"));
}

TEST_F(MeshObjectTest, PrefixedNodesCannotClash) {
  const Result<World> world = compile(fmt::format(kClash, "prefix"));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  for (const char* name : {"two/pillar", "two/slab", "pillar"})
    EXPECT_GT(mj_name2id(world->compiled()->model.get(), mjOBJ_BODY, name), 0) << name;
  EXPECT_THAT(notes(*world), IsEmpty());
  const Result<RenderDescription> shown = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(shown.ok()) << shown.error().to_string();
  EXPECT_THAT(shown->instances, Contains(Field(&InstanceDescription::label,
                                               Field(&LabelRow::semantic_name, "slab"))));
}

TEST_F(MeshObjectTest, NodesOfOneNameAreNumbered) {
  write_twins();
  const Result<World> world = compile("[environment]\nfile = 'twins.gltf'\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  EXPECT_GT(mj_name2id(&m, mjOBJ_BODY, "leg"), 0);
  EXPECT_GT(mj_name2id(&m, mjOBJ_BODY, "leg_2"), 0);
  EXPECT_THAT(notes(*world), Contains(HasSubstr("node 'leg' is renamed to 'leg_2'")));
  EXPECT_THAT(error("[environment]\nfile = 'twins.gltf'\nclash = 'refuse'\n"),
              HasSubstr("node 'leg' and another node"));
  const Result<World> second =
      compile("[[object]]\nname = 'a'\nfile = 'twins.gltf'\nnode = 'leg_2'\nup = 'z'\n");
  ASSERT_TRUE(second.ok()) << second.error().to_string();
  const mjModel& m2 = *second->compiled()->model;
  EXPECT_NEAR(m2.body_ipos[3 * mj_name2id(&m2, mjOBJ_BODY, "a")], 5 - 1.0 / 4, 1e-5);
}

TEST_F(MeshObjectTest, MirroredNodesWeighWhatTheyDo) {
  write_twins();  // the second is mirrored
  const Result<World> world =
      compile("[[object]]\nname = 'a'\nfile = 'twins.gltf'\nnode = 'leg_2'\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  EXPECT_NEAR(m.body_mass[mj_name2id(&m, mjOBJ_BODY, "a")], 1000.0 / 6, 1e-3);
  EXPECT_THAT(notes(*world), IsEmpty());
}

TEST_F(MeshObjectTest, RobotsWithTheNamesOfOthersAreErrors) {
  folder_.write("arm.xml",
                "<mujoco><worldbody><body name='base'><freejoint/>"
                "<geom size='.1'/></body></worldbody></mujoco>");
  folder_.write("room.xml",
                "<mujoco><worldbody><body name='base'/><body name='arm/base'/>"
                "<body name='leg'/></worldbody></mujoco>");
  const auto robots = [&](const std::string& name) {
    return "[environment]\nfile = 'room.xml'\n[[robot]]\nname = '" + name + "'\nfile = 'arm.xml'\n";
  };
  EXPECT_EQ(error(robots("other")), "no error");  // its 'base' is 'other/base'
  EXPECT_THAT(error(robots("arm")),
              AllOf(HasSubstr("scene.toml:3"), HasSubstr("robot 'arm'"),
                    HasSubstr("body 'arm/base'"), HasSubstr("rename the robot")));
  EXPECT_THAT(error(robots("leg")), HasSubstr("body 'leg'"));
  EXPECT_THAT(error(robots("a") + "[[robot]]\nname = 'a'\nfile = 'arm.xml'\n"),
              HasSubstr("two robots named 'a'"));
  EXPECT_THAT(error("[environment]\nfile = 'two.obj'\nclash = 'prefix'\n[[robot]]\nname = "
                    "'two'\nfile = 'arm.xml'\n"),
              AllOf(HasSubstr("scene.toml:4"), HasSubstr("prefix 'two/'")));
}

TEST_F(MeshObjectTest, VisualsMayBeOneNode) {
  const std::string visual = "[[visual]]\nname = 'a'\nfile = 'two.obj'\nnode = ";
  const Result<World> world = compile(visual + "'pillar'\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Result<RenderDescription> shown = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(shown.ok()) << shown.error().to_string();
  ASSERT_EQ(shown->instances.size(), 2u) << "the pillar and the studio's floor";
  EXPECT_TRUE(shown->instances[1].color_only);
  const Result<World> wrong = compile(visual + "'pilar'\n");
  ASSERT_TRUE(wrong.ok());
  const Result<RenderDescription> none = describe_for_rendering(*wrong->compiled());
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().to_string(),
              AllOf(HasSubstr("scene.toml:1"), HasSubstr("no node 'pilar'"), HasSubstr("pillar")));
}

TEST_F(MeshObjectTest, OpenAndTangledMeshesMoveAsTheirHull) {
  const std::string box = obj_box("crate", {-0.1, -0.2, 0}, {0.1, 0.2, 0.6}, 1);
  folder_.write("open.obj", box.substr(0, box.rfind("f ")));
  folder_.write("fin.obj", box + "v 0 0 1\nf 1 2 9\n");
  for (const char* file : {"open.obj", "fin.obj"}) {
    const Result<World> world =
        compile(fmt::format("[[object]]\nname = 'a'\nfile = '{}'\ncolliders = 'hull'\n", file));
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    const mjModel& m = *world->compiled()->model;
    EXPECT_GT(m.body_mass[mj_name2id(&m, mjOBJ_BODY, "a")], 47.9) << file;
    EXPECT_THAT(notes(*world),
                Contains(AllOf(HasSubstr("object 'a'"), HasSubstr("computed from its hull"))));
  }
}

TEST_F(MeshObjectTest, AbsurdScalesAreToldOrRefused) {
  const Result<World> huge = compile(std::string(kCrate) + "scale = 1e6\n");
  ASSERT_TRUE(huge.ok()) << huge.error().to_string();
  EXPECT_THAT(notes(*huge), Contains(HasSubstr("a size of 6e+05 m")));
  EXPECT_THAT(
      error(std::string(kCrate) + "scale = 1e-6\n"),
      AllOf(HasSubstr("scene.toml:1"), HasSubstr("too light to move"), HasSubstr("'unit'")));
  EXPECT_THAT(error(std::string(kCrate) + "scale = 1e6\nunit = 1e6\n"),
              AllOf(HasSubstr("scene.toml:1"), HasSubstr("m from its origin")));
  const Result<World> fixed = compile(std::string(kCrate) + "scale = 1e-6\nmotion = 'static'\n");
  EXPECT_TRUE(fixed.ok()) << fixed.error().to_string();
  EXPECT_THAT(error(std::string(kCrate) + "scale = 1e-6\nmotion = 'static'\ncolliders = 'hull'\n"),
              testing::AnyOf("no error", HasSubstr("scene.toml:1")));
}

TEST_F(MeshObjectTest, MillimetresAreAsked) {
  folder_.write("mug.obj", obj_box("mug", {-40, -40, 0}, {40, 40, 96}, 1));
  const Result<World> world = compile("[[object]]\nname = 'mug'\nfile = 'mug.obj'\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_THAT(world->notes(), Contains(Field(&Error::hint, HasSubstr("unit = 0.001"))));
}

TEST_F(MeshObjectTest, NamesThatClashAreErrorsThatNameBoth) {
  EXPECT_THAT(error(std::string(kCrate) + kCrate), HasSubstr("two objects named 'crate'"));
  EXPECT_THAT(error(std::string(kCrate) + "[[prop]]\nname = 'crate'\nkind = 'chair'\n"),
              AllOf(HasSubstr("object 'crate'"), HasSubstr("prop")));
  EXPECT_THAT(error(std::string(kCrate) + "[[visual]]\nname = 'crate'\nfile = 'two.obj'\n"),
              AllOf(HasSubstr("object 'crate'"), HasSubstr("visual 'crate'")));
}

TEST_F(MeshObjectTest, OddSizesAreTold) {
  const Result<World> world = compile(std::string(kCrate) + "unit = 1000\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_THAT(notes(*world), Contains(HasSubstr("object 'crate' has a size of 600 m")));
  EXPECT_THAT(world->notes(), Contains(Field(&Error::hint, HasSubstr("unit = 0.001"))));
}

TEST_F(MeshObjectTest, BadFilesAreErrors) {
  folder_.write("empty.obj", "v 0 0 0\n");
  folder_.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  folder_.write("nan.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n");
  for (const char* file : {"empty.obj", "line.obj", "nan.obj", "none.obj"})
    for (const char* table : {"[environment]\n", "[[object]]\nname = 'a'\n"})
      EXPECT_THAT(error(fmt::format("{}file = '{}'\n", table, file)),
                  AllOf(HasSubstr("scene.toml:"), HasSubstr(file)));
}

TEST_F(MeshObjectTest, APlaceThatLooksInwardsIsARoomOneStandsIn) {
  // Of obj_box() the other way round: high and low exchanged along one axis.
  folder_.write("room.obj", obj_box("room", {5, 0, 0}, {0, 4, 2.5}, 1));
  folder_.write("ball.xml",
                "<mujoco><worldbody><body name='ball'><freejoint/><geom size='0.1' condim='6' "
                "friction='1 0.1 0.1'/></body></worldbody></mujoco>");
  const auto world = compile(
      "[environment]\nfile = 'room.obj'\n[[robot]]\nname = 'a'\nfile = 'ball.xml'\n"
      "position = [1, 1, 1.5]\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_THAT(notes(*world),
              testing::ElementsAre(HasSubstr("'room' faces inwards: it is treated as a room")));
  const mjModel& m = *world->compiled()->model;
  const DataPtr data(mj_makeData(&m));
  while (data->time < 3) mj_step(&m, data.get());
  EXPECT_NEAR(data->qpos[2], 0.1, 2e-3);
  EXPECT_NEAR(data->qpos[0], 1, 0.05);
  // Thrown at each wall and the ceiling it stays within.
  for (const Vec3 v :
       {Vec3{4, 0, 1}, Vec3{-4, 0, 1}, Vec3{0, 4, 1}, Vec3{0, -4, 1}, Vec3{1, 1, 6}}) {
    mj_resetData(&m, data.get());
    data->qvel[0] = v.x, data->qvel[1] = v.y, data->qvel[2] = v.z;
    while (data->time < 2) {
      mj_step(&m, data.get());
      const mjtNum* p = data->qpos;
      ASSERT_TRUE(p[0] > 0.02 && p[0] < 4.98 && p[1] > 0.02 && p[1] < 3.98 && p[2] > 0.02 &&
                  p[2] < 2.48)
          << p[0] << ' ' << p[1] << ' ' << p[2];
    }
  }
  // A thing is no place: it is turned round.
  const Result<World> thing = compile("[[object]]\nname = 'a'\nfile = 'room.obj'\n");
  ASSERT_TRUE(thing.ok()) << thing.error().to_string();
  EXPECT_THAT(notes(*thing), testing::ElementsAre(HasSubstr("its triangles are flipped")));
}

TEST_F(MeshObjectTest, SeveralAreMadeAsOneByOne) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    folder_.write(fmt::format("b{}.obj", i), obj_box("b", {0, 0, 0}, {0.1 * (i + 1), 0.2, 0.3}, 1));
    text +=
        fmt::format("[[object]]\nname = 'b{0}'\nfile = 'b{0}.obj'\nposition = [{0}, 0, 1]\n", i);
  }
  const Result<World> world = compile(text);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(mj_name2id(&m, mjOBJ_BODY, fmt::format("b{}", i).c_str()), i + 1);
    EXPECT_NEAR(m.body_mass[i + 1], 6.0 * (i + 1), 1e-3);
  }
  folder_.write("b3.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  folder_.write("b6.obj", "v 0 0 0\n");
  EXPECT_THAT(error(text), AnyOf(HasSubstr("b3"), HasSubstr("b6")));
}

TEST_F(MeshObjectTest, WhatIsDrawnOfThemIsCounted) {
  const Result<World> world = compile(std::string(kCrate) +
                                      "[[object]]\nname = 'a'\nfile = 'two.obj'\nnode = "
                                      "'pillar'\n[[visual]]\nname = 'v'\nfile = 'two.obj'\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_EQ(world->info().triangles, 12 + 12 + 24);
  const Result<World> place = compile("[environment]\nfile = 'two.obj'\n");
  ASSERT_TRUE(place.ok());
  EXPECT_EQ(place->info().triangles, 24);
}

TEST_F(MeshObjectTest, TheFilesContentIsInTheKey) {
  const Result<World> before = compile(kCrate);
  folder_.write("box.obj", obj_box("crate", {-0.1, -0.2, 0}, {0.1, 0.2, 0.7}, 1));
  const Result<World> after = compile(kCrate);
  ASSERT_TRUE(before.ok() && after.ok());
  EXPECT_NE(before->compiled()->place_hash, after->compiled()->place_hash);
}

}  // namespace
}  // namespace gloam
