#include "gloam/world.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "scene/files/mujoco_guard.h"
#include "scene/test/temp_folder.h"
#include "world/export/model_compare.h"
#include "world/world.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kWorldArm = R"(<mujoco model="arm">
  <compiler angle="degree" meshdir="meshes"/>
  <option timestep="0.001" cone="elliptic" impratio="10"/>
  <default><geom friction="0.5"/></default>
  <asset><mesh name="part" file="part.obj"/></asset>
  <worldbody>
    <body name="base" pos="0 0 1" euler="0 0 30">
      <freejoint/>
      <geom type="mesh" mesh="part"/>
      <camera name="eye" pos="0.1 0 0"/>
      <body name="link" pos="0 0 0.2"><joint name="hinge" axis="0 1 0" range="-10 10"/>
        <geom name="ball" size="0.05"/></body>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="hinge" ctrlrange="-1 1"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
  <keyframe><key name="home" qpos="0 0 2 1 0 0 0 0.1" qvel="1 0 0 0 0 0 0.5" ctrl="0.5"/></keyframe>
</mujoco>)";

class WorldTest : public ::testing::Test {
 protected:
  WorldTest() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("meshes/part.obj", tetrahedron_obj());
    folder_.write("arm.xml", kWorldArm);
  }
  Result<World> compile(const fs::path& file, const FileAccess& access = {}) {
    GLOAM_TRY(const Scene scene, load_scene(file, access));
    return World::compile(scene);
  }
  Result<World> compile_text(const std::string& name, const std::string& text) {
    return compile(folder_.write(name, text));
  }
  std::string error_of(const std::string& name, const std::string& text) {
    const Result<World> world = compile_text(name, text);
    return world.ok() ? "" : world.error().to_string();
  }
  static ModelPtr load_stock(const fs::path& file) {
    char error[1000] = "";
    mjModel* model = mj_loadXML(file.c_str(), nullptr, error, sizeof(error));
    EXPECT_NE(model, nullptr) << error;
    return ModelPtr(model);
  }
  TempFolder folder_;
};

TEST_F(WorldTest, NamesElementsOfATypeInOrder) {
  const World world = *compile(folder_.path() / "arm.xml");
  EXPECT_THAT(*world.names("body"), ElementsAre("world", "base", "link"));
  EXPECT_THAT(*world.names("joint"), ElementsAre("", "hinge"));
  EXPECT_THAT(*world.names("key"), ElementsAre("home"));
  EXPECT_THAT(*world.names("tendon"), IsEmpty());
  for (const char* type : {"nonsense", "", "xbody", "default"})
    EXPECT_FALSE(world.names(type).ok()) << type;
}

TEST_F(WorldTest, ABareModelIsBitEqualToStock) {
  const Result<World> world = compile(folder_.path() / "arm.xml");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const ModelPtr stock = load_stock(folder_.path() / "arm.xml");
  const mjModel* model = world->compiled()->model.get();
  EXPECT_THAT(compare_models(stock.get(), model), IsEmpty());
  ASSERT_EQ(stock->npaths, model->npaths);
  EXPECT_EQ(std::string(stock->paths, static_cast<size_t>(stock->npaths)),
            std::string(model->paths, static_cast<size_t>(model->npaths)));
  EXPECT_EQ(world->compiled()->initial_key, -1);
}

