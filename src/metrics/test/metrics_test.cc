// Metrics of motions in closed form, those that scenes declare, and what is refused.
#include "metrics/metrics.h"

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/files.h"
#include "base/hash.h"
#include "gloam/run.h"
#include "runtime/test/scenes.h"

namespace gloam {
namespace {

using testing::HasSubstr;
using NumbersByName = std::map<std::string, double>;

/// A scene of robots, stepped and measured.
class Measured {
 public:
  /// `model`: of robot "r", from its keyframe "go" if it has one; `more`: lines of the scene;
  /// `place`: the environment.
  explicit Measured(const std::string& model, const std::string& more = "",
                    const std::string& place = "<mujoco/>") {
    folder_.write("r.xml", model);
    folder_.write("nothing.xml", place);
    std::string scene =
        "[environment]\nfile = \"nothing.xml\"\n[[robot]]\nname = \"r\"\nfile = "
        "\"r.xml\"\n";
    if (model.find("<key ") != std::string::npos) scene += "keyframe = \"go\"\n";
    world_ = compile_text(folder_, "scene.toml", scene + more);
    simulation_ = gloam::simulate(world_, {.timestep = 0.002});
    auto metrics = Metrics::make(*world_.compiled());
    if (!metrics.ok()) {
      ADD_FAILURE() << metrics.error().to_string();
      abort();
    }
    metrics_ = std::move(*metrics);
  }

  NumbersByName sample() {
    const std::vector<double>& row = metrics_->sample(simulation_->latest());
    NumbersByName named;
    for (size_t i = 0; i < row.size(); ++i) named[metrics_->columns()[i]] = row[i];
    return named;
  }
  /// Samples at 100 Hz from the present instant to that time; the last.
  NumbersByName run_to(double time) {
    NumbersByName last = sample();
    while (simulation_->latest().time() < time - 1e-9) {
      EXPECT_TRUE(simulation_->step(5).ok());
      last = sample();
    }
    return last;
  }
  NumbersByName summary() const {
    const auto numbers = metrics_->summary();
    return {numbers.begin(), numbers.end()};
  }
  Simulation& simulation() { return *simulation_; }
  Metrics& metrics() { return *metrics_; }

 private:
  TempFolder folder_;
  World world_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Metrics> metrics_;
};

std::string metric(const std::string& name, const std::string& value,
                   const std::string& more = "") {
  return "[[metric]]\nname = \"" + name + "\"\nvalue = '" + value + "'\n" + more + "\n";
}

// A box that slides without friction at 1 m/s.
constexpr const char* kSlidingBox = R"(<mujoco><worldbody>
  <geom name="ground" type="plane" size="9 9 .1" condim="1"/>
  <body name="box" pos="0 0 .1"><freejoint/>
    <geom name="box" type="box" size=".1 .1 .1" mass="2" condim="1"/></body>
  </worldbody><keyframe><key name="go" qpos="0 0 .1 1 0 0 0" qvel="1 0 0 0 0 0"/></keyframe></mujoco>)";

TEST(Metrics, ASlidingBoxHasALengthASpeedAndSlip) {
  Measured box(kSlidingBox,
               metric("load", "contacts(\"r/box\", \"r/ground\").force", "unit = 'N'") +
                   metric("touches", "contacts(\"r/box*\").count"));
  const NumbersByName last = box.run_to(1);
  EXPECT_NEAR(last.at("r.path_length_m"), 1, 1e-6);
  EXPECT_NEAR(last.at("r.speed_mps"), 1, 1e-6);
  EXPECT_NEAR(last.at("r.slip_mps"), 1, 1e-4);
  EXPECT_NEAR(last.at("load_N"), 2 * 9.81, 0.02) << "it rests on its weight";
  EXPECT_EQ(last.at("touches"), 4) << "corners";
  NumbersByName summary = box.summary();
  EXPECT_EQ(summary.at("r.collisions"), 0) << "what it stands on is hit by nobody";
  EXPECT_NEAR(summary.at("r.slip_length_m"), 1, 0.02);
  EXPECT_EQ(summary.count("r.energy_J"), 0u) << "without actuators";
}

TEST(Metrics, AFallingBallGainsWhatItLoses) {
  Measured ball(R"(<mujoco><option integrator="RK4"/><worldbody><body name="ball"><freejoint/>
    <geom name="ball" size=".1" mass="2"/></body></worldbody>
    <keyframe><key name="go" qpos="0 0 5 1 0 0 0"/></keyframe></mujoco>)",
                metric("kinetic", "kinetic_energy", "reduce = ['last', 'max', 'mean']") +
                    metric("total", "kinetic_energy + potential_energy", "reduce=['min','max']") +
                    metric("drop", "5 - robot.position.z",
                           "robots='*'\nunit='m'\nreduce=['last','integral','rms']") +
                    metric("fast", "norm(body(\"r/ball\").velocity) > 4.95",
                           "reduce=['first_time_true','fraction_true']"));
  ball.run_to(1);
  const NumbersByName s = ball.summary();
  const double g = 9.81;
  EXPECT_NEAR(s.at("kinetic_last"), 0.5 * 2 * g * g, 1e-6);
  EXPECT_NEAR(s.at("total_min"), 2 * g * 5, 1e-6);
  EXPECT_NEAR(s.at("total_max"), 2 * g * 5, 1e-6);
  EXPECT_NEAR(s.at("r.drop_last_m"), 0.5 * g, 1e-9);
  EXPECT_NEAR(s.at("r.drop_integral_ms"), g / 6, 1e-3) << "of g t²/2";
  EXPECT_NEAR(s.at("r.drop_rms_m"), g / 2 / std::sqrt(5), 0.02);
  EXPECT_NEAR(s.at("fast_first_time_true_s"), 0.51, 1e-9) << "the first sample after 0.5 s";
  EXPECT_NEAR(s.at("fast_fraction_true"), 50.0 / 101, 1e-12);
}

