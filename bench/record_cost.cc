// Cost of logging to the thread that steps, and the speed of a verification.
//
//   record_cost SCENE FOLDER [--seconds N] [--cameras N] [--pairs N] [--apart] [--spin] [--json]
//
// Steps a scene bare and while a log with all its topics and N more cameras of 640 x 480 (default
// 4) is written into FOLDER, in turn; of each the CPU time of the stepping thread and the wall
// time, median of the pairs, and how often the thread gave its processor up or lost it. Then the
// log is verified: its steps per second over those of a bare run, without compiling.
//   --apart  the stepping thread has processor 0 for itself, all others have processor 1
//   --spin   a thread that does nothing but count runs on processor 1 beside the bare run, in place
//            of the log: the cost of a neighbour alone, which hyperthreads of one core have

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "bench/command_line.h"
#include "bench/median.h"
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

/// One run.
struct Cost {
  double cpu = 0, wall = 0;  // of the stepping thread, of the run [s]
  int64_t waits = 0;         // times the stepping thread gave its processor up
  int64_t preemptions = 0;   // times it lost it
};

struct Beside {
  enum class Load : uint8_t { kNothing, kLog, kSpin } load = Load::kNothing;
  fs::path log;
  bool has_pictures = false;
  bool is_apart = false;
};

// Threads that are made from now on are on this processor alone.
void use_processor(int id) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(id, &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) {
    fmt::print(stderr, "gloam: error: there is no processor {}\n", id);
    std::exit(1);
  }
}

std::set<std::string> threads() {
  std::set<std::string> names;
  for (const auto& task : fs::directory_iterator("/proc/self/task")) names.insert(task.path());
  return names;
}

// Switches of a thread, see "man 5 proc".
Cost switches(const std::string& task) {
  std::ifstream file(task + "/status");
  Cost counted;
  for (std::string key; file >> key;) {
    if (key == "voluntary_ctxt_switches:") file >> counted.waits;
    if (key == "nonvoluntary_ctxt_switches:") file >> counted.preemptions;
  }
  return counted;
}

/// A simulation, and its stepping thread's folder in /proc.
struct Live {
  std::unique_ptr<LiveSimulation> simulation;
  std::string task;
};

Live start(const World& world, bool is_apart) {
  const std::set<std::string> before = threads();
  if (is_apart) use_processor(0);
  Live live{
      taken(LiveSimulation::create(world, {.pace = Pace::kFast}, {.metering = Metering::kNever}))};
  if (is_apart) use_processor(1);
  for (const std::string& task : threads())
    if (!before.contains(task)) live.task = task;
  return live;
}

Cost run(const World& world, int64_t steps, const Beside& beside) {
  const Live live = start(world, beside.is_apart);
  std::unique_ptr<LogRecorder> recorder;
  std::jthread spinning;
  if (beside.load == Beside::Load::kLog) {
    fs::remove(beside.log);
    LogRequest request{.file = beside.log};
    request.topics = beside.has_pictures
                         ? std::vector<std::string>{"*"}
                         : std::vector<std::string>{"/clock", "/tf*", "/*/joint_states"};
    recorder = taken(LogRecorder::start(*live.simulation, request));
  } else if (beside.load == Beside::Load::kSpin) {
    spinning = std::jthread([](const std::stop_token& stop) {
      std::atomic<int64_t> count = 0;
      while (!stop.stop_requested()) ++count;
    });
  }
  Simulator& simulator = live.simulation->simulator();
  const Cost switched = switches(live.task);
  const double before = simulator.cpu_time();
  const Clock::time_point start = Clock::now();
  if (const Status ran = live.simulation->run_until(steps); !ran.ok()) std::exit(1);
  Cost cost = switches(live.task);
  cost.cpu = simulator.cpu_time() - before;
  cost.wall = seconds_since(start);
  cost.waits -= switched.waits;
  cost.preemptions -= switched.preemptions;
  const Snapshot last = live.simulation->latest();
  simulator.stop();
  if (recorder != nullptr && !recorder->finish(last).ok()) std::exit(1);
  return cost;
}

