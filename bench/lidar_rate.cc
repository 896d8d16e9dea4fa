// A LiDAR of 64 x 1024 beams near a robot against mj_multiRay with the same rays on the same model:
// CPU time, one thread each, medians of alternating runs; also with two threads, wall time. Ours
// moves sensor and bodies during the scan and tells intensities; theirs is of one instant.
//   lidar_rate SCENE.toml [--runs N] [--footprint RAYS] [--card] [--json]
// With --card instead: wall time of a scan on an NVIDIA GPU, with its points in the host's memory.
// The scene has a [[lidar]] named "lidar".

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "base/parallel.h"
#include "bench/command_line.h"
#include "gloam/simulation.h"
#include "sensors/lidar/lidar_sensor.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

double cpu_ms() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}
double wall_ms() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

struct Arguments {
  std::string scene;
  int runs = 11, footprint = 1;
  bool card = false, json = false;
};

/// The same rays for MuJoCo.
struct MultiRay {
  std::vector<mjtNum> directions, distances;
  std::vector<int> geoms;
  mjtNum p[3];
  void run(const mjModel* model, mjData* data) {
    // What is drawn: collision shapes (groups 3 and up) would be more work.
    const mjtByte groups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
    mj_multiRay(model, data, p, directions.data(), groups, 1, -1, geoms.data(), distances.data(),
                nullptr, static_cast<int>(geoms.size()), mjMAXVAL);
  }
};

Status run(const Arguments& arguments) {
  GLOAM_TRY(Scene scene, load_scene(arguments.scene));
  for (LidarOptions& lidar : scene.lidars) lidar.footprint_rays = arguments.footprint;
  GLOAM_TRY(const World world, World::compile(scene));
  const auto compiled = world.compiled();
  GLOAM_TRY(const RenderDescription description, describe_for_rendering(*compiled));
  GLOAM_TRY(const auto renderer,
            arguments.card ? make_cuda_renderer(description) : make_cpu_renderer(description));
  GLOAM_TRY(const auto lidars, describe_lidars(*compiled));
  if (lidars.empty()) return Error{ErrorKind::kUsage, "the scene has no [[lidar]]"};
  GLOAM_TRY(const auto sensor, LidarSensor::create(description, lidars[0], 1));
  GLOAM_TRY(const auto simulator, Simulator::create(compiled, {.pace = Pace::kLockstep}));
  GLOAM_TRY(const auto solver, PoseSolver::create(compiled));
  simulator->start();

  // The robot falls down while it is scanned.
  const int stretches = lidars[0].options.motion_keys;
  const double timestep = simulator->timestep().value();
  const auto steps = static_cast<int64_t>(0.1 / timestep / stretches);
  std::vector<PoseFrame> keys(static_cast<size_t>(stretches) + 1);
  for (size_t k = 0; k < keys.size(); ++k) {
    GLOAM_TRY_STATUS(simulator->step(steps));
    GLOAM_TRY_STATUS(solver->solve(simulator->latest(), keys[k]));
  }
  const mjModel* model = compiled->model.get();
  DataPtr data(mj_makeData(model));
  mj_setState(model, data.get(), simulator->latest().state().data(), mjSTATE_INTEGRATION);
  mj_forward(model, data.get());

  RenderTurns turns;
  std::shared_ptr<const LidarScan> scan;
  const auto ours = [&] { scan = sensor->scan(*renderer, turns, keys, 0); };
  if (arguments.card) {
    std::vector<double> card_ms;
    for (int i = -2; i < arguments.runs; ++i) {
      const double start = wall_ms();
      ours();
      if (i >= 0) card_ms.push_back(wall_ms() - start);
    }
    fmt::print(
        fmt::runtime(arguments.json
                         ? "{{\"name\": \"lidar_rate\", \"card_ms\": {:.3f}, \"points\": {}}}\n"
                         : "{:.3f} ms on the GPU, {} points\n"),
        median(card_ms), scan->size());
    return {};
  }
  MultiRay theirs;
  const std::vector<LidarFiring> firings =
      lidar_pattern(sensor->model().pattern).fire(sensor->model(), 0);
  const Quat& q = lidars[0].X_BL.q;
  const mjtNum quaternion[4] = {q.w, q.x, q.y, q.z};
  const Vec3& p = lidars[0].X_BL.p;
  theirs.p[0] = p.x, theirs.p[1] = p.y, theirs.p[2] = p.z;
  for (const LidarFiring& firing : firings) {
    const mjtNum d[3] = {firing.d.x, firing.d.y, firing.d.z};
    mjtNum d_W[3];
    mju_rotVecQuat(d_W, d, quaternion);
    theirs.directions.insert(theirs.directions.end(), d_W, d_W + 3);
  }
  theirs.geoms.resize(firings.size());
  theirs.distances.resize(firings.size());

  set_thread_count(1);
  std::vector<double> ours_ms, theirs_ms, two_ms;
  for (int i = -1; i < arguments.runs; ++i) {
    double start = cpu_ms();
    ours();
    const double a = cpu_ms() - start;
    start = cpu_ms();
    theirs.run(model, data.get());
    const double b = cpu_ms() - start;
    set_thread_count(2);
    start = wall_ms();
    ours();
    const double two = wall_ms() - start;
    set_thread_count(1);
    if (i < 0) continue;  // warms up
    ours_ms.push_back(a);
    theirs_ms.push_back(b);
    two_ms.push_back(two);
  }
  // The same work: of the last instant alone, both find the same ranges.
  const std::vector<PoseFrame> still(2, keys.back());
  scan = sensor->scan(*renderer, turns, still, 0);
  size_t next = 0, same = 0, robot = 0;
  for (size_t i = 0; i < firings.size(); ++i) {
    const bool hit = next < scan->size() && scan->ring[next] == firings[i].ring &&
                     scan->column[next] == firings[i].column;
    const double range = hit ? static_cast<double>(scan->range[next++]) : -1;
    same += std::abs(range - theirs.distances[i]) < 1e-3 * std::abs(range) + 1e-4;
    robot += theirs.geoms[i] >= 0 && model->geom_bodyid[theirs.geoms[i]] > 0;
  }
  const double ratio = median(theirs_ms) / median(ours_ms);
  const double share = 1.0 / static_cast<double>(firings.size());
  const std::string text =
      arguments.json
          ? "{{\"name\": \"lidar_rate\", \"ratio\": {:.3f}, \"ours_ms\": {:.2f}, \"multiray_ms\": "
            "{:.2f}, \"two_threads_ms\": {:.2f}, \"beams\": {}, \"same\": {:.4f}, \"on_robot\": "
            "{:.4f}}}\n"
          : "{:.3f} times mj_multiRay: {:.2f} ms against {:.2f} ms; two threads {:.2f} ms; {} "
            "beams, "
            "of which a share of {:.4f} agrees and {:.4f} hits a body\n";
  fmt::print(fmt::runtime(text), ratio, median(ours_ms), median(theirs_ms), median(two_ms),
             firings.size(), static_cast<double>(same) * share, static_cast<double>(robot) * share);
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Arguments arguments;
  gloam::CommandLine line(argc, argv);
  arguments.json = line.flag("--json");
  arguments.card = line.flag("--card");
  line.value("--runs", &arguments.runs);
  line.value("--footprint", &arguments.footprint);
  arguments.footprint = std::min(arguments.footprint, 32);
  if (!line.words().empty()) arguments.scene = line.words().back();
  return gloam::exit_code(gloam::run(arguments));
}