TEST(Metrics, AnArmSpendsWhatItsLinkGains) {
  // 2 N m on an inertia of 0.5 kg m² about a free hinge: ω = 4 t, E = ½ I ω².
  Measured arm(R"(<mujoco><option gravity="0 0 0"/><worldbody><body name="link">
    <inertial pos="0 0 0" mass="1" diaginertia=".5 .5 .5"/><joint name="j" axis="0 0 1"/></body>
    </worldbody><actuator><motor name="m" joint="j"/></actuator>
    <keyframe><key name="go" ctrl="2"/></keyframe></mujoco>)",
               metric("torque", "actuator(\"r/m\").force", "unit = 'N m'") +
                   metric("rate", "robot(\"r\").joint(\"j\").velocity", "reduce=['last']") +
                   metric("work", "robot.energy", "robots = 'r'\nreduce = ['last']") +
                   metric("input", "actuator(\"r/m\").power", "reduce = ['integral']"));
  const NumbersByName last = arm.run_to(0.5);
  EXPECT_NEAR(last.at("r.power_W"), 2 * 2, 1e-6);
  EXPECT_EQ(last.at("torque_Nm"), 2);
  EXPECT_EQ(last.count("r.path_length_m"), 0u) << "an arm goes nowhere";
  const NumbersByName s = arm.summary();
  EXPECT_NEAR(s.at("rate_last"), 2, 1e-6);
  EXPECT_NEAR(s.at("r.energy_J"), 0.5 * 0.5 * 2 * 2, 1e-6);
  EXPECT_EQ(s.at("r.work_last"), s.at("r.energy_J"));
  EXPECT_NEAR(s.at("input_integral_s"), s.at("r.energy_J"), 1e-9);
  EXPECT_EQ(s.at("r.collisions"), 0);
  EXPECT_EQ(s.count("r.cost_of_transport"), 0u);
}