/// Runs of one kind.
struct Runs {
  std::vector<Cost> costs;
  double of(double Cost::* member) const {
    std::vector<double> values;
    for (const Cost& cost : costs) values.push_back(cost.*member);
    return median(values);
  }
  int64_t of(int64_t Cost::* member) const {
    std::vector<double> values;
    for (const Cost& cost : costs) values.push_back(static_cast<double>(cost.*member));
    return static_cast<int64_t>(median(values));
  }
};

// Seconds that `log` takes to be verified, without compiling its scene.
struct Verified {
  double seconds = 0;
  LogVerification found;
};

Verified verify(const fs::path& log) {
  Clock::time_point start = Clock::now();
  {
    const McapReader reader = taken(McapReader::open(log));
    static_cast<void>(taken(LoggedRuns::read(reader, "")));
  }
  const double compiling = seconds_since(start);
  start = Clock::now();
  LogVerification found = taken(verify_log(log, "", {}));
  return {seconds_since(start) - compiling, std::move(found)};
}

// Cameras of 640 x 480 that look into the scene.
void add_cameras(int count, Scene* scene) {
  for (int i = 0; i < count; ++i) {
    CameraOptions camera;
    camera.name = fmt::format("logged_{}", i);
    camera.position = {0.1 * i, 0, 1.2};
    camera.look_at = Vec3{2, 0.5 * i, 0.8};
    scene->cameras.push_back(camera);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line(argc, argv);
  int seconds = 1, cameras = 4, pairs = 3;
  line.value("--seconds", &seconds);
  line.value("--cameras", &cameras, 0);
  line.value("--pairs", &pairs);
  line.flag("--json");  // it prints nothing else
  const bool is_apart = line.flag("--apart"), spins = line.flag("--spin");
  if (line.words().size() != 2) {
    fmt::print(stderr,
               "usage: record_cost SCENE FOLDER [--seconds N] [--cameras N] [--pairs N] [--apart] "
               "[--spin]\n");
    return 2;
  }
  const fs::path log = fs::path(line.words()[1]) / "record_cost.mcap";
  if (is_apart) use_processor(1);
  Scene scene = taken(load_scene(line.words()[0]));
  scene.render.tier = RenderTier::kDirect;
  scene.render.spp = 1;
  add_cameras(cameras, &scene);
  const World world = taken(World::compile(scene));
  const auto steps = static_cast<int64_t>(seconds / world.info().timestep);
  Runs bare, loaded;
  std::vector<double> added;  // by pair
  for (int i = 0; i < pairs; ++i) {
    bare.costs.push_back(run(world, steps, {.is_apart = is_apart}));
    loaded.costs.push_back(run(world, steps,
                               {.load = spins ? Beside::Load::kSpin : Beside::Load::kLog,
                                .log = log,
                                .has_pictures = cameras > 0,
                                .is_apart = is_apart}));
    added.push_back(loaded.costs.back().cpu / bare.costs.back().cpu - 1);
  }
  const double n = static_cast<double>(steps);
  const auto micros = [n](double total) { return 1e6 * total / n; };
  fmt::print(
      "{{\"steps\": {}, \"bare_us\": {:.2f}, \"logged_us\": {:.2f}, \"overhead\": {:.4f}, "
      "\"bare_wall_us\": {:.2f}, \"logged_wall_us\": {:.2f}, \"waits\": [{}, {}], "
      "\"preemptions\": [{}, {}]",
      steps, micros(bare.of(&Cost::cpu)), micros(loaded.of(&Cost::cpu)), median(added),
      micros(bare.of(&Cost::wall)), micros(loaded.of(&Cost::wall)), bare.of(&Cost::waits),
      loaded.of(&Cost::waits), bare.of(&Cost::preemptions), loaded.of(&Cost::preemptions));
  if (spins) return fmt::print("}}\n"), 0;
  const double megabytes = static_cast<double>(fs::file_size(log)) / 1e6;
  const Verified verified = verify(log);
  fs::remove(log);
  fmt::print(", \"megabytes\": {:.1f}, \"verify_over_bare\": {:.3f}, \"differing\": {}}}\n",
             megabytes, bare.of(&Cost::wall) / verified.seconds, verified.found.differing);
  return verified.found.is_equal() ? 0 : 1;
}
