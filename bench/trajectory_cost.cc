// Cost of a joint trajectory for the physics: the additional time of the step that receives one,
// and the call that posts it, which builds the path on the caller's thread.
//
//   bench_trajectory_cost SCENE [--seconds S] [--repeats N]
//
// prints a JSON object with the medians by the number of points, for all joints of the first robot:
// {"joints": 12, "receive_us": {"30": …}, "post_us": {"30": …}, "step_us": …}.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>

#include "bench/command_line.h"
#include "bench/median.h"
#include "gloam/simulation.h"

namespace gloam {
namespace {

constexpr int kWarmUpSteps = 200;
constexpr int kStepsBetween = 20;  // of an earlier trajectory, before the next replaces it

class Stopwatch {
 public:
  double microseconds() const {
    return std::chrono::duration<double, std::micro>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start_ = Clock::now();
};

// Slow sine waves around these positions.
JointTrajectory waves(std::span<const double> positions, int points, double seconds) {
  JointTrajectory trajectory;
  for (int k = 1; k <= points; ++k) {
    TrajectoryPoint point{.time = seconds * k / points};
    for (const double position : positions) {
      point.positions.push_back(position + 0.1 * std::sin(point.time));
      point.velocities.push_back(0.1 * std::cos(point.time));
    }
    trajectory.points.push_back(std::move(point));
  }
  return trajectory;
}

struct Measured {
  std::vector<double> step, receive, post;  // [µs]
};

Result<Measured> measure(Simulation& simulation, const FollowTrajectory& follow, int repeats) {
  Measured measured;
  for (int i = 0; i < repeats; ++i) {
    for (int k = 0; k < kStepsBetween; ++k) {
      const Stopwatch step;
      GLOAM_TRY_STATUS(simulation.step(1));
      measured.step.push_back(step.microseconds());
    }
    const Stopwatch post;
    GLOAM_TRY_STATUS(simulation.post({.what = follow}));
    measured.post.push_back(post.microseconds());
    const Stopwatch receive;
    GLOAM_TRY_STATUS(simulation.step(1));
    measured.receive.push_back(receive.microseconds());
  }
  return measured;
}

void print(const char* name, const std::map<int, double>& values) {
  std::printf("\"%s\": {", name);
  const char* separator = "";
  for (const auto& [points, value] : values) {
    std::printf("%s\"%d\": %.2f", separator, points, value);
    separator = ", ";
  }
  std::printf("}, ");
}

Status run(const std::string& file, double seconds, int repeats) {
  GLOAM_TRY(const Scene scene, load_scene(file));
  GLOAM_TRY(const World world, World::compile(scene));
  if (world.robots().empty())
    return Error{ErrorKind::kInput, "the scene has no robot", {file, 0, 0}};
  GLOAM_TRY(const auto simulation, Simulation::create(world, {.pace = Pace::kLockstep}));
  const RobotInfo robot = world.robots().front();
  const Snapshot now = simulation->latest();
  GLOAM_TRY_STATUS(simulation->step(kWarmUpSteps));
  std::vector<Joint> joints;
  std::vector<double> positions;
  for (const Joint joint : robot.joints) {
    if (now[joint].qpos.size() != 1) continue;
    joints.push_back(joint);
    positions.push_back(now[joint].position());
  }
  std::map<int, double> receive, post;
  std::vector<double> steps;
  for (const int points : {30, 300, 3000, 30'000, 80'000}) {
    const FollowTrajectory follow{robot.robot, joints, waves(positions, points, seconds)};
    GLOAM_TRY(const Measured measured, measure(*simulation, follow, repeats));
    receive[points] = median(measured.receive) - median(measured.step);
    post[points] = median(measured.post);
    steps.push_back(median(measured.step));
  }
  std::printf("{\"joints\": %zu, ", joints.size());
  print("receive_us", receive);
  print("post_us", post);
  std::printf("\"step_us\": %.2f}\n", median(steps));
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::CommandLine line(argc, argv);
  int seconds = 60, repeats = 50;
  line.value("--seconds", &seconds);
  line.value("--repeats", &repeats);
  if (line.words().size() != 1) {
    std::fprintf(stderr, "usage: bench_trajectory_cost SCENE [--seconds S] [--repeats N]\n");
    return 2;
  }
  const gloam::Status done = gloam::run(line.words()[0], seconds, repeats);
  if (done.ok()) return 0;
  std::fprintf(stderr, "bench_trajectory_cost: %s\n", done.error().to_string().c_str());
  return done.error().exit_code();
}