TEST(Metrics, ServosAreMeasuredAgainstTheirControls) {
  // Too weak to move its inertia in this time, and told to go beyond its range.
  Measured arm(R"(<mujoco><option gravity="0 0 0"/><worldbody><body>
    <inertial pos="0 0 0" mass="1" diaginertia="1e9 1e9 1e9"/><joint name="j"/>
    <body><inertial pos="0 0 0" mass="1e9" diaginertia="1e9 1e9 1e9"/><joint name="s" type="slide"/>
    </body></body></worldbody>
    <actuator><position joint="j" kp="1" ctrlrange="-1 .3" ctrllimited="true"/>
    <position joint="s" kp="1"/><motor joint="j"/></actuator>
    <keyframe><key name="go" ctrl=".8 -.1 5"/></keyframe></mujoco>)");
  const NumbersByName last = arm.run_to(0.1);
  EXPECT_NEAR(last.at("r.joint_error_rad"), 0.3, 1e-6);
  EXPECT_NEAR(last.at("r.slide_error_m"), 0.1, 1e-6);
  EXPECT_NEAR(arm.summary().at("r.joint_error_rms_rad"), 0.3, 1e-6);
  EXPECT_NEAR(arm.summary().at("r.slide_error_max_m"), 0.1, 1e-6);
}

// A hinge of 2 kg m² and a slide of 2 kg on motors that joint_position makes critically damped
// springs of 5 rad/s: e = e0 (1 + w t) exp(-w t).
constexpr const char* kMotorArm = R"(<mujoco><option gravity="0 0 0" integrator="RK4"/><worldbody>
  <body><inertial pos="0 0 0" mass="1" diaginertia="2 2 2"/><joint name="j" axis="0 0 1"/>
    <body><inertial pos="0 0 0" mass="2" diaginertia="1e-9 1e-9 1e-9"/>
      <joint name="s" type="slide" axis="0 0 1"/></body></body></worldbody>
  <actuator><motor joint="j"/><motor joint="s" gear="3"/></actuator>
  <keyframe><key name="go" qpos=".2 .1"/></keyframe></mujoco>)";
constexpr const char* kSprings =
    "[robot.controller]\ntype = \"joint_position\"\nkp = 50\nkd = 20\n";

TEST(Metrics, JointsThatAControllerHoldsOnMotorsAreMeasuredAgainstItsTargets) {
  Measured arm(kMotorArm, std::string(kSprings) + "target = [0.7, -0.3]\n");
  const double w = 5, t = 0.4, left = (1 + w * t) * std::exp(-w * t);
  const NumbersByName last = arm.run_to(t);
  EXPECT_NEAR(last.at("r.joint_error_rad"), 0.5 * left, 2e-3);
  EXPECT_NEAR(last.at("r.slide_error_m"), 0.4 * left, 2e-3);
  EXPECT_NEAR(arm.summary().at("r.joint_error_max_rad"), 0.5, 1e-9) << "where it begins";
  EXPECT_NEAR(arm.summary().at("r.slide_error_max_m"), 0.4, 1e-9);
}

TEST(Metrics, JointsThatAControllerHoldsWhereTheyBeginHaveThatTarget) {
  Measured arm(kMotorArm, kSprings);
  EXPECT_EQ(arm.run_to(0.1).at("r.joint_error_rad"), 0);
  EXPECT_EQ(arm.summary().at("r.slide_error_max_m"), 0);
}

TEST(Metrics, MotorsWithoutTargetsHaveNoErrors) {
  Measured arm(kMotorArm);
  EXPECT_EQ(arm.run_to(0.1).count("r.joint_error_rad"), 0u);
}

// A cart on two slides whose velocity a hook sets; nothing is in its way.
constexpr const char* kPlanarCart =
    R"(<mujoco><option gravity="0 0 0"/><worldbody><body name="cart">
  <joint name="x" type="slide" axis="1 0 0"/><joint name="y" type="slide" axis="0 1 0"/>
  <geom size=".1" mass="1"/></body></worldbody>
  <actuator><motor joint="x"/><motor joint="y"/></actuator></mujoco>)";

std::string goal(double x, double y, const std::string& more = "") {
  return "[[goal]]\nrobot = 'r'\nposition = [" + std::to_string(x) + ", " + std::to_string(y) +
         ", 0]\nradius = 0.005\ntop_speed = 2\n" + more + "\n";
}

