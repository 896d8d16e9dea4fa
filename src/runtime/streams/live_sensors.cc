#include "runtime/streams/live_sensors.h"

#include <fmt/format.h>

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
                                                       SensorCallback on_message,
                                                       EndCallback on_end) {
  std::unique_ptr<LiveSensors> live(new LiveSensors(sensors, seed, std::move(on_message)));
  live->world_ = simulator.world();
  GLOAM_TRY(live->group_, live->group_of(*live->world_, simulator.timestep()));
  SubscriptionOptions options;
  options.due = live->group_.due();
  options.required = required;
  options.capacity = 64;
  GLOAM_TRY(auto queue, simulator.subscribe(options));
  live->thread_.start(
      std::move(queue),
      {.what = "a stream of sensors",
       .take = [raw = live.get(), timestep = simulator.timestep()](
                   const SnapshotWindow& now) { return raw->sample(now.keys[0], timestep); },
       .on_end = std::move(on_end)});
  return live;
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

Status LiveSensors::sample(const Snapshot& snapshot, Rational timestep) {
  const auto& world = snapshot.data().world;
  if (world != world_) {
    GLOAM_TRY(SensorGroup next, group_of(*world, timestep));
    if (!next.same_steps(group_)) return other_schedule("a sensor");
    group_ = std::move(next);
    world_ = world;
  }
  group_.sample(snapshot, on_message_);
  return {};
}

}  // namespace gloam
