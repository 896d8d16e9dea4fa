// [override]: what a scene changes in the models that it names.

#include <gtest/gtest.h>

#include "base/files.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/cache/model_cache.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr const char* kRobot = R"(<mujoco>
  <compiler angle="degree"/>
  <default><default class="leg"><joint damping="2" range="-10 10"/></default></default>
  <worldbody>
    <body name="trunk"><freejoint/><geom name="box" type="box" size=".1 .1 .1"/>
      <body name="FR_leg"><joint name="FR_hip" class="leg"/><joint name="FR_knee" class="leg" axis="0 1 0"/>
        <geom name="FR" size=".05"/></body>
      <body name="FL_leg"><joint name="FL_hip" class="leg"/><geom name="FL" size=".05"/></body>
    </body>
  </worldbody>
  <actuator>
    <position name="FR_hip" joint="FR_hip" kp="10"/>
    <motor name="FL_hip" joint="FL_hip"/>
  </actuator>
</mujoco>)";

class Override : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    ASSERT_TRUE(write_text_file_atomic(folder_.path() / "robot.xml", kRobot).ok());
  }
  Result<World> compile(const std::string& overrides, const std::string& robots = "a") {
    std::string text;
    for (const char robot : robots)
      text += std::string("[[robot]]\nname = '") + robot + "'\nfile = 'robot.xml'\n";
    const auto file = folder_.path() / "scene.toml";
    EXPECT_TRUE(write_text_file_atomic(file, text + overrides).ok());
    GLOAM_TRY(scene_, load_scene(file));
    return World::compile(scene_);
  }
  const mjModel* model(const std::string& overrides, const std::string& robots = "a") {
    Result<World> world = compile(overrides, robots);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    world_ = *world;
    return world_.compiled()->model.get();
  }
  std::string complaint(const std::string& overrides) {
    const Result<World> world = compile(overrides);
    if (world.ok()) return "fine";
    Error error = world.error();
    error.loc.file = std::filesystem::path(error.loc.file).filename();
    return error.to_string();
  }
  double damping(const mjModel* m, const char* joint) {
    return m->dof_damping[m->jnt_dofadr[mj_name2id(m, mjOBJ_JOINT, joint)]];
  }
  TempFolder folder_;
  Scene scene_;
  World world_;
};

TEST_F(Override, OfAPatternChangesAllThatFitWhole) {
  const mjModel* m = model("[override.a.joint.\"FR_.*\"]\ndamping = 0.5\n");
  EXPECT_EQ(damping(m, "a/FR_hip"), 0.5);
  EXPECT_EQ(damping(m, "a/FR_knee"), 0.5);
  EXPECT_EQ(damping(m, "a/FL_hip"), 2);
  EXPECT_EQ(complaint("[override.a.joint.\"FR\"]\ndamping = 0.5\n"),
            "scene.toml:5:1: no joint of 'a' matches 'FR' (one of: FR_hip, FR_knee, FL_hip)");
}

TEST_F(Override, AnExactNameBeatsAPatternAndALaterLineAnEarlierOne) {
  const mjModel* m = model(
      "[override.a.joint.FR_hip]\ndamping = 1\n"
      "[override.a.joint.\".*_hip\"]\ndamping = 3\n"
      "[override.a.joint.\"F._hip\"]\ndamping = 4\n");
  EXPECT_EQ(damping(m, "a/FR_hip"), 1);
  EXPECT_EQ(damping(m, "a/FL_hip"), 4);
}

TEST_F(Override, IsOfOneRobot) {
  const mjModel* m = model("[override.b.geom.\".*\"]\nfriction = [0.3, 0.2, 0.1]\n", "ab");
  EXPECT_EQ(m->geom_friction[3 * mj_name2id(m, mjOBJ_GEOM, "b/FR")], 0.3);
  EXPECT_EQ(m->geom_friction[3 * mj_name2id(m, mjOBJ_GEOM, "b/FR") + 2], 0.1);
  EXPECT_EQ(m->geom_friction[3 * mj_name2id(m, mjOBJ_GEOM, "a/FR")], 1);
  EXPECT_EQ(m->geom_friction[3 * mj_name2id(m, mjOBJ_GEOM, "floor")], 1);
}

