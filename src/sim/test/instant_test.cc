// What gloam::Instant tells, against closed forms and against MuJoCo's own numbers.

#include <cmath>

#include "sim/commands/model_fields.h"
#include "test_world.h"

namespace gloam {
namespace {

// A ball of 2 kg rests on the floor, a rod hangs from a hinge, a rope of known length.
const char* const kScene = R"(
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 .1"/>
    <body name="ball" pos="0 0 .1"><freejoint name="ball"/><geom name="ball" size=".1" mass="2"/></body>
    <body name="rod" pos="1 0 1"><joint name="hinge" axis="0 1 0"/>
      <geom name="rod" type="capsule" fromto="0 0 0 0 0 -.4" size=".02" mass="1"/><site name="end" pos="0 0 -.4"/></body>
    <site name="anchor" pos="1 0 0"/>
  </worldbody>
  <tendon><spatial name="rope"><site site="anchor"/><site site="end"/></spatial></tendon>
  <actuator><motor name="motor" joint="hinge" gear="3"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>)";

struct Rig {
  std::shared_ptr<CompiledWorld> compiled = world_from_mjcf(kScene);
  World world{compiled};
  std::unique_ptr<Simulator> sim = make_simulator(compiled, lockstep());
  Instant instant;
  Rig() { sim->start(); }
  void solve() {
    const Status status = instant.solve(sim->latest());
    ASSERT_TRUE(status.ok()) << status.error().to_string();
  }
};

TEST(Instant, ContactsCarryWhatRestsOnThem) {
  Rig run;
  ASSERT_TRUE(run.sim->step(1500).ok());
  run.solve();
  const auto contacts = run.instant.contacts();
  ASSERT_EQ(contacts.size(), 1u);
  const ContactState& c = contacts[0];
  EXPECT_EQ(c.geoms[0].id, run.world.find_geom("floor")->id);
  EXPECT_EQ(c.geoms[1].id, run.world.find_geom("ball")->id);
  EXPECT_EQ(c.geoms[1].world, run.compiled->serial);
  EXPECT_NEAR(c.normal.z, 1, 1e-12);
  EXPECT_NEAR(c.force.z, 2 * 9.81, 1e-3) << "carries the ball's weight";
  EXPECT_NEAR(c.position.z, c.distance / 2, 1e-9);
}

TEST(Instant, VelocitiesForcesAndLengths) {
  Rig run;
  ASSERT_TRUE(
      run.sim->post({.what = SetJointState{*run.world.find_joint("hinge"), {0.3}, {2}}}).ok());
  ASSERT_TRUE(run.sim
                  ->post({.what = SetJointState{*run.world.find_joint("ball"),
                                                {0, 0, 5, 2, 0, 0, 0},
                                                {1, 2, 3, 0, 0, 4}}})
                  .ok());
  ASSERT_TRUE(run.sim->post({.what = SetControl{*run.world.find_actuator("motor"), 0.5}}).ok());
  ASSERT_TRUE(
      run.sim->post({.what = SetWrench{*run.world.find_body("ball"), {0, 0, 7}, {1, 0, 0}}}).ok());
  ASSERT_TRUE(run.sim->step(1).ok());
  run.solve();
  const Snapshot s = run.sim->latest();
  const BodyState ball = *run.instant.body(*run.world.find_body("ball"));
  EXPECT_NEAR(ball.velocity.x, 1, 1e-12);
  EXPECT_NEAR(ball.velocity.z, 3 + 0.002 * (7.0 / 2 - 9.81), 1e-12);
  EXPECT_NEAR(ball.angular_velocity.z, 4, 1e-3);
  EXPECT_EQ(ball.external_force.z, 7);
  EXPECT_EQ(ball.external_torque.x, 1);
  EXPECT_NEAR(ball.X_WB.p.y, 0.004, 1e-9);
  EXPECT_EQ(*run.instant.force(*run.world.find_actuator("motor")), 0.5);
  const double q = s[*run.world.find_joint("hinge")].position();
  EXPECT_NEAR(q, 0.3 + 2 * 0.002, 2e-3);
  const TendonState rope = *run.instant.tendon(*run.world.find_tendon("rope"));
  EXPECT_NEAR(rope.length, std::hypot(0.4 * std::sin(q), 1 - 0.4 * std::cos(q)), 1e-12);
  // By name: the same numbers, and what no handle tells.
  const auto value = [&](const char* field, const char* element) {
    const auto values = run.instant.value(field, element);
    EXPECT_TRUE(values.ok()) << values.error().to_string();
    return values.ok() ? *values : std::vector<double>();
  };
  EXPECT_EQ(value("qpos", "hinge"), std::vector<double>{q});
  EXPECT_EQ(value("qvel", "ball").size(), 6u);
  EXPECT_EQ(value("ctrl", "motor"), std::vector<double>{0.5});
  EXPECT_EQ(value("ten_length", "rope"), std::vector<double>{rope.length});
  EXPECT_EQ(value("sensordata", "angle"), std::vector<double>{q}) << "of this very instant";
  EXPECT_EQ(value("body_mass", "ball"), std::vector<double>{2});
  EXPECT_EQ(value("xfrc_applied", "ball"), (std::vector<double>{0, 0, 7, 1, 0, 0}));
  EXPECT_EQ(value("actuator_gear", "motor")[0], 3);
  EXPECT_EQ(value("opt.gravity", ""), (std::vector<double>{0, 0, -9.81}));
  EXPECT_EQ(value("geom_size", "").size(), 3u * 3);
  EXPECT_EQ(value("qfrc_actuator", "hinge"), std::vector<double>{1.5});
}

TEST(Instant, SeesLiveFields) {
  Rig run;
  ASSERT_TRUE(run.sim->step(1500).ok());
  ASSERT_TRUE(
      run.sim
          ->post(
              {.what = SetLiveField{LiveFieldId::kBodyMass, run.world.find_body("ball")->id, {5}}})
          .ok());
  ASSERT_TRUE(run.sim->step(1500).ok());
  run.solve();
  EXPECT_EQ(*run.instant.value("body_mass", "ball"), std::vector<double>{5});
  ASSERT_EQ(run.instant.contacts().size(), 1u);
  EXPECT_NEAR(run.instant.contacts()[0].force.z, 5 * 9.81, 1e-2);
}

TEST(Instant, MisuseIsAnError) {
  Rig run, other;
  EXPECT_FALSE(run.instant.value("qpos").ok()) << "nothing solved";
  run.solve();
  EXPECT_TRUE(run.instant.body(*run.world.find_body("ball")).ok());
  const auto stale = run.instant.body(*other.world.find_body("ball"));
  ASSERT_FALSE(stale.ok());
  EXPECT_NE(stale.error().to_string().find("another World"), std::string::npos);
  EXPECT_FALSE(run.instant.body({99}).ok());
  EXPECT_FALSE(run.instant.tendon({-1}).ok());
  const auto misspelt = run.instant.value("qpso");
  ASSERT_FALSE(misspelt.ok());
  EXPECT_NE(misspelt.error().to_string().find("qpos"), std::string::npos);
  const auto nobody = run.instant.value("xpos", "bal");
  ASSERT_FALSE(nobody.ok());
  EXPECT_NE(nobody.error().to_string().find("ball"), std::string::npos);
  EXPECT_FALSE(run.instant.value("qLD", "ball").ok()) << "its rows have no names";
}

// Every field that MuJoCo lists can be read of a rich model.
TEST(Instant, EveryFieldCanBeRead) {
  const auto compiled = world_from_mjcf(kRichModel);
  auto sim = make_simulator(compiled, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(200).ok());
  Instant instant;
  ASSERT_TRUE(instant.solve(sim->latest()).ok());
  const auto names = field_names();
  EXPECT_GT(names.size(), 500u);
  for (const std::string& name : names) EXPECT_TRUE(instant.value(name).ok()) << name;
}

}  // namespace
}  // namespace gloam
