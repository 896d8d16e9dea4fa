// Latency of the bridge to Foxglove: from the moment at which an instant exists to its message in
// another process, over loopback.
//   foxglove_latency [--seconds N]
// The clock is the machine's; a step hook notes when each physics step began, whose end is the
// instant that messages are of. One line of JSON for each stream: state (joint states at 1 kHz) and
// a JPEG picture (640x480, tier direct, 20 Hz). Beside the client in another process the same
// topic is opened in this one: what the bridge adds is the difference. Jitter is the standard
// deviation; dropped are instants of which no message came.

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "bench/command_line.h"
#include "gloam/bridge.h"
#include "gloam/simulation.h"

using namespace gloam;

namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
using nlohmann::json;

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
    <camera name="eye" pos="0 -2 1" xyaxes="1 0 0 0 0 1" resolution="640 480"/>
  </worldbody>
  <actuator><motor name="a" joint="a"/></actuator>
</mujoco>)";

constexpr const char* kToken = "foxglove-latency-bench";
constexpr double kStep = 0.001;  // [s]

struct Subject {
  const char* name;
  const char* topic;
  double rate;  // [Hz]
};
constexpr Subject kSubjects[] = {
    {"state", "/arm/joint_states", 1000},
    {"picture_640x480_jpeg", "/eye/image_raw/compressed", 20},
};