TEST(Metrics, AStraightWayHasAnSplOfOne) {
  Measured cart(kPlanarCart, goal(1, 0) + metric("close", "robot.goal_distance < 0.5",
                                                 "robots = 'r'\nreduce = ['first_time_true']"));
  EXPECT_TRUE(
      cart.simulation().set_step_hook([](const mjModel*, mjData* d) { d->qvel[0] = 1; }).ok());
  const NumbersByName last = cart.run_to(1.5);
  EXPECT_EQ(last.at("r.success"), 1);
  EXPECT_NEAR(last.at("r.goal_distance_m"), 0.5, 0.01) << "it went on";
  const NumbersByName s = cart.summary();
  EXPECT_NEAR(s.at("r.time_to_goal_s"), 1, 0.011);
  EXPECT_NEAR(s.at("r.spl"), 1, 0.01);
  EXPECT_NEAR(s.at("r.sct"), 0.5, 0.01) << "it could go twice as fast";
  EXPECT_NEAR(s.at("r.close_first_time_true_s"), 0.51, 0.011);
  EXPECT_NEAR(s.at("r.path_length_m"), 1.5, 0.01);
}

TEST(Metrics, AWayRoundACornerHasItsShareOfSpl) {
  const auto drive = [](const mjModel*, mjData* d) {
    d->qvel[0] = d->time < 1 - 1e-9 ? 1 : 0;
    d->qvel[1] = d->time < 1 - 1e-9 ? 0 : 1;
  };
  Measured around(kPlanarCart, goal(1, 1));
  EXPECT_TRUE(around.simulation().set_step_hook(drive).ok());
  around.run_to(2.5);
  EXPECT_NEAR(around.summary().at("r.spl"), std::sqrt(2) / 2, 0.01) << "the diagonal is shorter";
  Measured told(kPlanarCart, goal(1, 1, "shortest_path = 2"));
  EXPECT_TRUE(told.simulation().set_step_hook(drive).ok());
  told.run_to(2.5);
  EXPECT_NEAR(told.summary().at("r.spl"), 1, 0.01) << "there is a wall, as the scene says";
  Measured legs(kPlanarCart, goal(1, 0) + goal(1, 1));
  EXPECT_TRUE(legs.simulation().set_step_hook(drive).ok());
  const NumbersByName half = legs.run_to(1.5);
  EXPECT_EQ(half.at("r.goals_reached"), 1);
  EXPECT_EQ(half.at("r.success"), 0);
  EXPECT_NEAR(half.at("r.goal_distance_m"), 0.5, 0.01) << "to the second";
  EXPECT_EQ(legs.summary().at("r.spl"), 0) << "not yet";
  EXPECT_EQ(legs.summary().count("r.time_to_goal_s"), 0u);
  legs.run_to(2.5);
  EXPECT_NEAR(legs.summary().at("r.spl"), 1, 0.01);
}

TEST(Metrics, AgentsKnowTheWayRoundAWall) {
  const TempFolder folder;
  folder.write("place.xml", R"(<mujoco><option gravity="0 0 0"/><worldbody>
    <geom type="plane" size="6 6 .1"/><geom type="box" size=".1 2 1" pos="0 0 1"/></worldbody></mujoco>)");
  folder.write("r.xml", R"(<mujoco><worldbody><body name="cart" pos="-1 0 .2">
    <joint name="x" type="slide" axis="1 0 0"/>
    <geom size=".1" mass="1" contype="0" conaffinity="0"/></body></worldbody>
    <actuator><motor joint="x"/></actuator></mujoco>)");
  const auto way = [&](const std::string& agents) {
    const World world = compile_text(folder, "scene.toml", R"(
[environment]
file = "place.xml"
[[robot]]
name = "r"
file = "r.xml"
[[goal]]
robot = "r"
position = [1, 0, 0]
radius = 0.05
top_speed = 1000
)" + agents);
    const auto simulation = simulate(world, {.timestep = 0.002});
    EXPECT_TRUE(simulation->set_step_hook([](const mjModel*, mjData* d) { d->qvel[0] = 2; }).ok());
    const auto metrics = std::move(*Metrics::make(*world.compiled()));
    for (int i = 0; i <= 110; ++i) {
      metrics->sample(simulation->latest());
      EXPECT_TRUE(simulation->step(5).ok());
    }
    const auto numbers = metrics->summary();
    const NumbersByName s(numbers.begin(), numbers.end());
    return s.at("r.sct") * s.at("r.time_to_goal_s") * 1000;
  };
  EXPECT_NEAR(way(""), 2, 1e-9) << "straight through";
  const double found =
      way("[[agent]]\nname = \"ann\"\nbehavior = \"stand\"\nposition = [0, 4, 0]\n");
  EXPECT_GT(found, 2 * std::hypot(1, 2.3)) << "a person of 0.3 m, past the wall's end";
  EXPECT_LT(found, 2 * std::hypot(1, 2.3) + 0.8) << "in voxels of 0.1 m";
}

