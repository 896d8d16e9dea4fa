#include "runtime/streams/live_sensors.h"

#include <fmt/format.h>

#include "base/text.h"
#include "runtime/rendering/shared_renderer.h"

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

// The name of a stream in reports.
std::string stream_name(const std::vector<std::string>& sensors) {
  if (sensors.size() == 1) return fmt::format("sensor '{}'", sensors.front());
  return fmt::format("{} sensors", sensors.size());
}

}  // namespace

Result<std::unique_ptr<LiveSensors>> LiveSensors::open(const StreamContext& context,
                                                       ProbeSources sources,
                                                       LiveSensorsRequest request,
                                                       SensorCallback on_message) {
  Simulator& simulator = context.simulator;
  std::unique_ptr<LiveSensors> live(
      new LiveSensors(context.seed, std::move(sources), std::move(request), std::move(on_message)));
  const LiveSensorsRequest& wanted = live->request_;
  live->world_ = simulator.world();
  GLOAM_TRY(live->group_, live->group_of(wanted.sensors, *live->world_, simulator.timestep()));
  GLOAM_TRY_STATUS(live->group_.open_probes(live->world_, live->sources_));
  SubscriptionOptions options;
  options.due = live->group_.due(wanted.used);
  options.required = wanted.required;
  options.sensor = true;
  options.capacity = 64;
  options.batch = wanted.batch;
  GLOAM_TRY(auto queue, simulator.subscribe(options));
  live->account_ =
      context.costs.open(stream_name(wanted.sensors), rate_of(options.due, simulator.timestep()));
  live->thread_.start(
      std::move(queue),
      {.what = "a sensor stream",
       .take = [raw = live.get(), timestep = simulator.timestep()](
                   const SnapshotWindow& now) { return raw->sample(now.keys[0], timestep); },
       .on_end = wanted.on_end,
       .account = live->account_});
  return live;
}

Result<SensorGroup> LiveSensors::group_of(const std::vector<std::string>& names,
                                          const CompiledWorld& world, Rational timestep) const {
  const std::vector<SensorDescription> all = describe_sensors(world);
  std::vector<SensorDescription> wanted;
  for (const std::string& name : names) {
    GLOAM_TRY(SensorDescription sensor, find_sensor(all, name));
    wanted.push_back(std::move(sensor));
  }
  return SensorGroup::make(wanted, timestep, seed_);
}

// The sensors of another World that are the same go on.
Status LiveSensors::follow(const WorldPtr& world, Rational timestep) {
  std::vector<std::string> kept;
  Status lost;
  for (const std::string& name : request_.sensors) {
    GLOAM_TRY(const SensorGroup before, group_of({name}, *world_, timestep));
    const Result<SensorGroup> after = group_of({name}, *world, timestep);
    if (after.ok() && after->same_steps(before)) {
      kept.push_back(name);
      continue;
    }
    const Error why = after.ok() ? other_schedule("sensor '" + name + "'") : after.error();
    if (lost.ok()) lost = why;
    if (request_.on_lost) request_.on_lost(why);
  }
  if (!lost.ok() && (kept.empty() || !request_.on_lost)) return lost;
  GLOAM_TRY(group_, group_of(kept, *world, timestep));
  GLOAM_TRY_STATUS(group_.open_probes(world, sources_));
  request_.sensors = std::move(kept);
  world_ = world;
  return {};
}

Status LiveSensors::sample(const Snapshot& snapshot, Rational timestep) {
  if (snapshot.data().world != world_) GLOAM_TRY_STATUS(follow(snapshot.data().world, timestep));
  GLOAM_TRY_STATUS(group_.sample(snapshot, on_message_));
  account_->add_message(snapshot.time());
  return {};
}

}  // namespace gloam
