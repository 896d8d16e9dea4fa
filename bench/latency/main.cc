// Latency of bridges, published; kHelp tells the arguments.
//
// One simulation in real time: a plain arm at 1 kHz with a camera for each size of picture, or a
// scene; a client in another process for each bridge, one after the other. A step hook notes when
// each physics step began, which is when its instant came to be but for some ten microseconds. One
// line of JSON for each client and topic: p50 and p99 [ms], jitter (standard deviation [ms]),
// messages, and instants of which none came. "inside" is the same topic opened in the simulation's
// own process. Of the others "bridge_p50_ms", "bridge_p99_ms" leave out what passed until the
// message left the simulation: physics, rendering, encoding.

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "bench/command_line.h"
#include "bench/latency/latency.h"
#include "bench/latency/timed_simulation.h"
#include "gloam/bridge.h"
#include "gloam/simulation.h"

namespace gloam::latency {
namespace {

using nlohmann::ordered_json;

constexpr const char* kModel = R"(<mujoco model="arm">
  <option timestep="0.001"/>
  <worldbody>
    <light pos="0 0 4" dir="0 0 -1"/>
    <geom name="floor" type="plane" size="5 5 0.1" rgba="0.5 0.6 0.5 1"/>
    <body name="arm" pos="0 0 1">
      <joint name="a" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03"/>
      <body name="hand" pos="0.4 0 0">
        <joint name="b" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/>
      </body>
    </body>
    <camera name="c64" pos="0 -2 1" xyaxes="1 0 0 0 0 1" resolution="64 64"/>
    <camera name="c320" pos="0 -2 1" xyaxes="1 0 0 0 0 1" resolution="320 240"/>
    <camera name="c640" pos="0 -2 1" xyaxes="1 0 0 0 0 1" resolution="640 480"/>
    <camera name="c1280" pos="0 -2 1" xyaxes="1 0 0 0 0 1" resolution="1280 720"/>
  </worldbody>
  <actuator><motor name="a" joint="a"/></actuator>
</mujoco>)";

constexpr const char* kHelp = R"(bench_latency [SCENE] [--seconds N] [--only CLIENT[,CLIENT]]

How long a message takes from the moment at which its instant exists to a reader, as one line of JSON
for each client and topic, in milliseconds.

  SCENE         joint states at 100 Hz and pictures of the first camera at 5 Hz of this scene;
                without it a plain arm at 1 kHz, pictures of 64x64 to 1280x720
  --seconds N   of each measurement; default 5
  --only LIST   of inside, ros2, zmq, zmq shm, rclpy, foxglove; default all

Examples: bench_latency --only inside,zmq
          bench_latency examples/house.toml --seconds 3 --only "ros2,zmq shm"
)";
const std::vector<Subject> kArm = {
    {"state 1 kHz", "/arm/joint_states", 1000},
    {"raw 64x64", "/c64/image_raw", 10},
    {"raw 320x240", "/c320/image_raw", 10},
    {"raw 640x480", "/c640/image_raw", 5},
    {"JPEG 640x480", "/c640/image_raw/compressed", 5},
    {"raw 1280x720", "/c1280/image_raw", 3},
    {"JPEG 1280x720", "/c1280/image_raw/compressed", 3},
};
constexpr int kPatience = 10'000;  // for a message [ms]
// Bridges keep a stream open for a while after its last reader.
constexpr auto kLinger = std::chrono::milliseconds(2500);
constexpr double kWarmUp = 1500;  // of each measurement [ms]

constexpr Client kClients[] = {
    {"ros2", [](BridgeOptions* o) { o->ros2.emplace(); }, run_ros2_client},
    {"zmq", [](BridgeOptions* o) { o->zmq = ZmqOptions{.port = 0}; }, run_zmq_client},
    {"zmq shm", [](BridgeOptions* o) { o->zmq = ZmqOptions{.port = 0}; }, run_shm_client},
    {"rclpy", [](BridgeOptions* o) { o->ros2.emplace(); }, run_rclpy_client},
    {"foxglove", [](BridgeOptions* o) { o->foxglove.emplace().port = 0; }, run_foxglove_client},
};