// A robot whose file attaches another: the nested model's keyframe is the robot's.
TEST_F(WorldTest, KeyframesOfNestedModelsAreTheRobots) {
  folder_.write("hand.xml",
                "<mujoco model='hand'><worldbody><body name='palm'><joint axis='0 0 1'/>"
                "<geom size='.03'/><body mocap='false' name='tip' pos='.1 0 0'><joint name='t'/>"
                "<geom size='.01'/></body></body></worldbody>"
                "<actuator><motor joint='t'/></actuator>"
                "<keyframe><key name='home' qpos='0.2 0.3' ctrl='0.4'/></keyframe></mujoco>");
  folder_.write(
      "reach.xml",
      "<mujoco><asset><model name='hand' file='hand.xml'/></asset><worldbody>"
      "<body name='base'><joint name='b'/><geom size='.1'/><frame pos='0 0 .3'>"
      "<attach model='hand' body='palm' prefix='L_'/></frame></body></worldbody></mujoco>");
  const std::string two =
      "[[robot]]\nname = \"a\"\nfile = \"reach.xml\"\nkeyframe = \"L_home\"\n"
      "[[robot]]\nname = \"b\"\nfile = \"reach.xml\"\nposition = [1, 0, 0]\n";
  const Result<World> world = compile_text("two.toml", two);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel* m = world->compiled()->model.get();
  EXPECT_GE(mj_name2id(m, mjOBJ_KEY, "a/L_home"), 0);
  EXPECT_GE(mj_name2id(m, mjOBJ_KEY, "b/L_home"), 0);
  ASSERT_EQ(m->nq, 6);
  const int key = world->compiled()->initial_key;
  ASSERT_GE(key, 0);
  const std::vector<double> q(m->key_qpos + 6 * key, m->key_qpos + 6 * key + 6);
  EXPECT_THAT(q, ElementsAre(0, 0.2, 0.3, 0, 0, 0));
  EXPECT_EQ(m->key_ctrl[2 * key], 0.4);
  EXPECT_EQ(m->key_ctrl[2 * key + 1], 0);
  EXPECT_TRUE(world->export_mjcf(folder_.path() / "out").ok());
  const std::string wrong =
      error_of("w.toml", "[[robot]]\nname = \"a\"\nfile = \"reach.xml\"\nkeyframe = \"home\"\n");
  EXPECT_THAT(wrong, HasSubstr("'L_home'"));
}

TEST_F(WorldTest, ABareModelStartsFromANamedOrNumberedKeyframe) {
  folder_.write("keys.xml",
                "<mujoco><worldbody><body><joint/><geom size='.1'/></body></worldbody><keyframe>"
                "<key qpos='1'/><key name='home' qpos='2'/></keyframe></mujoco>");
  const Result<Scene> scene = load_scene(folder_.path() / "keys.xml");
  ASSERT_TRUE(scene.ok());
  const auto key_of = [&](const std::string& keyframe) {
    const Result<World> world = World::compile_at(*scene, keyframe);
    return world.ok() ? fmt::format("{}", world->compiled()->initial_key)
                      : world.error().to_string();
  };
  EXPECT_EQ(key_of("home"), "1");
  EXPECT_EQ(key_of("0"), "0");
  EXPECT_THAT(key_of("hom"), HasSubstr("'home'"));
  EXPECT_THAT(key_of("2"), HasSubstr("no keyframe '2'"));
  EXPECT_EQ(World::compile(*scene)->compiled()->initial_key, -1);
}

// The sign of zero in attributes of many kinds survives an export.
TEST_F(WorldTest, AnExportKeepsNegativeZeros) {
  folder_.write("zeros.xml",
                "<mujoco><option gravity='-0.0 0 -9.81' wind='-0 -0 0'/>"
                "<default><geom solmix='1' friction='1 -0.0 0'/><joint ref='-0.0'/></default>"
                "<asset><material name='m' emission='-0.0' rgba='-0.0 0 1 1'/></asset>"
                "<worldbody><light pos='-0.0 0 1' diffuse='-0.0 0 1'/>"
                "<geom pos='-0.0 -0.0 0' size='.1 -0.0 -0.0' material='m'/>"
                "<geom pos='0 -0.0 1' size='.1'/><site name='s' pos='-0.0 0 -0.0'/>"
                "<site name='s2' pos='-0.0 0 1'/>"
                "<body name='a' pos='-0.0 0 -0.0' quat='1 -0.0 0 -0.0'>"
                "<joint name='j' pos='-0.0 0 0' axis='-0.0 0 1' range='-0.0 90' damping='-0.0'/>"
                "<geom size='.1' margin='-0.0' surfacevel='-0.0 0 0 0 0 -0.0'/>"
                "<camera pos='0 -0.0 0'/><body pos='0 0 1'>"
                "<joint type='slide' name='k' axis='0 -0.0 1'/><geom size='.1'/></body></body>"
                "</worldbody><tendon><spatial name='t' range='-0.0 1'><site site='s'/>"
                "<site site='s2'/></spatial></tendon>"
                "<actuator><motor joint='j' gear='1 -0.0' ctrlrange='-0.0 1'/></actuator>"
                "<keyframe><key name='h' qpos='-0.0 0' qvel='-0.0 0' ctrl='-0.0'/></keyframe>"
                "</mujoco>");
  const Result<World> world = compile(folder_.path() / "zeros.xml");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_TRUE(std::signbit(world->compiled()->model->geom_pos[0]));
  const Status status = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(status.ok()) << status.error().to_string();
  const ModelPtr again = load_stock(folder_.path() / "out" / "scene.xml");
  EXPECT_THAT(compare_models(world->compiled()->model.get(), again.get()), IsEmpty());
}

