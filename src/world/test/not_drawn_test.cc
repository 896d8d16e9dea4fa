// What pictures and exports leave out is said, and sites and groups can be shown.

#include <gmock/gmock.h>

#include "scene/test/temp_folder.h"
#include "visual_test_model.h"
#include "world/export/export_mjcf.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kModel = R"(<mujoco><worldbody>
<geom name="a" size=".1"/>
<geom name="b" size=".1" group="3"/>
<geom name="c" size=".1" group="5"/>
<body name="link"><geom name="d" size=".1"/>
<site name="tip" type="box" size=".1 .2 .3" pos="0 0 1" rgba="0 1 0 1"/>
<site name="far" size=".1" group="4"/></body>
</worldbody></mujoco>)";

class NotDrawnTest : public ::testing::Test {
 protected:
  NotDrawnTest() { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  World compile(const fs::path& file, const RenderOptions& render = {}) {
    Result<Scene> scene = load_scene(file);
    EXPECT_TRUE(scene.ok()) << scene.error().to_string();
    scene->render = render;
    Result<World> world = World::compile(*scene);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return std::move(world).value();
  }
  std::vector<std::string> shown(const World& world) {
    std::vector<std::string> names;
    const RenderDescription out = visual_test::describe(*world.compiled());
    for (const InstanceDescription& instance : out.instances)
      if (instance.shown && !instance.label.geom.starts_with("studio"))
        names.push_back(instance.label.geom);
    return names;
  }
  TempFolder folder_;
};

TEST_F(NotDrawnTest, HiddenGroupsAndSitesAreSaidWithFileAndLine) {
  const World world = compile(folder_.write("m.xml", kModel));
  const std::vector<Error> hidden = world.not_drawn().hidden;
  ASSERT_EQ(hidden.size(), 2u);
  EXPECT_THAT(hidden[0].to_string(), HasSubstr("m.xml:3: 2 geoms of groups 3, 5 are not drawn"));
  EXPECT_THAT(hidden[0].hint, HasSubstr("--groups 0,1,2,3,5"));
  EXPECT_THAT(hidden[1].to_string(), HasSubstr("m.xml:6: 2 sites of groups 0, 4 are not drawn"));
  EXPECT_THAT(hidden[1].hint, HasSubstr("--sites --groups 0,1,2,4"));
  EXPECT_THAT(shown(world), ElementsAre("a", "d"));
}

TEST_F(NotDrawnTest, GroupsAndSitesAreShownWhenAskedFor) {
  RenderOptions all;
  all.groups = {0, 1, 2, 3, 4, 5};
  all.sites = true;
  const World world = compile(folder_.write("m.xml", kModel), all);
  EXPECT_THAT(world.not_drawn().hidden, IsEmpty());
  EXPECT_THAT(shown(world), ElementsAre("a", "b", "c", "d", "tip", "far"));
  const RenderDescription out = visual_test::describe(*world.compiled());
  const InstanceDescription& tip = out.instances[4];
  EXPECT_EQ(tip.shape, ShapeType::kBox);
  EXPECT_EQ(tip.body, 1);
  EXPECT_EQ(tip.label.part, 5u);
  EXPECT_FALSE(tip.casts_shadow);
  EXPECT_TRUE(tip.color_only) << "depth and LiDARs would see a mark";
  visual_test::expect_near(tip.size, {.1f, .2f, .3f}, 1e-6f);
  visual_test::expect_near(tip.X_BG.p, {0, 0, 1}, 1e-6f);
  EXPECT_GT(out.materials[static_cast<size_t>(tip.material)].base_color.y, 0.9f);
}

TEST_F(NotDrawnTest, OneGroupAloneIsShownAsAsked) {
  RenderOptions collision;
  collision.groups = {3};
  EXPECT_THAT(shown(compile(folder_.write("m.xml", kModel), collision)), ElementsAre("b"));
}

TEST_F(NotDrawnTest, IsKnownOfACachedWorldToo) {
  const fs::path file = folder_.write("m.xml", kModel);
  const std::string first = compile(file).not_drawn().hidden.at(0).to_string();
  finish_cache_writes();
  EXPECT_EQ(compile(file).not_drawn().hidden.at(0).to_string(), first);
}

TEST_F(NotDrawnTest, NothingIsSaidOfWhatIsWhollyDrawn) {
  const World world =
      compile(folder_.write("m.xml", "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"));
  EXPECT_THAT(world.not_drawn().hidden, IsEmpty());
  EXPECT_THAT(world.not_drawn().lacking, IsEmpty());
}

TEST_F(NotDrawnTest, DroppedOptionsAndFlagsOfRobotsAreAllNamed) {
  folder_.write("a.xml",
                "<mujoco><option integrator='implicitfast' cone='elliptic' density='2'/><worldbody>"
                "<body><freejoint/><geom size='.1'/></body></worldbody></mujoco>");
  folder_.write("b.xml",
                "<mujoco><option integrator='RK4'/>\n<include file='flags.xml'/>\n"
                "<visual><headlight ambient='1 1 1'/></visual><worldbody><body><freejoint/><geom "
                "size='.1'/></body></worldbody></mujoco>");
  folder_.write(
      "flags.xml",
      "<mujoco>\n\n<option>\n<flag contact='disable' energy='enable'/></option></mujoco>");
  const World world = compile(folder_.write("s.toml",
                                            "[[robot]]\nname = 'a'\nfile = 'a.xml'\n"
                                            "[[robot]]\nname = 'b'\nfile = 'b.xml'\n"));
  const mjModel& m = *world.compiled()->model;
  std::string all;
  for (const Error& error : world.unsupported()) all += error.to_string() + "\n";
  EXPECT_THAT(all, HasSubstr("b.xml:1: robot 'b' has integrator RK4"));
  EXPECT_EQ(m.opt.disableflags & mjDSBL_CONTACT, 0);
  EXPECT_THAT(
      all, HasSubstr("flags.xml:4: robot 'b' has flag contact disable, but the scene has enable"));
  EXPECT_EQ(m.opt.enableflags & mjENBL_ENERGY, 0);
  EXPECT_THAT(
      all, HasSubstr("flags.xml:4: robot 'b' has flag energy enable, but the scene has disable"));
  EXPECT_NE(m.opt.density, 2);
  EXPECT_THAT(all, HasSubstr("a.xml:1: robot 'a' has density 2"));
  EXPECT_THAT(all, HasSubstr("b.xml:3: robot 'b' has visual/headlight"));
}

const std::string kUrdf =
    "<robot name='r'><link name='base'><inertial><mass value='2'/><inertia ixx='.1' iyy='.1' "
    "izz='.1' ixy='0' ixz='0' iyz='0'/></inertial><visual><origin xyz='0 0 .5'/><geometry>"
    "<box size='.2 .4 .6'/></geometry><material name='m'><color rgba='1 0 0 1'/></material>"
    "</visual><collision><geometry><sphere radius='.1'/></geometry></collision></link></robot>";

TEST_F(NotDrawnTest, ARobotOfAUrdfFloatsWhenAskedTo) {
  folder_.write("r.urdf", kUrdf);
  const std::string robot = "[[robot]]\nname = 'r'\nfile = 'r.urdf'\nposition = [1, 2, 3]\n";
  EXPECT_EQ(compile(folder_.write("fixed.toml", robot)).info().nq, 0);
  const World world = compile(folder_.write("free.toml", robot + "base = 'free'\n"));
  const mjModel& m = *world.compiled()->model;
  ASSERT_EQ(m.nq, 7);
  EXPECT_EQ(m.jnt_type[0], mjJNT_FREE);
  EXPECT_STREQ(mj_id2name(&m, mjOBJ_JOINT, 0), "r/floating_base");
  EXPECT_EQ(m.qpos0[2], 3);
  EXPECT_EQ(m.body_mass[1], 2);
  EXPECT_EQ(world.compiled()->visual_only.at(0).body, 1);
}

TEST_F(NotDrawnTest, WhatHasAJointAtItsRootDoesNotFloatTwice) {
  folder_.write(
      "m.xml",
      "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>");
  const fs::path file =
      folder_.write("s.toml", "[[robot]]\nname = 'r'\nfile = 'm.xml'\nbase = 'free'\n");
  const Result<World> world = World::compile(*load_scene(file));
  ASSERT_FALSE(world.ok());
  EXPECT_THAT(world.error().to_string(), HasSubstr("its root already has a joint"));
}

TEST_F(NotDrawnTest, ExportsHaveVisualsAsGeomsThatTouchNothing) {
  folder_.write("r.urdf", kUrdf);
  folder_.write("part.obj", tetrahedron_obj());
  const World world = compile(folder_.write(
      "s.toml",
      "[[robot]]\nname = 'r'\nfile = 'r.urdf'\n[[visual]]\nname = 'v'\nfile = 'part.obj'\n"
      "body = 'r/base'\n[[light]]\nname = 'lamp'\ntype = 'point'\nposition = [0, 0, 3]\n"
      "flux = 1000\n"));
  std::vector<Error> left_out;
  const Status status = world.export_mjcf(folder_.path() / "out", &left_out);
  ASSERT_TRUE(status.ok()) << status.error().to_string();
  std::string said;
  for (const Error& error : left_out) said += error.to_string() + "\n";
  EXPECT_THAT(said, HasSubstr("s.toml:8"));
  EXPECT_THAT(said, HasSubstr("1 [[light]] is not exported"));
  const Result<ModelPtr> loaded = load_stock_model(folder_.path() / "out" / "scene.xml");
  ASSERT_TRUE(loaded.ok()) << loaded.error().to_string();
  const mjModel &was = *world.compiled()->model, &m = **loaded;
  EXPECT_EQ(m.ngeom, was.ngeom + 2) << said;
  EXPECT_EQ(m.nmesh, 1);
  EXPECT_EQ(mj_getTotalmass(&m), mj_getTotalmass(&was));
  int boxes = 0, meshes = 0;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.geom_group[g] != 2) continue;
    EXPECT_EQ(m.geom_contype[g], 0);
    EXPECT_EQ(m.geom_conaffinity[g], 0);
    boxes += m.geom_type[g] == mjGEOM_BOX;
    meshes += m.geom_type[g] == mjGEOM_MESH;
    if (m.geom_type[g] != mjGEOM_BOX) continue;
    EXPECT_NEAR(m.geom_rgba[4 * g], 1, 1e-3);
    EXPECT_NEAR(m.geom_size[3 * g + 2], 0.3, 1e-6);
    EXPECT_NEAR(m.geom_pos[3 * g + 2], 0.5, 1e-6);
  }
  EXPECT_EQ(boxes, 1);
  EXPECT_EQ(meshes, 1);
}

TEST_F(NotDrawnTest, ExportsKnowNothingOfTheStudio) {
  const World world = compile(folder_.write("r.urdf", kUrdf));
  const RenderDescription shown = visual_test::describe(*world.compiled());
  ASSERT_TRUE(shown.instances.back().color_only) << "the studio's floor is in pictures";
  std::vector<Error> left_out;
  ASSERT_TRUE(world.export_mjcf(folder_.path() / "out", &left_out).ok());
  const Result<ModelPtr> loaded = load_stock_model(folder_.path() / "out" / "scene.xml");
  ASSERT_TRUE(loaded.ok()) << loaded.error().to_string();
  EXPECT_EQ((*loaded)->nmesh, 0);
  EXPECT_EQ((*loaded)->ngeom, 2) << "the collision sphere and the visual box";
}

}  // namespace
}  // namespace gloam