/// Milliseconds at which the instants of a run came to be, by step.
struct StepTimes {
  std::vector<std::atomic<double>> began;
  std::vector<std::atomic<double>> left;  ///< when their message left the simulation
  const double step;                      ///< [s]
  StepTimes(size_t steps, double seconds) : began(steps), left(steps), step(seconds) {}
  size_t index(uint64_t instant) const {
    const auto steps =
        static_cast<size_t>(std::llround(1e-9 * static_cast<double>(instant) / step));
    return steps >= 1 && steps <= began.size() ? steps - 1 : 0;
  }
};

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Messages of one topic at one reader.
struct Series {
  std::vector<double> latencies;  // [ms]
  std::vector<double> shares;     // of the bridge [ms]; empty inside
  uint64_t first = 0, last = 0, bytes = 0;

  void add(const Arrival& arrival, const StepTimes& times) {
    const size_t index = times.index(arrival.instant);
    const double born = times.began[index], left = times.left[index];
    if (born <= 0) return;
    if (first == 0) first = arrival.instant;
    last = arrival.instant;
    bytes = arrival.bytes;
    latencies.push_back(arrival.at - born);
    if (left > 0) shares.push_back(arrival.at - left);
  }

  ordered_json report(const char* client, const Subject& subject) const {
    ordered_json line = {{"client", client}, {"stream", subject.name}};
    if (latencies.empty()) {
      line["messages"] = 0;
      return line;
    }
    double mean = 0, variance = 0;
    const auto count = static_cast<double>(latencies.size());
    for (const double x : latencies) mean += x / count;
    for (const double x : latencies) variance += (x - mean) * (x - mean) / count;
    const double expected = std::round(1e-9 * static_cast<double>(last - first) * subject.rate) + 1;
    line.update({{"p50_ms", quantile(latencies, 0.5)},
                 {"p99_ms", quantile(latencies, 0.99)},
                 {"jitter_ms", std::sqrt(variance)},
                 {"bytes", bytes},
                 {"messages", latencies.size()},
                 {"dropped", std::max(0.0, expected - count)}});
    if (shares.empty()) return line;
    line["bridge_p50_ms"] = quantile(shares, 0.5);
    line["bridge_p99_ms"] = quantile(shares, 0.99);
    return line;
  }
};

class Run {
 public:
  Run(Simulation& simulation, const StepTimes& times, int seconds)
      : simulation_(simulation), times_(times), seconds_(seconds) {}

  ordered_json inside(const Subject& subject) {
    std::mutex mutex;
    Series series;
    const double start = now_ms() + kWarmUp;
    auto stream = simulation_.open_topics({.topics = {subject.topic}}, [&](const TopicMessage& m) {
      const double at = now_ms();
      if (at < start) return;
      const std::lock_guard lock(mutex);
      series.add({static_cast<uint64_t>(std::llround(m.time * 1e9)), at, m.data.size()}, times_);
    });
    if (!stream.ok()) return {{"error", stream.error().to_string()}};
    std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(kWarmUp)) +
                                std::chrono::seconds(seconds_));
    stream->reset();
    return series.report("inside", subject);
  }

  ordered_json outside(const Client& client, const std::string& address, const Subject& subject) {
    int ends[2];
    if (pipe(ends) != 0) return {{"error", "no pipe"}};
    const std::string out = std::to_string(ends[1]);
    const pid_t process = fork();
    if (process == 0) {
      execl("/proc/self/exe", "latency", "--client", client.name, address.c_str(),
            subject.topic.c_str(), out.c_str(), nullptr);
      _exit(127);
    }
    close(ends[1]);
    Series series;
    Arrival arrival;
    double start = 0;
    pollfd waiting{ends[0], POLLIN, 0};
    while (poll(&waiting, 1, kPatience) > 0 &&
           read(ends[0], &arrival, sizeof arrival) == sizeof arrival) {
      if (start == 0) start = arrival.at + kWarmUp;
      if (arrival.at > start + 1e3 * seconds_) break;
      if (arrival.at >= start) series.add(arrival, times_);
    }
    close(ends[0]);
    kill(process, SIGTERM);
    for (int i = 0; i < 100 && waitpid(process, nullptr, WNOHANG) == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (kill(process, SIGKILL) == 0) waitpid(process, nullptr, 0);
    std::this_thread::sleep_for(kLinger);
    return series.report(client.name, subject);
  }

 private:
  Simulation& simulation_;
  const StepTimes& times_;
  const int seconds_;
};

/// A world and what is read of it.
struct Measured {
  World world;
  std::vector<Subject> subjects;
};

