// Topics of diagnostics. /diagnostics is a function of the instant alone, so that equal runs have
// equal messages; values that depend on the wall clock are in /diagnostics/performance, which no
// log has that does not ask for it.

#include <fmt/format.h>

#include "ros/messages/diagnostic_msgs.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/world.h"

namespace gloam {
namespace {

using diagnostic_msgs::DiagnosticArray;
using diagnostic_msgs::DiagnosticStatus;

constexpr Rational kDiagnosticRate = {1, 1};  // [Hz]
// Slower than this fraction of the wall clock is worth a warning.
constexpr double kLeastRealtime = 0.95;
// A sensor with a smaller share of its rate is worth one, too.
constexpr double kLeastRate = 0.9;
// By mjtWarning.
constexpr const char* kWarningNames[] = {"inertia",      "contacts_full", "constraints_full",
                                         "bad_position", "bad_velocity",  "bad_acceleration",
                                         "bad_control"};

std::string warning_name(size_t type) {
  return type < std::size(kWarningNames) ? kWarningNames[type] : fmt::format("warning_{}", type);
}

DiagnosticStatus status_of(const char* name, std::string trouble) {
  DiagnosticStatus status;
  status.name = name;
  status.hardware_id = "gloam";
  status.level = trouble.empty() ? DiagnosticStatus::OK : DiagnosticStatus::WARN;
  status.message = trouble.empty() ? "OK" : std::move(trouble);
  return status;
}

Status encode_physics(const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
  const SnapshotData& now = at.snapshot().data();
  std::string trouble;
  std::vector<diagnostic_msgs::KeyValue> values = {{"run", fmt::format("{}", now.run)},
                                                   {"step", fmt::format("{}", now.step)},
                                                   {"timestep", fmt::format("{}", now.timestep)}};
  for (size_t type = 0; type < now.warnings.size(); ++type) {
    values.push_back({warning_name(type), fmt::format("{}", now.warnings[type])});
    if (now.warnings[type] > 0)
      trouble += (trouble.empty() ? "MuJoCo's warnings: " : ", ") + warning_name(type);
  }
  DiagnosticArray message;
  message.header = ros_header(at.snapshot().time(), topic.frame_id);
  message.status = {status_of("gloam: physics", std::move(trouble))};
  message.status[0].values = std::move(values);
  encode(message, out);
  return {};
}

DiagnosticStatus sensor_status(const SensorCost& sensor) {
  std::string trouble;
  if (sensor.achieved > 0 && sensor.achieved < kLeastRate * sensor.rate)
    trouble = fmt::format("{:.3g} of {:.3g} Hz", sensor.achieved, sensor.rate);
  DiagnosticStatus status = status_of(("gloam: " + sensor.name).c_str(), std::move(trouble));
  status.values = {{"rate_hz", fmt::format("{:.4g}", sensor.rate)},
                   {"achieved_hz", fmt::format("{:.4g}", sensor.achieved)},
                   {"messages", fmt::format("{}", sensor.messages)},
                   {"dropped", fmt::format("{}", sensor.dropped)},
                   {"wall_ms", fmt::format("{:.4g}", sensor.wall_ms)},
                   {"waited_ms", fmt::format("{:.4g}", sensor.waited_ms)}};
  return status;
}

Status encode_performance(const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
  const SimulationStats stats = at.performance();
  std::string trouble;
  if (stats.realtime_factor > 0 && stats.realtime_factor < kLeastRealtime)
    trouble = fmt::format("runs at {:.2f} times real time", stats.realtime_factor);
  DiagnosticArray message;
  message.header = ros_header(at.snapshot().time(), topic.frame_id);
  message.status = {
      status_of("gloam: speed", std::move(trouble)),
      status_of("gloam: streams", stats.dropped_snapshots > 0
                                      ? "subscribers are too slow: instants were dropped"
                                      : "")};
  message.status[0].values = {{"pace", to_string(stats.pace)},
                              {"realtime_factor", fmt::format("{:.4g}", stats.realtime_factor)},
                              {"step", fmt::format("{}", stats.step)}};
  message.status[1].values = {{"dropped_snapshots", fmt::format("{}", stats.dropped_snapshots)},
                              {"commands_applied", fmt::format("{}", stats.commands_applied)}};
  for (const SensorCost& sensor : stats.sensors) message.status.push_back(sensor_status(sensor));
  encode(message, out);
  return {};
}

}  // namespace

void add_diagnostic_topics(const TopicWorld&, TopicTable* table) {
  const auto add = [table](const char* name, const char* source, InstantEncoder encode) {
    table->push_back({{.name = name,
                       .type = type_name<DiagnosticArray>(),
                       .rate = kDiagnosticRate,
                       .source = {.name = source}},
                      {},
                      {},
                      std::move(encode)});
  };
  add("/diagnostics", "physics", encode_physics);
  add("/diagnostics/performance", "speed in wall time, lost messages, cost of each sensor",
      encode_performance);
  table->back().info.is_logged = false;
}

}  // namespace gloam
