// The quadrotor's mixer, path and cascade.

#include <gtest/gtest.h>

#include <cmath>

#include "control/controllers.h"
#include "control/flight/flight_path.h"
#include "control/flight/mixer.h"
#include "robot_world.h"

namespace gloam {
namespace {

// 1.3 kg, 0.2 m arms in an X, motors with a lag of 30 ms.
const char* const kDrone =
    R"(<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
  <body name="frame" pos="0 0 1"><freejoint/><geom type="box" size=".1 .06 .03" mass="1.3"/>
    <site name="a" pos=".14 .18 .05"/><site name="b" pos="-.14 .18 .05"/>
    <site name="c" pos="-.14 -.18 .05"/><site name="d" pos=".14 -.18 .05"/></body></worldbody>
  <default><general ctrllimited="true" ctrlrange="0 10" dyntype="filterexact" dynprm="0.03"/></default>
  <actuator><general site="a" gear="0 0 1 0 0 -.02"/><general site="b" gear="0 0 1 0 0 .02"/>
    <general site="c" gear="0 0 1 0 0 -.02"/><general site="d" gear="0 0 1 0 0 .02"/></actuator></mujoco>)";

RobotOptions drone(FlightOptions flight) {
  RobotOptions options;
  options.controller.type = "quadrotor";
  options.controller.flight = std::move(flight);
  return options;
}

Vec3 position(Simulator& sim) { return base_of(sim).X_WB.p; }

TEST(RotorMixer, GivesTheWrenchThatWasAskedFor) {
  const auto world = make_robot_world(kDrone, drone({}));
  const Multirotor vehicle = *find_multirotor(*world->model, world->robots[0]);
  ASSERT_EQ(vehicle.rotors.size(), 4u);
  EXPECT_NEAR(vehicle.mass, 1.3, 1e-12);
  RotorMixer mixer(vehicle);
  double ctrl[4];
  mixer.mix({13, {0.2, -0.15, 0.02}}, ctrl);
  EXPECT_FALSE(mixer.saturated());
  const Eigen::Vector4d wrench = vehicle.effectiveness * mixer.thrusts();
  EXPECT_NEAR(wrench[0], 13, 1e-9);
  EXPECT_NEAR(wrench[1], 0.2, 1e-9);
  EXPECT_NEAR(wrench[2], -0.15, 1e-9);
  EXPECT_NEAR(wrench[3], 0.02, 1e-9);
}

TEST(RotorMixer, KeepsRollAndPitchWhenRotorsSaturate) {
  const auto world = make_robot_world(kDrone, drone({}));
  const Multirotor vehicle = *find_multirotor(*world->model, world->robots[0]);
  RotorMixer mixer(vehicle);
  double ctrl[4];
  mixer.mix({39.9, {1.0, 0, 0.3}}, ctrl);  // 40 N is the most
  EXPECT_TRUE(mixer.saturated());
  for (double c : ctrl) EXPECT_TRUE(c >= 0 && c <= 10) << c;
  const Eigen::Vector4d wrench = vehicle.effectiveness * mixer.thrusts();
  EXPECT_NEAR(wrench[1], 1.0, 1e-9) << "roll is kept";
  EXPECT_NEAR(wrench[2], 0, 1e-9);
  EXPECT_LT(wrench[0], 39.9) << "thrust gives way";
  EXPECT_LT(wrench[3], 0.3) << "and yaw too";
}

TEST(FlightPath, StopsAtAWaypointInTheTimeOfATrapezoid) {
  FlightOptions options{
      .waypoints = {{.position = {6, 0, 0}}}, .max_speed = 2, .max_acceleration = 4};
  FlightPath path(options);
  path.reset({0, 0, 0}, 0);
  const double dt = 0.002;
  double time = 0, fastest = 0, most = 0;
  while (path.reached() == 0 && time < 10) {
    path.update({}, path.setpoint().p, dt);
    time += dt;
    fastest = std::max(fastest, path.setpoint().v.norm());
    most = std::max(most, path.setpoint().a.norm());
  }
  EXPECT_NEAR(time, 6 / 2.0 + 2 / 4.0, 0.03);  // d / v + v / a
  EXPECT_NEAR(fastest, 2, 1e-9);
  EXPECT_LE(most, 4 * (1 + 1e-9));
  EXPECT_EQ(path.setpoint().p.x(), 6);
  EXPECT_EQ(path.setpoint().v.norm(), 0);
}

TEST(Quadrotor, HoversWhereItStarts) {
  auto sim = start_robot(make_robot_world(kDrone, drone({})));
  double worst = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sim->step(50).ok());
    const Vec3 p = position(*sim);
    worst = std::max(worst, std::hypot(p.x, p.y, p.z - 1));
  }
  EXPECT_LT(worst, 0.25) << "it falls while its motors spin up";
  EXPECT_NEAR(position(*sim).z, 1, 2e-3);
  const Snapshot s = sim->latest();
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(s.control(Actuator{i}), 1.3 * 9.81 / 4, 0.01);
}

