// Metrics of motions whose numbers are known in closed form.
#include "base/angle.h"
#include "metrics/metrics.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/test/scenes.h"

namespace gloam {
namespace {

/// A ball in free space with start pose and velocity as given (qpos, then qvel), as robot "r" of a
/// scene with velocity goals.
class FreeFlight {
 public:
  FreeFlight(const std::string& qpos, const std::string& qvel,
             const std::vector<VelocityGoal>& goals) {
    Scene scene;
    RobotOptions robot;
    robot.name = "r";
    robot.file =
        folder_.write("ball.xml", R"(
        <mujoco><option timestep="0.01" gravity="0 0 0" integrator="RK4"/><worldbody>
          <body name="ball"><freejoint/><geom type="sphere" size="0.1" mass="1"/></body>
        </worldbody><keyframe><key name="go" qpos=")" +
                                      qpos + "\" qvel=\"" + qvel + "\"/></keyframe></mujoco>");
    robot.keyframe = "go";
    robot.controller.goals = goals;
    scene.robots.push_back(robot);
    scene.environment.file = folder_.write("nothing.xml", "<mujoco/>");
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    Result<World> world = World::compile(scene);
    if (!world.ok()) {
      ADD_FAILURE() << world.error().to_string();
      abort();
    }
    world_ = std::move(*world);
    simulation_ = simulate(world_, {.timestep = 0.01});
    metrics_ = std::move(*Metrics::make(*world_.compiled()));
  }

  /// Moves on by `steps` of 10 ms and measures.
  std::map<std::string, double> sample(int64_t steps) {
    EXPECT_TRUE(simulation_->step(steps).ok());
    return measure();
  }
  std::map<std::string, double> measure() {
    const std::vector<double>& row = metrics_->sample(simulation_->latest());
    EXPECT_EQ(row.size(), metrics_->columns().size());
    std::map<std::string, double> named;
    for (size_t i = 0; i < row.size(); ++i) named[metrics_->columns()[i]] = row[i];
    return named;
  }
  std::map<std::string, double> summary() const {
    const auto numbers = metrics_->summary();
    return {numbers.begin(), numbers.end()};
  }
  const Metrics& metrics() const { return *metrics_; }

 private:
  TempFolder folder_;
  World world_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Metrics> metrics_;
};

TEST(RobotMetrics, AStraightLineUnderAConstantTurn) {
  // 0.5 m/s towards (3, 4) while turning at 1 rad/s: the heading frame turns under the velocity.
  FreeFlight flight(
      "1 2 3 1 0 0 0", "0.3 0.4 0 0 0 1",
      {{.time = 0, .vx = 0.5, .yaw_rate = 1}, {.time = 1, .vx = 0.25, .yaw_rate = 1}});
  double error = 0, goal = 0;
  flight.measure();
  error += std::pow(0.3 - 0.5, 2);
  goal += 0.25;
  for (int i = 1; i <= 40; ++i) {
    auto row = flight.sample(5);
    const double t = 0.05 * i;
    EXPECT_NEAR(row["time_s"], t, 1e-12);
    EXPECT_NEAR(row["r.x_m"], 1 + 0.3 * t, 1e-9);
    EXPECT_NEAR(row["r.y_m"], 2 + 0.4 * t, 1e-9);
    EXPECT_NEAR(row["r.z_m"], 3, 1e-9);
    EXPECT_NEAR(row["r.yaw_rad"], t, 1e-6);
    EXPECT_NEAR(row["r.roll_rad"], 0, 1e-9);
    const double vx = 0.3 * std::cos(t) + 0.4 * std::sin(t);
    EXPECT_NEAR(row["r.vx_mps"], vx, 1e-6);
    EXPECT_NEAR(row["r.vy_mps"], 0.4 * std::cos(t) - 0.3 * std::sin(t), 1e-6);
    EXPECT_NEAR(row["r.yaw_rate_radps"], 1, 1e-9);
    const double wanted = i < 20 ? 0.5 : 0.25;  // the second goal holds from its own instant on
    EXPECT_EQ(row["r.vx_goal_mps"], wanted) << t;
    error += (vx - wanted) * (vx - wanted);
    goal += wanted * wanted;
  }
  auto summary = flight.summary();
  EXPECT_NEAR(summary["r.vx_error_rms_percent"], 100 * std::sqrt(error / goal), 1e-3);
  EXPECT_NEAR(summary["r.yaw_rate_error_rms_percent"], 0, 1e-6);
  EXPECT_EQ(summary.count("r.vy_error_rms_percent"), 0u) << "no goal, no percentage";
  EXPECT_NEAR(summary["r.path_length_m"], 0.5 * 2, 1e-9);
  EXPECT_EQ(summary["r.falls"], 0);
  EXPECT_EQ(flight.metrics().plots().size(), 3u);
}

TEST(RobotMetrics, TheTurnRateIsAboutTheWorldsVertical) {
  // Pitched by 30 degrees and turning about the world's Z: in the body's axes that is (-s, 0, c).
  FreeFlight flight("0 0 1 0.9659258262890683 0 0.25881904510252074 0",
                    "0 0 0 -0.5 0 0.8660254037844386", {});
  for (int i = 1; i <= 10; ++i) {
    auto row = flight.sample(20);
    EXPECT_NEAR(row["r.pitch_rad"], 30 * kDegree, 1e-6);
    EXPECT_NEAR(row["r.yaw_rad"], 0.2 * i, 1e-6);
    EXPECT_NEAR(row["r.yaw_rate_radps"], 1, 1e-6);
  }
}

TEST(RobotMetrics, AFallIsCountedOnceEachTime) {
  // Rolling over at 1 rad/s: beyond 60 degrees from 1.047 s to 5.236 s, and again from 7.330 s.
  FreeFlight rolling("0 0 1 1 0 0 0", "0 0 0 1 0 0", {});
  rolling.measure();
  for (int i = 1; i <= 100; ++i) {
    auto row = rolling.sample(10);
    const double angle = std::fmod(0.1 * i / kDegree, 360);
    EXPECT_EQ(row["r.fallen"], angle > 60 && angle < 300 ? 1 : 0) << angle;
  }
  EXPECT_EQ(rolling.summary()["r.falls"], 2);
  // Sinking at 0.1 m/s: below half of the first height after 5 s.
  FreeFlight sinking("0 0 1 1 0 0 0", "0 0 -0.1 0 0 0", {});
  sinking.measure();
  EXPECT_EQ(sinking.sample(490)["r.fallen"], 0);
  EXPECT_EQ(sinking.sample(20)["r.fallen"], 1);
  EXPECT_EQ(sinking.summary()["r.falls"], 1);
}

TEST(RobotMetrics, WhatNobodyMovesGivesNoColumns) {
  const TempFolder folder;
  const World world = compile_text(folder, "arm.xml",
                                   "<mujoco><worldbody><body><joint/><geom size='1'/></body>"
                                   "</worldbody></mujoco>");
  const auto metrics = std::move(*Metrics::make(*world.compiled()));
  EXPECT_EQ(metrics->columns(), std::vector<std::string>{"time_s"});
  EXPECT_TRUE(metrics->summary().empty());
}

}  // namespace
}  // namespace gloam