TEST(Metrics, AGoalThatIsReachedTooLateIsNotReached) {
  Measured cart(kPlanarCart, goal(1, 0, "time_limit = 0.9"));
  EXPECT_TRUE(
      cart.simulation().set_step_hook([](const mjModel*, mjData* d) { d->qvel[0] = 1; }).ok());
  EXPECT_EQ(cart.run_to(1.5).at("r.success"), 0);
  EXPECT_EQ(cart.summary().at("r.spl"), 0);
}

TEST(Metrics, CollisionsAreEpisodesByWhatIsHit) {
  // It flies to a post and back, as a hook sets its speed, above a floor that its foot touches.
  Measured ball(R"(<mujoco><option gravity="0 0 0"/><worldbody>
    <body name="ball" pos="0 0 .3"><joint name="x" type="slide" axis="1 0 0"/>
      <geom name="ball" size=".1" mass="1"/>
      <body pos="0 0 -.201"><geom name="foot" size=".1" mass=".1" condim="1"/></body></body></worldbody>
    <actuator><motor joint="x"/></actuator></mujoco>)",
                metric("force", "robot.contacts(\"ball\", \"post\").force", "robots = 'r'") +
                    metric("stands", "robot.contacts(\"foot\", \"floor\").count", "robots = 'r'"),
                R"(<mujoco><option gravity="0 0 0"/><worldbody>
    <geom name="floor" type="plane" size="5 5 .1" condim="1"/>
    <body name="post" pos="1 0 1.25"><geom type="box" size=".1 1 1"/></body></worldbody></mujoco>)");
  double speed = 2;
  EXPECT_TRUE(
      ball.simulation().set_step_hook([&](const mjModel*, mjData* d) { d->qvel[0] = speed; }).ok());
  NumbersByName row = ball.run_to(0.38);
  EXPECT_EQ(row.at("r.collisions"), 0);
  row = ball.run_to(0.44);
  EXPECT_EQ(row.at("r.collisions"), 1);
  EXPECT_GT(row.at("r.collision_force_N"), 0);
  EXPECT_GT(row.at("r.force"), 0) << "the same by an expression";
  EXPECT_EQ(row.at("r.stands"), 1) << "and standing is none";
  speed = -2;
  ball.run_to(0.5);
  speed = 2;
  EXPECT_EQ(ball.run_to(0.58).at("r.collisions"), 1) << "again within half a second";
  speed = -1;
  EXPECT_EQ(ball.run_to(1.2).at("r.collision_force_N"), 0);
  speed = 2;
  EXPECT_EQ(ball.run_to(1.56).at("r.collisions"), 2) << "after a second without";
  const NumbersByName s = ball.summary();
  EXPECT_EQ(s.at("r.collisions"), 2);
  EXPECT_EQ(s.at("r.collisions.post"), 2);
  EXPECT_GT(s.at("r.collision_force_max_N"), 0);
}

