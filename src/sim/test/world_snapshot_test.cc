// World::snapshot: closed forms, MuJoCo's own numbers, and the state in which a simulation begins.

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "sim/snapshots/pose_solver.h"
#include "sim/snapshots/snapshot.h"
#include "test_world.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A free ball above a floor, a rod of 0.4 m on a hinge at (1, 0, 1), a hand that is moved.
const char* const kRodAndBall = R"(
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 .1"/>
    <body name="ball" pos="0 0 1"><freejoint name="ball"/><geom name="ball" size=".1" mass="2"/></body>
    <body name="rod" pos="1 0 1"><joint name="hinge" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0 0 -.4" size=".02" mass="1" contype="0" conaffinity="0"/>
      <body name="end" pos="0 0 -.4"><geom size=".01" contype="0" conaffinity="0"/></body></body>
    <body name="hand" mocap="true" pos="-1 0 1"><geom size=".05" contype="0" conaffinity="0"/></body>
  </worldbody>
  <actuator><motor name="motor" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/><framepos objtype="body" objname="end"/></sensor>
  <keyframe><key qpos="0 0 1 1 0 0 0 .2" qvel="1 0 0 0 0 0 3" ctrl=".7"/></keyframe>
</mujoco>)";

struct Configured {
  std::shared_ptr<CompiledWorld> compiled = world_from_mjcf(kRodAndBall);
  World world{compiled};
  std::vector<double> qpos = {0.5, 0, 0.09, 2, 0, 0, 0, 0.3};
};

TEST(WorldSnapshot, HasTheConfigurationAtRest) {
  Configured c;
  c.compiled->initial_key = 0;
  const Result<Snapshot> made = c.world.snapshot(c.qpos, 1.5);
  ASSERT_TRUE(made.ok()) << made.error().to_string();
  const Snapshot s = *made;
  EXPECT_THAT(s[Joint{0}].qpos, ElementsAre(0.5, 0, 0.09, 1, 0, 0, 0)) << "a unit quaternion";
  EXPECT_EQ(s[Joint{1}].position(), 0.3);
  for (const int joint : {0, 1})
    for (const double v : s[Joint{joint}].qvel) EXPECT_EQ(v, 0) << "the keyframe's is left out";
  EXPECT_EQ(s.control(Actuator{0}), 0.7) << "the rest is the initial state's";
  EXPECT_EQ(s.time(), 1.5);
  EXPECT_EQ(s.step(), 750);
  EXPECT_EQ(s.world().compiled(), c.compiled);
  const SensorState angle = s[SensorHandle{0}];
  EXPECT_THAT(angle.values, ElementsAre(0.3));
  EXPECT_EQ(angle.stamp, 1.5);
  EXPECT_NEAR(s[SensorHandle{1}].values[0], 1 - 0.4 * std::sin(0.3), 1e-12);
  EXPECT_EQ(s.actuators(Robot{0}), nullptr);
  EXPECT_EQ(s.trajectory(Robot{0}), nullptr);
}

TEST(WorldSnapshot, CanBeSolved) {
  Configured c;
  Instant instant;
  const Snapshot s = *c.world.snapshot(c.qpos);
  ASSERT_TRUE(instant.solve(s).ok());
  const BodyState end = *instant.body(*c.world.find_body("end"));
  EXPECT_NEAR(end.X_WB.p.x, 1 - 0.4 * std::sin(0.3), 1e-12);
  EXPECT_NEAR(end.X_WB.p.z, 1 - 0.4 * std::cos(0.3), 1e-12);
  EXPECT_EQ(end.velocity.x, 0);
  const auto contacts = instant.contacts();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].distance, -0.01, 1e-12) << "the ball is 1 cm in the floor";
  PoseFrame frame;
  const auto solver = PoseSolver::create(c.compiled);
  ASSERT_TRUE((*solver)->solve(s, frame).ok());
  EXPECT_EQ(frame.body_p[3 + 2], 0.09);
}

TEST(WorldSnapshot, OfTheInitialConfigurationIsTheStateInWhichASimulationBegins) {
  const auto compiled = world_from_mjcf(kRichModel);
  const mjModel& model = *compiled->model;
  const auto sim =
      make_simulator(compiled, {.seed = compiled->scene.sim.seed, .pace = Pace::kLockstep});
  const Snapshot begin = sim->latest();
  const Result<Snapshot> made =
      World(compiled).snapshot({model.qpos0, static_cast<size_t>(model.nq)});
  ASSERT_TRUE(made.ok()) << made.error().to_string();
  EXPECT_THAT(made->state(), testing::ElementsAreArray(begin.state()));
  EXPECT_EQ(made->hash(), begin.hash());
  EXPECT_EQ(made->data().sensordata, begin.data().sensordata);
  EXPECT_EQ(made->data().timestep, begin.data().timestep);
}

TEST(WorldSnapshot, TakesPosesOfMocapBodies) {
  const Configured c;
  EXPECT_EQ(c.world.snapshot(c.qpos)->mocap_poses()[0].p.x, -1);
  const Pose there{{1, 2, 3}, {0, 0, 0, 4}};
  const Result<Snapshot> made = c.world.snapshot(c.qpos, 0, {&there, 1});
  ASSERT_TRUE(made.ok()) << made.error().to_string();
  const Pose hand = made->mocap_poses()[0];
  EXPECT_EQ(hand.p.z, 3);
  EXPECT_EQ(hand.q.z, 1);
  Instant instant;
  ASSERT_TRUE(instant.solve(*made).ok());
  EXPECT_EQ(instant.body(*c.world.find_body("hand"))->X_WB.p.y, 2);
}

TEST(WorldSnapshot, EachIsARunOfItsOwn) {
  const Configured c;
  const Snapshot a = *c.world.snapshot(c.qpos), b = *c.world.snapshot(c.qpos);
  EXPECT_NE(a.data().run, b.data().run);
  EXPECT_LT(a.data().run, -1) << "of no simulation, and not unknown";
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(WorldSnapshot, AQuaternionOfZerosIsTheIdentity) {
  Configured c;
  c.qpos[3] = 0;
  EXPECT_THAT((*c.world.snapshot(c.qpos))[Joint{0}].qpos, ElementsAre(0.5, 0, 0.09, 1, 0, 0, 0));
}

TEST(WorldSnapshot, RejectsWhatIsNoConfiguration) {
  const Configured c;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const auto message = [&](const std::vector<double>& qpos, double time,
                           std::vector<Pose> mocap = {}) {
    const Result<Snapshot> made = c.world.snapshot(qpos, time, mocap);
    return made.ok() ? "accepted" : made.error().message;
  };
  EXPECT_THAT(message({}, 0), HasSubstr("8 values, got 0"));
  EXPECT_THAT(message(std::vector<double>(9), 0), HasSubstr("8 values, got 9"));
  for (const double bad : {nan, infinite, -infinite}) {
    std::vector<double> qpos = c.qpos;
    qpos[7] = bad;
    EXPECT_THAT(message(qpos, 0), HasSubstr("qpos[7] must be finite"));
    EXPECT_THAT(message(c.qpos, bad), HasSubstr("time"));
    EXPECT_THAT(message(c.qpos, 0, {{{0, bad, 0}, {1, 0, 0, 0}}}), HasSubstr("mocap[0]"));
  }
  EXPECT_THAT(message(c.qpos, -1e-9), HasSubstr("time"));
  EXPECT_THAT(message(c.qpos, 1e9), HasSubstr("time"));
  EXPECT_THAT(message(c.qpos, 0, std::vector<Pose>(2)), HasSubstr("1 values, got 2"));
}

}  // namespace
}  // namespace gloam