TEST(Quadrotor, FliesItsWaypointsWithTheirHeadings) {
  auto sim = start_robot(
      make_robot_world(kDrone, drone({.waypoints = {{.position = {2, 0, 2}, .yaw = 1.0, .hold = 1},
                                                    {.position = {2, 3, 1.5}, .speed = 1}}})));
  ASSERT_TRUE(sim->step(1500).ok());
  EXPECT_NEAR(position(*sim).x, 2, 0.2);
  EXPECT_NEAR(position(*sim).z, 2, 0.1);
  ASSERT_TRUE(sim->step(4000).ok());
  const Vec3 p = position(*sim);
  EXPECT_NEAR(p.x, 2, 0.02);
  EXPECT_NEAR(p.y, 3, 0.02);
  EXPECT_NEAR(p.z, 1.5, 0.02);
  const Quat q = base_of(*sim).X_WB.q;
  EXPECT_NEAR(2 * std::atan2(q.z, q.w), 1.0, 0.02);
}

TEST(Quadrotor, FollowsAVelocityGoalInItsHeadingFrameAndThenHolds) {
  auto sim = start_robot(make_robot_world(kDrone, drone({})));
  ASSERT_TRUE(sim->step(500).ok());
  ASSERT_TRUE(sim->post({.what = SetVelocityGoal{Robot{0, 0}, 0, 0, 1.0}}).ok());
  ASSERT_TRUE(sim->step(785).ok());  // a turn by 90 degrees
  ASSERT_TRUE(sim->post({.what = SetVelocityGoal{Robot{0, 0}, 1.5, 0, 0, 0.5}}).ok());
  ASSERT_TRUE(sim->step(1500).ok());
  const BodyState s = base_of(*sim);
  EXPECT_NEAR(s.velocity.y, 1.5, 0.1) << "forward is now +Y";
  EXPECT_NEAR(s.velocity.x, 0, 0.05);
  EXPECT_NEAR(s.velocity.z, 0.5, 0.05);
  ASSERT_TRUE(sim->post({.what = SetVelocityGoal{Robot{0, 0}}}).ok());
  ASSERT_TRUE(sim->step(1500).ok());
  const Vec3 held = position(*sim);
  ASSERT_TRUE(sim->step(500).ok());
  EXPECT_NEAR(position(*sim).y, held.y, 0.01);
  EXPECT_NEAR(position(*sim).z, held.z, 0.01);
}

TEST(Quadrotor, HoldsItsPlaceAgainstASteadyForce) {
  auto sim = start_robot(make_robot_world(kDrone, drone({})));
  ASSERT_TRUE(sim->step(1000).ok());
  ASSERT_TRUE(sim->post({.what = SetWrench{Body{1}, {3, 0, -1}, {0.02, 0, 0}}}).ok());
  ASSERT_TRUE(sim->step(5000).ok());
  EXPECT_NEAR(position(*sim).x, 0, 0.02);
  EXPECT_NEAR(position(*sim).z, 1, 0.02);
}

TEST(Quadrotor, ContinuesThroughARecompile) {
  const auto options = drone({.waypoints = {{.position = {4, 0, 1}}}});
  const auto world = make_robot_world(kDrone, options);
  auto sim = start_robot(world);
  ASSERT_TRUE(sim->step(500).ok());
  const Vec3 before = position(*sim);
  const auto again = make_robot_world(kDrone, options);
  std::vector<RobotController> controllers;
  controllers.push_back({0, *make_controller(again, again->robots[0]), {500, 1}});
  ASSERT_TRUE(sim->recompile(again, std::move(controllers)).ok());
  ASSERT_TRUE(sim->step(100).ok());
  EXPECT_GT(position(*sim).x, before.x) << "it does not turn back to where it was";
  ASSERT_TRUE(sim->step(3000).ok());
  EXPECT_NEAR(position(*sim).x, 4, 0.02);
}

TEST(Quadrotor, ReportsARobotThatItCannotFly) {
  const char* const kThree = R"(<mujoco><worldbody><body name="frame"><freejoint/>
    <geom size=".1" mass="1"/><site name="a"/></body></worldbody>
    <actuator><general site="a" gear="0 0 1 0 0 0"/></actuator></mujoco>)";
  const auto few = make_robot_world(kThree, drone({}));
  const auto result = make_controller(few, few->robots[0]);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("1 rotors"), std::string::npos) << result.error().message;
  std::string same_turn = kDrone;  // all rotors turn the same way: no yaw
  for (size_t at; (at = same_turn.find("-.02\"/>")) != std::string::npos;)
    same_turn.replace(at, 7, ".02\"/>");
  const auto yawless = make_robot_world(same_turn.c_str(), drone({}));
  EXPECT_FALSE(make_controller(yawless, yawless->robots[0]).ok()) << "nothing turns it about z";
}

}  // namespace
}  // namespace gloam