TEST_F(Override, MeansWhatTheFileWouldSay) {
  const mjModel* m = model(
      "[override.a.joint.FR_knee]\nrange = [-90, 45]\n"
      "[override.a.position.FR_hip]\nkp = 55\n"
      "[override.a.actuator.\".*\"]\nforcerange = [-7, 7]\n"
      "[override.a.body.FL_leg]\neuler = [0, 0, 90]\n"
      "[override.a.geom.box]\nmass = 3\nrgba = [1, 0, 0, 1]\n"
      "[override.environment.geom.floor]\nrgba = '0 1 0 1'\n"
      "[override.environment.option]\ngravity = [0, 0, -1.62]\nflag.contact = false\n"
      "[override.environment.visual.map]\nznear = 0.5\n");
  const int knee = mj_name2id(m, mjOBJ_JOINT, "a/FR_knee");
  EXPECT_NEAR(m->jnt_range[2 * knee], -1.5707963267948966, 1e-15) << "degrees, as in its file";
  const int servo = mj_name2id(m, mjOBJ_ACTUATOR, "a/FR_hip");
  EXPECT_EQ(m->actuator_gainprm[servo * mjNGAIN], 55);
  EXPECT_EQ(m->actuator_biasprm[servo * mjNBIAS + 1], -55);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(m->actuator_forcerange[2 * i + 1], 7);
  const int leg = mj_name2id(m, mjOBJ_BODY, "a/FL_leg");
  EXPECT_NEAR(m->body_quat[4 * leg + 3], 0.70710678, 1e-8);
  EXPECT_NEAR(m->body_mass[mj_name2id(m, mjOBJ_BODY, "a/trunk")], 3, 1e-12);
  EXPECT_EQ(m->geom_rgba[4 * mj_name2id(m, mjOBJ_GEOM, "a/box")], 1);
  EXPECT_EQ(m->geom_rgba[4 * mj_name2id(m, mjOBJ_GEOM, "floor") + 1], 1);
  EXPECT_EQ(m->opt.gravity[2], -1.62);
  EXPECT_TRUE((m->opt.disableflags & mjDSBL_CONTACT) != 0);
  EXPECT_EQ(m->vis.map.znear, 0.5F);
  EXPECT_TRUE(world_.export_mjcf(folder_.path() / "out").ok());
}

TEST_F(Override, ASectionsKindsTakeWhatTheyHave) {
  const mjModel* m = model("[override.a.actuator.\".*_hip\"]\nkp = 21\n");  // a motor has no kp
  EXPECT_EQ(m->actuator_gainprm[mjNGAIN * mj_name2id(m, mjOBJ_ACTUATOR, "a/FR_hip")], 21);
  EXPECT_EQ(complaint("[override.a.actuator.FL_hip]\nkp = 21\n"),
            "scene.toml:5:1: no actuator of 'a' that matches 'FL_hip' has an attribute 'kp'");
}

TEST_F(Override, OtherValuesAreAnotherWorldToTheCache) {
  EXPECT_EQ(damping(model("[override.a.joint.FR_hip]\ndamping = 1\n"), "a/FR_hip"), 1);
  const uint64_t first = world_cache_key(scene_);
  EXPECT_EQ(damping(model("[override.a.joint.FR_hip]\ndamping = 2.5\n"), "a/FR_hip"), 2.5);
  EXPECT_NE(world_cache_key(scene_), first);
}

TEST_F(Override, CanBeSetFromTheCommandLine) {
  ASSERT_TRUE(compile("").ok());
  ASSERT_TRUE(set_option(scene_, "override.a.joint.\"FR_.*\".damping", "0.25").ok());
  const Result<World> world = World::compile(scene_);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_EQ(damping(world->compiled()->model.get(), "a/FR_knee"), 0.25);
  EXPECT_FALSE(set_option(scene_, "override.a.joint.FR_knee.dampign", "0.25").ok());
  EXPECT_FALSE(set_option(scene_, "override", "0.25").ok());
  EXPECT_FALSE(set_option(scene_, "override.a", "0.25").ok());
  EXPECT_FALSE(set_option(scene_, "override.a]\nx", "0.25").ok());
}

TEST_F(Override, MistakesNameTheirLineAndWhatWasMeant) {
  EXPECT_EQ(complaint("[override.b.joint.FR_hip]\ndamping = 1\n"),
            "scene.toml:5:1: there is no robot 'b' (did you mean 'a'?)");
  EXPECT_EQ(complaint("[override.a.jiont.FR_hip]\ndamping = 1\n"),
            "scene.toml:4:13: no element 'jiont' can be overridden (did you mean 'joint'?)");
  EXPECT_EQ(complaint("[override.a.joint.FR_hip]\ndampign = 1\n"),
            "scene.toml:5:1: 'joint' has no attribute 'dampign' (did you mean 'damping'?)");
  EXPECT_EQ(
      complaint("[override.a.joint.FR_hip]\nlimited = 'perhaps'\n"),
      "scene.toml:5:1: limited=\"perhaps\" is not a valid keyword; expected one of false, true, "
      "auto");
  EXPECT_EQ(complaint("[override.a.joint.FR_hpi]\ndamping = 1\n"),
            "scene.toml:5:1: no joint of 'a' matches 'FR_hpi' (did you mean 'FR_hip'?)");
  EXPECT_EQ(complaint("[override.a.joint.\"(\"]\ndamping = 1\n"),
            "scene.toml:5:1: '(' is not a valid regular expression: missing ): (");
  EXPECT_EQ(complaint("[override.a.joint]\ndamping = 1\n"),
            "scene.toml:5:1: an override must be a table (write [override.a.joint.\"NAME\"])");
  EXPECT_EQ(
      complaint("[override.a.option.fast]\ntimestep = 1\n"),
      "scene.toml:4:20: no element 'option/fast' can be overridden (did you mean 'option/flag'?)");
}

}  // namespace
}  // namespace gloam
