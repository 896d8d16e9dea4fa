#include "runtime/live_sensors.h"

#include <fmt/format.h>

#include "base/text.h"

namespace gloam {

Result<std::unique_ptr<LiveSensors>> LiveSensors::open(
    Simulator& simulator, const std::vector<SensorDescription>& sensors, bool required,
    uint64_t seed, SensorCallback on_message) {
  GLOAM_TRY(SensorGroup group, SensorGroup::make(sensors, simulator.timestep(), seed));
  SubscriptionOptions options;
  options.due = group.due();
  options.required = required;
  options.capacity = 64;
  std::unique_ptr<LiveSensors> live(new LiveSensors(std::move(group), std::move(on_message)));
  GLOAM_TRY(live->queue_, simulator.subscribe(options));
  live->thread_ = std::thread([raw = live.get()] {
    while (const Snapshot snapshot = raw->queue_->next())
      raw->group_.sample(snapshot, raw->on_message_);
  });
  return live;
}

LiveSensors::~LiveSensors() {
  if (queue_ != nullptr) queue_->close();
  drain();
}

void LiveSensors::drain() {
  if (thread_.joinable()) thread_.join();
}

Result<SensorDescription> find_sensor(const CompiledWorld& world, const std::string& name) {
  std::vector<std::string> names;
  for (const SensorDescription& sensor : describe_sensors(world)) {
    if (sensor.name == name) return sensor;
    names.push_back(sensor.name);
  }
  return Error{ErrorKind::kInput,
               fmt::format("there is no sensor '{}'", name),
               {},
               suggest_name(name, names)};
}

}  // namespace gloam