// A quaternion made of Euler angles, an axis and an angle or an axis has zeros of both signs.
TEST_F(WorldTest, AnExportKeepsNegativeZerosOfOrientations) {
  std::string bodies;
  for (const char* a : {"-0", "0", "90", "-180"})
    for (const char* b : {"-0", "0", "-90"})
      for (const char* c : {"-0", "0", "30"})
        bodies += fmt::format(
            "<body pos='1 -0 0' euler='{0} {1} {2}'><geom size='.1' euler='{0} {1} {2}'/>"
            "<camera euler='{1} {0} {2}'/><frame euler='{2} {1} {0}'><site pos='-0 0 1'/></frame>"
            "<body axisangle='{2} {1} 1 {0}'><inertial mass='1' pos='-0 0 0' euler='{1} {2} {0}' "
            "diaginertia='1 2 2.5'/><geom size='.1' zaxis='{0} 1 {1}'/></body></body>",
            a, b, c);
  folder_.write("euler.xml", "<mujoco><worldbody>" + bodies + "</worldbody></mujoco>");
  const Result<World> world = compile(folder_.path() / "euler.xml");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Status status = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(status.ok()) << status.error().to_string();
}

TEST_F(WorldTest, CompareModelsFindsOneBit) {
  const ModelPtr a = load_stock(folder_.path() / "arm.xml");
  const ModelPtr b = load_stock(folder_.path() / "arm.xml");
  b->mesh_vert[0] = std::nextafter(b->mesh_vert[0], 9.0f);
  b->opt.gravity[2] = -9.8;
  EXPECT_THAT(compare_models(a.get(), b.get()), ElementsAre("opt.gravity", "mesh_vert"));
}

TEST_F(WorldTest, NamesResolveOnceAndWrongOnesGetAdvice) {
  const Result<World> world = compile(folder_.path() / "arm.xml");
  ASSERT_TRUE(world.ok());
  EXPECT_EQ(world->find_joint("hinge")->id, 1);
  EXPECT_EQ(world->find_body("link")->id, 2);
  EXPECT_EQ(world->find_actuator("motor")->id, 0);
  EXPECT_EQ(world->find_sensor("angle")->id, 0);
  EXPECT_EQ(world->find_camera("eye")->id, 0);
  EXPECT_EQ(world->find_geom("ball")->id, 1);
  const Result<Joint> wrong = world->find_joint("hing");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().to_string(), "there is no joint 'hing' (did you mean 'hinge'?)");
}

TEST_F(WorldTest, InfoSaysWhatIsThere) {
  const WorldInfo info = compile(folder_.path() / "arm.xml")->info();
  ASSERT_EQ(info.bodies.size(), 3u);
  EXPECT_EQ(info.joints[1].name, "hinge");
  EXPECT_THAT(info.joints[1].detail, HasSubstr("hinge, range -0.1745 0.1745 rad"));
  EXPECT_EQ(info.actuators[0].detail, "joint 'hinge', control -1 1");
  EXPECT_THAT(info.geoms[0].detail, HasSubstr("mesh 'part'"));
  EXPECT_EQ(info.nq, 8);
  EXPECT_EQ(info.timestep, 0.001);
  EXPECT_EQ(info.triangles, 4);
  // A tetrahedron of 1/6 m³ and a ball of 0.05 m radius, of water's density.
  EXPECT_NEAR(info.mass, 1000.0 / 6 + 1000 * 4.0 / 3 * 3.14159265 * 0.05 * 0.05 * 0.05, 1e-5);
  EXPECT_GT(info.model_bytes, 0);
}

