#include "runtime/live_sensors.h"

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "runtime/shared_renderer.h"

namespace gloam {
namespace {

Result<SensorDescription> find_sensor(const std::vector<SensorDescription>& sensors,
                                      const std::string& name) {
  std::vector<std::string> names;
  for (const SensorDescription& sensor : sensors) {
    if (sensor.name == name) return sensor;
    names.push_back(sensor.name);
  }
  return Error{ErrorKind::kInput,
               fmt::format("there is no sensor '{}'", name),
               {},
               suggest_name(name, names)};
}

}  // namespace

Result<std::unique_ptr<LiveSensors>> LiveSensors::open(Simulator& simulator,
                                                       const std::vector<std::string>& sensors,
                                                       bool required, uint64_t seed,
                                                       SensorCallback on_message) {
  std::unique_ptr<LiveSensors> live(new LiveSensors(sensors, seed, std::move(on_message)));
  live->world_ = simulator.world();
  GLOAM_TRY(live->group_, live->group_of(*live->world_, simulator.timestep()));
  SubscriptionOptions options;
  options.due = live->group_.due();
  options.required = required;
  options.capacity = 64;
  GLOAM_TRY(live->queue_, simulator.subscribe(options));
  live->thread_ =
      std::thread([raw = live.get(), timestep = simulator.timestep()] { raw->run(timestep); });
  return live;
}

LiveSensors::~LiveSensors() {
  if (queue_ != nullptr) queue_->close();
  drain();
}

void LiveSensors::drain() {
  if (thread_.joinable()) thread_.join();
}

Status LiveSensors::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

Result<SensorGroup> LiveSensors::group_of(const CompiledWorld& world, Rational timestep) const {
  const std::vector<SensorDescription> all = describe_sensors(world);
  std::vector<SensorDescription> wanted;
  for (const std::string& name : names_) {
    GLOAM_TRY(SensorDescription sensor, find_sensor(all, name));
    wanted.push_back(std::move(sensor));
  }
  return SensorGroup::make(wanted, timestep, seed_);
}

void LiveSensors::run(Rational timestep) {
  while (const Snapshot snapshot = queue_->next()) {
    const auto& world = snapshot.data().world;
    if (world != world_) {
      Result<SensorGroup> next = group_of(*world, timestep);
      if (next.ok() && !next->same_steps(group_)) next = other_schedule("a sensor");
      if (!next.ok()) {
        const std::lock_guard lock(mutex_);
        log_error("a stream of sensors stopped: {}", next.error().to_string());
        status_ = next.error();
        queue_->close();  // the simulation must not wait for it
        return;
      }
      group_ = std::move(*next);
      world_ = world;
    }
    group_.sample(snapshot, on_message_);
  }
}

}  // namespace gloam
