// Checkpoints of whole simulations: effects, agents, controllers; claims on robots; joint goals.

#include <gmock/gmock.h>

#include "base/test/source_dir.h"
#include "gloam/controller.h"
#include "gloam/simulation.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;

constexpr const char* kSwingArm = R"(<mujoco model="arm"><option timestep="0.002"/>
<worldbody><body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" damping="1"/>
  <geom type="capsule" size=".05" fromto="0 0 0 .4 0 0"/></body></worldbody>
<actuator><motor name="s" joint="shoulder" gear="20"/></actuator></mujoco>)";

std::unique_ptr<Simulation> start_lockstep(const World& world) {
  return *Simulation::create(world, {.seed = 3, .pace = Pace::kLockstep});
}

World example_world(const char* name) {
  const std::filesystem::path file = source_dir() / "examples" / (std::string(name) + ".toml");
  return *World::compile(*load_scene(file));
}

class ExampleCheckpoint : public testing::TestWithParam<const char*> {};

TEST_P(ExampleCheckpoint, GoesOnWithTheSameBits) {
  const World world = example_world(GetParam());
  const auto first = start_lockstep(world);
  ASSERT_TRUE(first->step(60).ok());
  const Checkpoint checkpoint = *first->checkpoint();
  EXPECT_EQ(checkpoint.hash(), first->stats().hash);
  ASSERT_TRUE(first->step(60).ok());
  const auto second = start_lockstep(world);
  ASSERT_TRUE(second->restore(checkpoint).ok());
  EXPECT_EQ(second->stats().step, 60);
  ASSERT_TRUE(second->step(60).ok());
  EXPECT_EQ(second->stats().hash, first->stats().hash);
}

INSTANTIATE_TEST_SUITE_P(Worlds, ExampleCheckpoint,
                         testing::Values("two_robots", "sand", "pool", "crowd"),
                         [](const auto& info) { return std::string(info.param); });

class ClaimedRobots : public testing::Test {
 protected:
  ClaimedRobots() {
    folder_.write("arm.xml", kSwingArm);
    folder_.write("s.toml",
                  "[[robot]]\nname = \"left\"\nfile = \"arm.xml\"\n[robot.controller]\ntype = "
                  "\"joint_position\"\n[[robot]]\nname = \"right\"\nfile = \"arm.xml\"\n");
    world_.emplace(*World::compile(*load_scene(folder_.path() / "s.toml")));
    simulation_ = start_lockstep(*world_);
  }
  Command control(int robot) const {
    return {.what = SetControls{world_->robots()[static_cast<size_t>(robot)].robot, {0.1}}};
  }

  TempFolder folder_;
  std::optional<World> world_;
  std::unique_ptr<Simulation> simulation_;
};

TEST_F(ClaimedRobots, AreTheirHoldersAlone) {
  const RobotInfo left = world_->robots()[0];
  auto lease = *simulation_->claim(left.robot);
  EXPECT_EQ(lease->robot(), "left");
  EXPECT_THAT(simulation_->post(control(0)).error().to_string(), HasSubstr("claimed"));
  EXPECT_FALSE(simulation_->post({.what = SetControl{left.actuators[0], 1}}).ok());
  EXPECT_FALSE(simulation_->post({.what = SetJointGoal{left.joints[0], 1}}).ok());
  EXPECT_FALSE(simulation_->post({.what = SetVelocityGoal{left.robot, 1, 0, 0}}).ok());
  EXPECT_FALSE(simulation_->post({.what = SetPoseGoal{left.robot, {}}}).ok());
  EXPECT_TRUE(simulation_->post(control(1)).ok());
  EXPECT_TRUE(lease->post(control(0)).ok());
  EXPECT_FALSE(simulation_->claim(left.robot).ok());
  auto other = *simulation_->claim(world_->robots()[1].robot);
  EXPECT_FALSE(lease->post(control(1)).ok());
  EXPECT_FALSE(simulation_->claim({7, 0}).ok());
  lease.reset();
  EXPECT_TRUE(simulation_->post(control(0)).ok());
  EXPECT_TRUE(simulation_->claim(left.robot).ok());
}

TEST_F(ClaimedRobots, StayClaimedThroughARecompile) {
  auto lease = *simulation_->claim(world_->robots()[0].robot);
  world_.emplace(*World::compile(*load_scene(folder_.path() / "s.toml")));
  ASSERT_TRUE(simulation_->recompile(*world_).ok());
  EXPECT_FALSE(simulation_->post(control(0)).ok());
  EXPECT_TRUE(lease->post(control(0)).ok());
}

TEST_F(ClaimedRobots, JointGoalMovesTheJointUntilTheReset) {
  const RobotInfo left = world_->robots()[0];
  const Joint joint = left.joints[0];
  ASSERT_TRUE(simulation_->step(500).ok());
  const double held = simulation_->latest()[joint].position();
  ASSERT_TRUE(simulation_->post({.what = SetJointGoal{joint, -0.5}}).ok());
  ASSERT_TRUE(simulation_->step(2000).ok());
  // A stiff spring of 40 N m/rad against the arm's weight: it sags as it did before.
  EXPECT_NEAR(simulation_->latest()[joint].position() - held, -0.5, 0.1);
  ASSERT_TRUE(simulation_->post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(simulation_->step(500).ok());
  EXPECT_DOUBLE_EQ(simulation_->latest()[joint].position(), held);
  EXPECT_FALSE(simulation_->post({.what = SetJointGoal{joint, NAN}}).ok());
  EXPECT_FALSE(simulation_->post({.what = SetJointGoal{{99, 0}, 0}}).ok());
}

TEST_F(ClaimedRobots, AStreamThatLosesItsSensorTellsItsReader) {
  folder_.write("camera.toml",
                "[[robot]]\nname = \"left\"\nfile = \"arm.xml\"\n[[lidar]]\nname = "
                "\"roof\"\npreset = \"VLP-16\"\n");
  const World with = *World::compile(*load_scene(folder_.path() / "camera.toml"));
  const auto simulation = start_lockstep(with);
  std::mutex mutex;
  std::string told;
  LidarRequest request{.lidar = "roof", .required = true};
  request.on_end = [&](const Error& why) {
    const std::lock_guard lock(mutex);
    told = why.to_string();
  };
  auto stream = *simulation->open_lidar(request, [](auto) {});
  ASSERT_TRUE(simulation->step(60).ok());
  ASSERT_TRUE(simulation->recompile(*world_).ok());
  ASSERT_TRUE(simulation->step(200).ok());
  while (stream->status().ok()) std::this_thread::yield();
  const std::lock_guard lock(mutex);
  EXPECT_THAT(told, HasSubstr("roof"));
}

}  // namespace
}  // namespace gloam