// --- levels of several files ---

constexpr const char* kLevel = R"(
[environment]
file = "room.xml"
[[robot]]
name = "left"
file = "arm.xml"
position = [1, 2, 0]
orientation = [0.7071067811865476, 0, 0, 0.7071067811865476]
keyframe = "home"
[[robot]]
name = "right"
file = "arm.xml"
position = [0, -2, 0]
[[camera]]
name = "watch"
track = "left/base"
position = [-1, 0, 0.5]
look_at = [0, 0, 0]
width = 320
height = 240
[[camera]]
name = "top"
position = [0, 0, 5]
look_at = [0, 0, 0]
)";
constexpr const char* kRoom = R"(<mujoco><option timestep="0.004"/>
<asset><texture name="tiles" type="2d" builtin="checker" width="8" height="8" rgb1="1 0 0"/>
<material name="tiles" texture="tiles"/></asset>
<worldbody><light pos="0 0 3"/><geom name="floor" type="plane" size="5 5 1" material="tiles"/>
<body name="box" pos="3 0 1"><freejoint/><geom type="box" size=".1 .1 .1"/></body></worldbody>
</mujoco>)";

class LevelTest : public WorldTest {
 protected:
  LevelTest() {
    folder_.write("room.xml", kRoom);
    Result<World> world = compile_text("level.toml", kLevel);
    EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().to_string());
    world_ = std::move(world).value();
    model_ = world_.compiled()->model.get();
  }
  World world_;
  const mjModel* model_ = nullptr;
};

TEST_F(LevelTest, OneModelHoldsEveryRobotUnderItsPrefix) {
  EXPECT_TRUE(world_.find_joint("left/hinge").ok());
  EXPECT_TRUE(world_.find_joint("right/hinge").ok());
  EXPECT_TRUE(world_.find_geom("floor").ok());
  EXPECT_EQ(model_->nu, 2);
  const auto& robots = world_.compiled()->robots;
  ASSERT_EQ(robots.size(), 2u);
  EXPECT_EQ(robots[0].prefix, "left/");
  EXPECT_EQ(robots[0].root_body, world_.find_body("left/base")->id);
  EXPECT_EQ(robots[1].root_body, world_.find_body("right/base")->id);
}