TEST(Metrics, AResetBeginsAnEpisode) {
  Measured box(kSlidingBox, metric("way", "robot.path_length", "robots='*'\nreduce=['max']"));
  box.run_to(0.5);
  const uint64_t hash = box.simulation().latest().hash();
  ASSERT_TRUE(box.simulation().post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(box.simulation().step(1).ok());
  box.run_to(0.202);
  const auto episodes = box.metrics().episodes();
  ASSERT_EQ(episodes.size(), 2u);
  EXPECT_EQ(episodes[0].steps, 250);
  EXPECT_EQ(episodes[0].hash, hash);
  const NumbersByName first(episodes[0].results.begin(), episodes[0].results.end());
  EXPECT_NEAR(first.at("r.path_length_m"), 0.5, 1e-6);
  EXPECT_NEAR(first.at("r.way_max"), 0.5, 1e-6);
  const NumbersByName second(episodes[1].results.begin(), episodes[1].results.end());
  EXPECT_NEAR(second.at("r.path_length_m"), 0.2, 1e-6);
  EXPECT_NEAR(second.at("r.way_max"), 0.2, 1e-6);
  EXPECT_EQ(box.summary(), second) << "the summary is the last episode's";
}

TEST(Metrics, ARateOfItsOwnLeavesCellsEmpty) {
  Measured box(kSlidingBox, metric("slow", "time", "rate = 20\nreduce = ['sum', 'last']"));
  int filled = 0;
  for (int i = 0; i <= 20; ++i) {
    const NumbersByName row = box.sample();
    filled += std::isnan(row.at("slow")) ? 0 : 1;
    EXPECT_EQ(std::isnan(row.at("slow")), i % 5 != 0) << i;
    ASSERT_TRUE(box.simulation().step(5).ok());
  }
  EXPECT_EQ(filled, 5);
  EXPECT_NEAR(box.summary().at("slow_sum"), 0.5, 1e-12);
  EXPECT_TRUE(box.metrics().missing().empty()) << "nothing is missing that nobody asked for";
}

struct MetricRefusal {
  const char* value;
  const char* place;
  const char* message;
  const char* hint;
};

TEST(Metrics, RefusalsTellFileLineAndColumn) {
  const TempFolder folder;
  folder.write("flight.xml", kFlight);
  folder.write("nothing.xml", "<mujoco/>");
  const std::string scene =
      "[environment]\nfile = \"nothing.xml\"\n[[robot]]\nname = \"a\"\nfile = "
      "\"flight.xml\"\nkeyframe = \"go\"\n";  // six lines
  const auto error_of = [&](const std::string& more) {
    const auto metrics = compile_text(folder, "scene.toml", scene + more).metrics();
    EXPECT_FALSE(metrics.ok()) << more;
    return metrics.ok() ? std::string() : metrics.error().to_string();
  };
  const MetricRefusal kRefusals[] = {
      {"1 +", "column 4", "unexpected end", ""},
      {"norm(body(\"a/bal\").velocity)", "column 6", "no body 'a/bal'", "a/ball"},
      {"norm(body(\"a/ball\").velocty)", "column 21", "no 'velocty'", "velocity"},
      {"body(\"a/ball\")", "column 1", "body 'a/ball' needs a field", ".position"},
      {"body(\"a/ball\").position", "column 1", "not a vector", "norm"},
      {"body(\"a/ball\").position.w", "column 25", "'.w'", ".x"},
      {"body.position.x", "column 1", "'body' needs a name", "body(\"NAME\")"},
      {"joint(\"a/ball\").position", "column 1", "neither a hinge nor a slide", "body"},
      {"sensor(\"x\")", "column 1", "no sensor 'x'", ""},
      {"tme", "column 1", "unknown quantity 'tme'", "time"},
      {"robot.speed", "column 1", "the metric has no robot", "robots"},
      {"robot(\"b\").speed", "column 1", "no robot 'b'", "a"},
      {"robot(\"a\").sped", "column 12", "no 'sped'", "speed"},
      {"robot(\"a\").body(\"bll\").up.z", "column 12", "a/bll", "ball"},
      {"contacts(\"a/bal\").count", "column 1", "no geom or body", "a/ball"},
      {"contacts(\"a/*\").size", "column 17", "contacts have no", ""},
      {"bdy(\"a/ball\").position.x", "column 1", "unknown function 'bdy'", "body"},
  };
  for (const auto& [value, place, message, hint] : kRefusals) {
    const std::string error = error_of(metric("m", value));
    EXPECT_THAT(error, HasSubstr("scene.toml:7")) << value;
    EXPECT_THAT(error, HasSubstr(place)) << value;
    EXPECT_THAT(error, HasSubstr(message)) << value;
    EXPECT_THAT(error, HasSubstr(hint)) << value;
  }
  EXPECT_THAT(error_of(metric("m", "1", "robots = 'x'")), HasSubstr("no robot 'x'"));
  EXPECT_THAT(error_of(metric("m", "1", "rate = 200")), HasSubstr("metrics_rate"));
  EXPECT_THAT(error_of(metric("m", "1") + metric("m", "2")), HasSubstr("two metrics named 'm'"));
  EXPECT_THAT(error_of("[[goal]]\nrobot = 'x'\nposition = [0, 0, 0]\n"), HasSubstr("no robot 'x'"));
  const auto scene_error = [&](const std::string& more) {
    const auto read = load_scene(folder.write("bad.toml", scene + more));
    EXPECT_FALSE(read.ok()) << more;
    return read.ok() ? std::string() : read.error().to_string();
  };
  EXPECT_THAT(scene_error(metric("m", "1", "reduce = ['meen']")), HasSubstr("mean"));
  EXPECT_THAT(scene_error(metric("m", "1", "vale = 1")), HasSubstr("value"));
  EXPECT_THAT(scene_error("[[metric]]\nname = 'm'\n"), HasSubstr("value"));
  EXPECT_THAT(scene_error(goal(1, 1, "radios = 1")), HasSubstr("radius"));
  EXPECT_THAT(scene_error("[[goal]]\nrobot = 'a'\nposition = [0,0,0]\nradius = 0\n"),
              HasSubstr("radius"));
}

TEST(Metrics, ARunWritesThemAndIsNoOtherForIt) {
  const TempFolder folder;
  const std::string recorded = "[sim]\nduration = 0.1\n[record]\noutputs = ['metrics']\n";
  const World plain = flight(folder, recorded);
  RunRequest request;
  request.out = folder.path() / "plain";
  const uint64_t hash = run_and_record(plain, request, {})->hash;
  const World world =
      flight(folder, recorded +
                         metric("x_squared", "robot.position.x^2",
                                "robots = '*'\nunit = 'm^2'\nreduce = ['last', 'mean']") +
                         metric("late", "sqrt(time - 0.0501)", "reduce = ['max']"));
  request.out = folder.path() / "out";
  const auto report = run_and_record(world, request, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  EXPECT_EQ(report->hash, hash);
  std::ifstream table(request.out / "metrics.csv");
  std::string head, row;
  std::getline(table, head);
  EXPECT_THAT(head, HasSubstr("time_s,a.x_m,a.y_m"));
  EXPECT_TRUE(head.ends_with(",a.x_squared_m2,late")) << head;
  std::getline(table, row);
  EXPECT_TRUE(row.ends_with(",0,")) << "not a number: " << row;
  const auto json = nlohmann::json::parse(read_text_file(request.out / "summary.json").value());
  EXPECT_NEAR(json["results"]["a.x_squared_last_m2"], 0.01, 1e-9);
  EXPECT_NEAR(json["results"]["a.x_squared_mean_m2"], 0.35 * 0.01, 1e-9) << "of 11 samples";
  EXPECT_NEAR(json["results"]["late_max"], std::sqrt(0.0499), 1e-9);
  EXPECT_EQ(json["metrics"]["rows"], 11);
  EXPECT_EQ(json["metrics"]["missing_values"]["late"], 6) << "0 to 0.05 s";
  ASSERT_EQ(json["metrics"]["episodes"].size(), 1u);
  EXPECT_EQ(json["metrics"]["episodes"][0]["final_state_hash"], hash_to_hex(hash));
  EXPECT_EQ(json["metrics"]["episodes"][0]["results"], json["results"]);
  request.out = folder.path() / "bad";
  const auto refused = run_and_record(flight(folder, recorded + metric("m", "tme")), request, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().to_string(), HasSubstr("unknown quantity 'tme'"));
  EXPECT_FALSE(std::filesystem::exists(request.out)) << "before anything is written";
}

TEST(Metrics, AWorldListsThem) {
  const TempFolder folder;
  const World world = flight(folder, metric("up", "robot.up.z", "robots = 'a'\nunit = '%'"));
  const auto list = world.metrics();
  ASSERT_TRUE(list.ok());
  EXPECT_EQ(list->front().name, "a.x_m");
  EXPECT_EQ(list->front().unit, "m");
  EXPECT_EQ(list->front().robot, "a");
  EXPECT_FALSE(list->front().declared);
  EXPECT_EQ(list->back().name, "a.up_percent");
  EXPECT_TRUE(list->back().declared);
}

}  // namespace
}  // namespace gloam