Result<Measured> compiled(Scene scene, std::vector<Subject> subjects) {
  scene.render.tier = RenderTier::kDirect;
  scene.render.spp = 1;
  scene.render.denoise = false;
  for (const Subject& subject : subjects) {
    TopicOptions topic;
    topic.name = subject.topic;
    topic.rate = Rational{subject.rate, 1};
    scene.topics.push_back(topic);
  }
  GLOAM_TRY(World world, World::compile(scene));
  return Measured{std::move(world), std::move(subjects)};
}

Result<Measured> measured_arm() {
  const auto folder =
      std::filesystem::temp_directory_path() / ("gloam_latency_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const auto file = folder / "arm.xml";
  std::ofstream(file) << kModel;
  auto scene = load_scene(file);
  if (!scene.ok()) return scene.error();
  auto measured = compiled(std::move(*scene), kArm);
  std::filesystem::remove_all(folder);
  return measured;
}

Result<Measured> measured_scene(const std::string& file) {
  GLOAM_TRY(Scene scene, load_scene(file));
  GLOAM_TRY(const World world, World::compile(scene));
  GLOAM_TRY(const auto topics, list_topics(world));
  std::vector<Subject> subjects;
  const auto add = [&](const std::string& name, const std::string& type, int rate) {
    const auto found = std::ranges::find_if(
        topics, [&](const TopicInfo& t) { return t.type == type && !t.is_input; });
    if (found != topics.end()) subjects.push_back({name + " " + found->name, found->name, rate});
  };
  add("state", "sensor_msgs/msg/JointState", 100);
  add("raw", "sensor_msgs/msg/Image", 5);
  add("JPEG", "sensor_msgs/msg/CompressedImage", 5);
  if (subjects.empty())
    return Error{ErrorKind::kInput, file + ": the scene has neither joints nor cameras to read"};
  return compiled(std::move(scene), std::move(subjects));
}

bool is_chosen(const std::string& only, const std::string& name) {
  return only.empty() || ("," + only + ",").find("," + name + ",") != std::string::npos;
}

void print(const ordered_json& line) {
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

Status measure(const std::string& file, int seconds, const std::string& only) {
  GLOAM_TRY(const Measured measured, file.empty() ? measured_arm() : measured_scene(file));
  const auto& [world, subjects] = measured;
  // An hour; it outlives the simulation, whose hook writes it.
  StepTimes times(3'600'000, world.info().timestep);
  size_t step = 0;
  GLOAM_TRY(const auto simulation, Simulation::create(world, {.pace = Pace::kRealTime}));
  GLOAM_TRY_STATUS(simulation->set_step_hook([&](const mjModel_*, mjData_*) {
    if (step < times.began.size()) times.began[step++] = now_ms();
  }));
  simulation->resume();
  Run run(*simulation, times, seconds);
  TimedSimulation timed(*simulation, [&](const TopicMessage& message) {
    times.left[times.index(static_cast<uint64_t>(std::llround(message.time * 1e9)))] = now_ms();
  });
  if (is_chosen(only, "inside"))
    for (const Subject& subject : subjects) print(run.inside(subject));
  signal(SIGPIPE, SIG_IGN);
  for (const Client& client : kClients) {
    if (!is_chosen(only, client.name)) continue;
    BridgeOptions options;
    client.choose(&options);
    GLOAM_TRY(const auto bridges, Bridges::start(timed, options));
    for (const Subject& subject : subjects)
      print(run.outside(client, bridges->list().front()->address(), subject));
  }
  return {};
}

}  // namespace

std::span<const Client> clients() { return kClients; }

double now_ms() {
  timespec t = {};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

bool tell(int out, const Arrival& arrival) {
  return write(out, &arrival, sizeof arrival) == sizeof arrival;
}

}  // namespace gloam::latency

int main(int argc, char** argv) {
  if (argc == 6 && std::strcmp(argv[1], "--client") == 0) {
    for (const auto& client : gloam::latency::clients())
      if (std::strcmp(client.name, argv[2]) == 0)
        return client.run(argv[3], argv[4], std::atoi(argv[5]));
    return 2;
  }
  gloam::CommandLine line(argc, argv);
  if (line.flag("--help")) {
    std::fputs(gloam::latency::kHelp, stdout);
    return 0;
  }
  int seconds = 5;
  std::string only;
  line.value("--seconds", &seconds);
  line.value("--only", &only);
  const std::string file = line.words().empty() ? "" : line.words().front();
  return gloam::exit_code(gloam::latency::measure(file, seconds, only));
}