TEST_F(LevelTest, SettingsMergeByMuJoCosRulesAndLosersAreReported) {
  EXPECT_EQ(model_->opt.timestep, 0.001);  // the smaller one
  EXPECT_EQ(model_->opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(model_->opt.impratio, 10);
  folder_.write("other.xml",
                "<mujoco><option integrator='RK4'/><worldbody><body name='b'><freejoint/>"
                "<geom size='.1'/></body></worldbody></mujoco>");
  folder_.write("implicit.xml", "<mujoco><option integrator='implicitfast'/></mujoco>");
  const Result<World> clash =
      compile_text("clash.toml",
                   "[environment]\nfile = \"implicit.xml\"\n[[robot]]\nname = \"r\"\n"
                   "file = \"other.xml\"\n");
  ASSERT_TRUE(clash.ok()) << clash.error().to_string();
  EXPECT_EQ(clash->compiled()->model->opt.integrator, mjINT_IMPLICITFAST);
  ASSERT_EQ(clash->info().unsupported.size(), 1u);
  EXPECT_THAT(clash->info().unsupported[0].to_string(), HasSubstr("other.xml:1: "));
  EXPECT_THAT(clash->info().unsupported[0].to_string(), HasSubstr("integrator"));
}

TEST_F(LevelTest, TheStartIsMadeOfTheRobotsKeyframes) {
  const int key = world_.compiled()->initial_key;
  ASSERT_GE(key, 0);
  EXPECT_STREQ(mj_id2name(model_, mjOBJ_KEY, key), "initial");
  const mjtNum* qpos = model_->key_qpos + key * model_->nq;
  const mjtNum* qvel = model_->key_qvel + key * model_->nv;
  const int left = model_->body_jntadr[world_.find_body("left/base")->id];
  const mjtNum* root = qpos + model_->jnt_qposadr[left];
  // (0, 0, 2) of the robot's file, turned by 90 degrees and put to (1, 2, 0).
  EXPECT_NEAR(root[0], 1, 1e-12);
  EXPECT_NEAR(root[1], 2, 1e-12);
  EXPECT_NEAR(root[2], 2, 1e-12);
  EXPECT_NEAR(root[3], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(root[6], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(qvel[model_->jnt_dofadr[left] + 1], 1, 1e-12);  // forward is +Y now
  EXPECT_EQ(qpos[model_->jnt_qposadr[world_.find_joint("left/hinge")->id]], 0.1);
  EXPECT_EQ(qpos[model_->jnt_qposadr[world_.find_joint("right/hinge")->id]], 0);
  EXPECT_EQ(model_->key_ctrl[key * model_->nu], 0.5);
  EXPECT_EQ(model_->key_ctrl[key * model_->nu + 1], 0);
  const int box = model_->body_jntadr[world_.find_body("box")->id];
  EXPECT_EQ(qpos[model_->jnt_qposadr[box]], 3);  // everything else stays at qpos0
}

TEST_F(LevelTest, CamerasLookWhereTheyShould) {
  mjData* data = mj_makeData(model_);
  mj_kinematics(model_, data);
  mj_camlight(model_, data);
  const int top = world_.find_camera("top")->id;
  EXPECT_NEAR(data->cam_xpos[3 * top + 2], 5, 1e-12);
  EXPECT_NEAR(data->cam_xmat[9 * top + 8], 1, 1e-12);  // -Z of the camera points down
  const int watch = world_.find_camera("watch")->id;
  EXPECT_EQ(model_->cam_mode[watch], mjCAMLIGHT_TRACK);
  EXPECT_EQ(model_->cam_resolution[2 * watch], 320);
  const int body = world_.find_body("left/base")->id;
  // The body is turned; the offset is in world axes all the same, and stays when the body turns on.
  for (const double turn : {0.0, 1.0}) {
    mjtNum* qpos = data->qpos + model_->jnt_qposadr[model_->body_jntadr[body]];
    const mjtNum axis[3] = {0, 0, 1};
    mju_axisAngle2Quat(qpos + 3, axis, turn);
    mj_kinematics(model_, data);
    mj_camlight(model_, data);
    const mjtNum* p = data->cam_xpos + 3 * watch;
    const mjtNum* b = data->xpos + 3 * body;
    EXPECT_NEAR(p[0] - b[0], -1, 1e-9);
    EXPECT_NEAR(p[1] - b[1], 0, 1e-9);
    EXPECT_NEAR(p[2] - b[2], 0.5, 1e-9);
    // -Z looks from the camera to the body, +Y leans up.
    const mjtNum* R = data->cam_xmat + 9 * watch;
    EXPECT_NEAR(-R[2], 1 / std::sqrt(1.25), 1e-9);
    EXPECT_NEAR(-R[8], -0.5 / std::sqrt(1.25), 1e-9);
    EXPECT_GT(R[7], 0);
  }
  mj_deleteData(data);
}

TEST_F(LevelTest, ExportIsLoadedByStockMuJoCoToTheSameModel) {
  const fs::path out = folder_.path() / "out";
  const Status status = world_.export_mjcf(out);
  ASSERT_TRUE(status.ok()) << status.error().to_string();
  EXPECT_TRUE(fs::exists(out / "assets" / "part.obj"));
  const ModelPtr stock = load_stock(out / "scene.xml");
  EXPECT_THAT(compare_models(stock.get(), model_), IsEmpty());
}

TEST_F(LevelTest, ErrorsNameTheSceneAndWhatExists) {
  EXPECT_THAT(
      error_of("k.toml", "[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\nkeyframe = \"hom\"\n"),
      HasSubstr("k.toml:1:1: robot 'a' has no keyframe 'hom' (did you mean 'home'?)"));
  EXPECT_THAT(
      error_of("c.toml",
               "[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\n[[camera]]\n"
               "name = \"c\"\nbody = \"a/bse\"\n"),
      HasSubstr(
          "c.toml:4:1: camera 'c': there is no body or site 'a/bse' (did you mean 'a/base'?)"));
  EXPECT_THAT(error_of("t.toml",
                       "[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\n[[camera]]\n"
                       "name = \"a/eye\"\nbody = \"a/base\"\n"),
              HasSubstr("already has a camera named 'a/eye'"));
  folder_.write("key.xml",
                "<mujoco>\n<worldbody><geom size='.1'/></worldbody>\n<keyframe>\n"
                "<key name='home' ctrl='1 2'/></keyframe></mujoco>");
  EXPECT_THAT(error_of("s.toml", "[[robot]]\nname = \"a\"\nfile = \"key.xml\"\n"),
              HasSubstr("key.xml:4: robot 'a' cannot be added to the scene: Keyframe 'home' has"));
}

TEST_F(WorldTest, ACameraOfTheModelCanBeNamed) {
  const Result<World> world = compile_text(
      "s.toml", "[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\n[[camera]]\nname = \"a/eye\"\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_EQ(world->compiled()->model->ncam, 1);
}

TEST_F(WorldTest, RobotsAloneStandOnAFloor) {
  const Result<World> world =
      compile_text("s.toml", "[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Result<Geom> floor = world->find_geom("floor");
  ASSERT_TRUE(floor.ok());
  EXPECT_EQ(world->compiled()->model->geom_type[floor->id], mjGEOM_PLANE);
  const Status exported = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(exported.ok()) << exported.error().to_string();
}

TEST_F(WorldTest, TheTimestepCanBeSet) {
  Scene scene = load_scene(folder_.path() / "arm.xml").value();
  scene.sim.timestep = 0.0005;
  const Result<World> world = World::compile(scene);
  ASSERT_TRUE(world.ok());
  EXPECT_EQ(world->compiled()->model->opt.timestep, 0.0005);
  ASSERT_TRUE(world->export_mjcf(folder_.path() / "out").ok());
  EXPECT_EQ(load_stock(folder_.path() / "out" / "scene.xml")->opt.timestep, 0.0005);
}

// Different compilers of two robots, and two different files of one name.
TEST_F(WorldTest, RobotsWithUnlikeCompilersExport) {
  folder_.write("other/part.obj",
                "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  folder_.write("other/arm.xml",
                "<mujoco><compiler angle='radian' eulerseq='zyx'/><asset><mesh name='part' "
                "file='part.obj'/></asset><worldbody><body euler='.1 .2 .3'><freejoint/>"
                "<geom type='mesh' mesh='part'/></body></worldbody></mujoco>");
  const Result<World> world =
      compile_text("s.toml",
                   "[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\n[[robot]]\nname = \"b\"\n"
                   "file = \"other/arm.xml\"\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Status exported = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(exported.ok()) << exported.error().to_string();
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "assets" / "part_2.obj"));
}

// One file has one <compiler>: only compiled values can say it, and those of turned meshes are as
// near as rounding.
TEST_F(WorldTest, WhatOnlyCompiledValuesSayIsExportedWithItsMeshes) {
  folder_.write("other/part.obj",
                "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  folder_.write("other/arm.xml",
                "<mujoco><compiler inertiafromgeom='true' meshdir='.'/><asset><mesh name='part' "
                "file='part.obj'/></asset><worldbody><body><inertial pos='0 0 0' mass='1' "
                "diaginertia='1 1 1'/><freejoint/><geom type='mesh' mesh='part'/></body>"
                "</worldbody></mujoco>");
  const Result<World> world =
      compile_text("s.toml",
                   "[[robot]]\nname = \"a\"\nfile = \"arm.xml\"\n[[robot]]\nname = \"b\"\n"
                   "file = \"other/arm.xml\"\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Status exported = world->export_mjcf(folder_.path() / "out");
  ASSERT_FALSE(exported.ok());
  EXPECT_THAT(exported.error().message, HasSubstr("compiled values: differs in"));
  const ModelPtr stock = load_stock(folder_.path() / "out" / "scene.xml");
  const mjModel* m = world->compiled()->model.get();
  ASSERT_EQ(stock->ngeom, m->ngeom);
  ASSERT_EQ(stock->nmeshvert, m->nmeshvert);
  for (mjtSize i = 0; i < 4 * m->ngeom; ++i)
    EXPECT_NEAR(stock->geom_quat[i], m->geom_quat[i], 1e-12);
}

TEST_F(WorldTest, ExportSaysWhenItCannotWrite) {
  const Result<World> world = compile(folder_.path() / "arm.xml");
  ASSERT_TRUE(world.ok());
  folder_.write("taken", "a file");
  const Status status = world->export_mjcf(folder_.path() / "taken");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().kind, ErrorKind::kIo);
}

TEST_F(WorldTest, ExportNoticesFilesThatChanged) {
  const Result<World> world = compile(folder_.path() / "arm.xml");
  ASSERT_TRUE(world.ok());
  folder_.write("arm.xml", "<mujoco/>");
  const Status status = world->export_mjcf(folder_.path() / "out");
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().to_string(), HasSubstr("have changed"));
}

// --- bad models ---

TEST_F(WorldTest, ErrorsNameFileAndLine) {
  EXPECT_THAT(error_of("a.xml", "<mujoco>\n<worldbody>\n<geom sise='1'/></worldbody></mujoco>"),
              HasSubstr("a.xml:3: Schema violation: unrecognized attribute: 'sise' in <geom>"));
  EXPECT_THAT(
      error_of("b.xml",
               "<mujoco>\n<worldbody>\n<body name='x'>\n<joint/></body></worldbody></mujoco>"),
      HasSubstr("b.xml:3: mass and inertia of moving bodies"));
  EXPECT_THAT(
      error_of("c.xml", "<mujoco>\n<asset>\n<mesh file='nope.stl'/></asset></mujoco>"),
      HasSubstr("c.xml:3: '" + (folder_.path() / "nope.stl").string() + "' does not exist"));
  EXPECT_THAT(error_of("d.xml", "<mujoco><worldbody><geom size='nan'/></worldbody></mujoco>"),
              HasSubstr("d.xml:1"));
  EXPECT_THAT(error_of("e.xml", "<mujoco><worldbody><geom size='a lot'/></worldbody></mujoco>"),
              HasSubstr("e.xml:1"));
  folder_.write("tex.png", "this is text\n");
  EXPECT_THAT(error_of("f.xml",
                       "<mujoco>\n<asset>\n<texture name='t' type='2d' file='tex.png'/>"
                       "</asset></mujoco>"),
              HasSubstr("f.xml:3"));
  folder_.write("text.stl", "this is text\n");
  EXPECT_THAT(error_of("g.xml",
                       "<mujoco>\n<asset>\n\n<mesh name='t' file='text.stl'/>"
                       "</asset></mujoco>"),
              HasSubstr("g.xml:4"));
  EXPECT_THAT(error_of("h.xml", "<mujoco><asset>\n<mesh file='/etc/passwd'/></asset></mujoco>"),
              HasSubstr("h.xml:2: '/etc/passwd' lies outside"));
  EXPECT_FALSE(fs::exists("MUJOCO_LOG.TXT"));
}

TEST_F(WorldTest, ErrorsInIncludedFilesNameThem) {
  folder_.write("part.xml", "<mujoco>\n\n\n<worldbody><geom sise='1'/></worldbody></mujoco>");
  EXPECT_THAT(error_of("a.xml", "<mujoco>\n<include file='part.xml'/></mujoco>"),
              HasSubstr("part.xml:4: Schema violation"));
}

TEST_F(WorldTest, ARangeOfThreadsMayCompileAtOnce) {
  std::vector<std::string> errors(4);
  std::vector<std::thread> threads;
  for (std::string& error : errors) {
    threads.emplace_back([&] {
      for (int i = 0; i < 5 && error.empty(); ++i) {
        const Result<World> world = compile(folder_.path() / "arm.xml");
        if (!world.ok()) error = world.error().to_string();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(errors, std::vector<std::string>(4));
}

TEST_F(WorldTest, ErrorsAreOneLine) {
  for (const char* text : {"<mujoco><worldbody><geom sise='1'/></worldbody></mujoco>",
                           "<mujoco><default class='a'/></mujoco>",
                           "<mujoco><actuator><motor joint='no'/></actuator></mujoco>"}) {
    const std::string message = error_of("x.xml", text);
    EXPECT_NE(message, "");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace gloam
