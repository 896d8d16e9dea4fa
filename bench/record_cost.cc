// Cost of logging to the thread that steps, and the speed of a verification.
//
//   record_cost SCENE FOLDER [--seconds N] [--cameras N] [--pairs N] [--json]
//
// Steps a scene bare and while a log with all its topics and N more cameras of 640 x 480 (default
// 4) is written into FOLDER, in turn; of each the CPU time of the stepping thread, best of the
// pairs. Then the log is verified: its steps per second over those of a bare run, without
// compiling.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "bench/command_line.h"
#include "gloam/log.h"
#include "mcap/mcap_reader.h"
#include "runtime/log/log_recorder.h"
#include "runtime/log/logged_runs.h"

using namespace gloam;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class T>
T taken(Result<T> result) {
  if (result.ok()) return std::move(*result);
  fmt::print(stderr, "gloam: error: {}\n", result.error().to_string());
  std::exit(1);
}

/// One run: CPU time of the stepping thread and wall time [s].
struct Cost {
  double cpu = 0, wall = 0;
};

Cost run(const World& world, int64_t steps, const fs::path& log, bool pictures) {
  auto live =
      taken(LiveSimulation::create(world, {.pace = Pace::kFast}, {.metering = Metering::kNever}));
  std::unique_ptr<LogRecorder> recorder;
  if (!log.empty()) {
    fs::remove(log);
    // 0 cameras: a log without pictures.
    LogRequest request{.file = log};
    request.topics = pictures ? std::vector<std::string>{"*"}
                              : std::vector<std::string>{"/clock", "/tf*", "/*/joint_states"};
    recorder = taken(LogRecorder::start(*live, request));
  }
  const double before = live->simulator().cpu_time();
  const Clock::time_point start = Clock::now();
  if (const Status ran = live->run_until(steps); !ran.ok()) std::exit(1);
  const Cost cost{live->simulator().cpu_time() - before, seconds_since(start)};
  const Snapshot last = live->latest();
  live->simulator().stop();
  if (recorder != nullptr && !recorder->finish(last).ok()) std::exit(1);
  return cost;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line(argc, argv);
  int seconds = 1, cameras = 4, pairs = 3;
  line.value("--seconds", &seconds);
  line.value("--cameras", &cameras, 0);
  line.value("--pairs", &pairs);
  line.flag("--json");  // it prints nothing else
  if (line.words().size() != 2) {
    fmt::print(stderr, "usage: record_cost SCENE FOLDER [--seconds N] [--cameras N] [--pairs N]\n");
    return 2;
  }
  const fs::path log = fs::path(line.words()[1]) / "record_cost.mcap";
  Scene scene = taken(load_scene(line.words()[0]));
  scene.render.tier = "direct";
  scene.render.spp = 1;
  for (int i = 0; i < cameras; ++i) {
    CameraOptions camera;
    camera.name = fmt::format("logged_{}", i);
    camera.position = {0.1 * i, 0, 1.2};
    camera.look_at = Vec3{2, 0.5 * i, 0.8};
    scene.cameras.push_back(camera);
  }
  const World world = taken(World::compile(scene));
  const double timestep = world.info().timestep;
  const auto steps = static_cast<int64_t>(seconds / timestep);
  Cost bare{1e30, 1e30}, logged{1e30, 1e30};
  for (int i = 0; i < pairs; ++i) {
    const Cost a = run(world, steps, {}, false), b = run(world, steps, log, cameras > 0);
    bare = {std::min(bare.cpu, a.cpu), std::min(bare.wall, a.wall)};
    logged = {std::min(logged.cpu, b.cpu), std::min(logged.wall, b.wall)};
  }
  const double megabytes = static_cast<double>(fs::file_size(log)) / 1e6;
  Clock::time_point start = Clock::now();
  {
    const McapReader reader = taken(McapReader::open(log));
    static_cast<void>(taken(LoggedRuns::read(reader, "")));
  }
  const double compiling = seconds_since(start);
  start = Clock::now();
  const LogVerification found = taken(verify_log(log, "", {}));
  const double verifying = seconds_since(start) - compiling;
  fs::remove(log);
  const double n = static_cast<double>(steps);
  fmt::print(
      "{{\"steps\": {}, \"bare_us\": {:.2f}, \"logged_us\": {:.2f}, \"overhead\": {:.4f}, "
      "\"megabytes\": {:.1f}, \"verify_over_bare\": {:.3f}, \"differing\": {}}}\n",
      steps, 1e6 * bare.cpu / n, 1e6 * logged.cpu / n, logged.cpu / bare.cpu - 1, megabytes,
      bare.wall / verifying, found.differing);
  return found.is_equal() ? 0 : 1;
}