double now_ms() {
  timespec t = {};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// An arrival: which instant [ns], when [ms], how large.
struct Arrival {
  uint64_t instant = 0;
  double at = 0;
  uint64_t bytes = 0;
};

/// The client's process: writes arrivals until the server ends.
int run_client(int port, const std::string& topic, int out) {
  net::io_context context;
  beast::websocket::stream<net::ip::tcp::socket> socket(context);
  socket.next_layer().connect(
      {net::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
  socket.next_layer().set_option(net::ip::tcp::no_delay(true));
  socket.set_option(
      beast::websocket::stream_base::decorator([](beast::websocket::request_type& request) {
        request.set(beast::http::field::sec_websocket_protocol, "foxglove.sdk.v1");
      }));
  socket.read_message_max(0);
  socket.handshake("127.0.0.1", "/");
  beast::flat_buffer buffer;
  boost::system::error_code error;
  while (socket.read(buffer, error), !error) {
    const auto* data = static_cast<const char*>(buffer.data().data());
    if (socket.got_text()) {
      const json message = json::parse(data, data + buffer.size());
      for (const json& channel : message.value("channels", json::array()))
        if (channel["topic"] == topic)
          socket.write(
              net::buffer(json({{"op", "subscribe"},
                                {"subscriptions", {{{"id", 1}, {"channelId", channel["id"]}}}}})
                              .dump()));
    } else if (data[0] == 1) {
      Arrival arrival{0, now_ms(), buffer.size() - 13};
      std::memcpy(&arrival.instant, data + 5, sizeof arrival.instant);
      if (write(out, &arrival, sizeof arrival) != sizeof arrival) break;
    }
    buffer.clear();
  }
  return 0;
}

/// Milliseconds at which the instants of a run came to be, by step.
struct StepTimes {
  std::vector<std::atomic<double>> began;
  explicit StepTimes(size_t steps) : began(steps) {}
  /// The step that leads to an instant takes some ten microseconds, which count.
  double of(uint64_t instant) const {
    const auto step =
        static_cast<size_t>(std::llround(1e-9 * static_cast<double>(instant) / kStep));
    return step >= 1 && step <= began.size() ? began[step - 1].load() : 0;
  }
};

json summary(std::vector<double> latencies) {
  if (latencies.empty()) return nullptr;
  std::sort(latencies.begin(), latencies.end());
  const auto at = [&](double share) {
    return latencies[static_cast<size_t>(share * static_cast<double>(latencies.size() - 1))];
  };
  double mean = 0, variance = 0;
  for (const double x : latencies) mean += x / static_cast<double>(latencies.size());
  for (const double x : latencies)
    variance += (x - mean) * (x - mean) / static_cast<double>(latencies.size());
  return {{"p50_ms", at(0.5)}, {"p99_ms", at(0.99)}, {"jitter_ms", std::sqrt(variance)}};
}

json measure(Simulation& simulation, Bridges& bridges, const Subject& subject, int seconds,
             const StepTimes& times) {
  const std::string address = bridges.list().front()->address();
  const int port = std::atoi(address.c_str() + address.find(':', 5) + 1);
  int ends[2];
  if (pipe(ends) != 0) std::exit(1);
  // Nothing runs between fork and exec but this program itself again.
  const pid_t client = fork();
  if (client == 0) {
    const std::string number = std::to_string(port), out = std::to_string(ends[1]);
    execl("/proc/self/exe", "foxglove_latency", "--client", number.c_str(), subject.topic,
          out.c_str(), nullptr);
    _exit(127);
  }
  close(ends[1]);
  std::mutex mutex;
  std::vector<double> inside;
  auto stream = simulation.open_topics({.topics = {subject.topic}}, [&](const TopicMessage& m) {
    const double at = now_ms();
    const double born = times.of(static_cast<uint64_t>(std::llround(m.time * 1e9)));
    const std::lock_guard lock(mutex);
    if (born > 0) inside.push_back(at - born);
  });
  if (!stream.ok()) std::exit(1);
  std::vector<double> outside;
  uint64_t first = 0, last = 0, bytes = 0;
  Arrival arrival;
  double start = 0;
  // The first second warms everything up.
  while (read(ends[0], &arrival, sizeof arrival) == sizeof arrival) {
    if (start == 0) start = arrival.at + 1000;
    if (arrival.at < start) continue;
    if (arrival.at > start + 1e3 * seconds) break;
    if (first == 0) first = arrival.instant;
    last = arrival.instant;
    bytes = arrival.bytes;
    if (const double born = times.of(arrival.instant); born > 0)
      outside.push_back(arrival.at - born);
  }
  stream->reset();
  kill(client, SIGTERM);
  waitpid(client, nullptr, 0);
  close(ends[0]);
  const double expected = std::round(1e-9 * static_cast<double>(last - first) * subject.rate) + 1;
  json line = {{"bridge", "foxglove"},
               {"stream", subject.name},
               {"rate_hz", subject.rate},
               {"bytes", bytes},
               {"messages", outside.size()},
               {"dropped", std::max(0.0, expected - static_cast<double>(outside.size()))}};
  line.update(summary(outside));
  line["in_process"] = summary(inside);
  return line;
}

int fail(const Error& error) {
  std::fprintf(stderr, "foxglove_latency: %s\n", error.to_string().c_str());
  return error.exit_code();
}

int run_bench(int seconds) {
  const auto file = std::filesystem::temp_directory_path() / "gloam_foxglove_latency.xml";
  std::ofstream(file) << kModel;
  auto scene = load_scene(file);
  if (!scene.ok()) return fail(scene.error());
  scene->render.tier = "direct";
  TopicOptions fast;
  fast.name = "/arm/joint_states";
  fast.rate = Rational{1000, 1};
  scene->topics.push_back(fast);
  const auto world = World::compile(*scene);
  if (!world.ok()) return fail(world.error());
  auto simulation = Simulation::create(*world, {.pace = Pace::kRealTime});
  if (!simulation.ok()) return fail(simulation.error());
  StepTimes times(static_cast<size_t>(1000 * (4 * seconds + 60)));
  size_t step = 0;
  const Status hooked = (*simulation)->set_step_hook([&](const mjModel_*, mjData_*) {
    if (step < times.began.size()) times.began[step++] = now_ms();
  });
  if (!hooked.ok()) return fail(hooked.error());
  setenv("GLOAM_TOKEN", kToken, 1);
  BridgeOptions options;
  options.foxglove.emplace().port = 0;
  const auto bridges = Bridges::start(**simulation, options);
  if (!bridges.ok()) return fail(bridges.error());
  (*simulation)->resume();
  for (const Subject& subject : kSubjects)
    std::printf("%s\n", measure(**simulation, **bridges, subject, seconds, times).dump().c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 5 && std::strcmp(argv[1], "--client") == 0) {
    try {
      return run_client(std::atoi(argv[2]), argv[3], std::atoi(argv[4]));
    } catch (const std::exception& error) {
      std::fprintf(stderr, "foxglove_latency: client: %s\n", error.what());
      return 1;
    }
  }
  CommandLine line(argc, argv);
  int seconds = 10;
  line.value("--seconds", &seconds);
  return run_bench(seconds);
}
