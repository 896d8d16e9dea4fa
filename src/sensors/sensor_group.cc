#include "sensors/sensor_group.h"

#include <algorithm>
#include <limits>

namespace gloam {

Result<SensorGroup> SensorGroup::make(const std::vector<SensorDescription>& sensors,
                                      Rational timestep, uint64_t simulation_seed) {
  SensorGroup group;
  const Rational every_step = {timestep.den, timestep.num};
  for (const SensorDescription& sensor : sensors) {
    Member member;
    member.description = sensor;
    member.message.sensor = sensor.name;
    const SensorOptions* options = sensor.options;
    const uint64_t seed =
        sensor_seed(simulation_seed, sensor.name) ^ (options != nullptr ? options->seed : 0);
    const Rational rate = options != nullptr ? options->rate : every_step;
    const TimingOptions timing =
        options != nullptr ? options->timing.value_or(TimingOptions{}) : TimingOptions{};
    auto made = SensorTiming::make(rate, timing, timestep, seed);
    if (!made.ok()) {
      Error error = made.error();
      error.kind = ErrorKind::kInput;
      error.message = "sensor '" + sensor.name + "': " + error.message;
      if (error.loc.file.empty() && options != nullptr) error.loc = options->loc;
      return error;
    }
    member.timing = std::move(*made);
    if (options != nullptr)
      member.model = std::make_unique<SignalModel>(signal_errors(*options), sensor.kind,
                                                   sensor.count, rate.value(), seed);
    group.members_.push_back(std::move(member));
  }
  return group;
}

std::function<int64_t(int64_t step)> SensorGroup::due() const {
  std::vector<SensorTiming> timings;
  for (const Member& member : members_) timings.push_back(member.timing);
  return [timings = std::move(timings)](int64_t step) {
    int64_t next = std::numeric_limits<int64_t>::max();
    for (const SensorTiming& timing : timings)
      next = std::min(next, timing.step_of(timing.first_at_or_after(step)));
    return next;
  };
}

bool SensorGroup::same_steps(const SensorGroup& other) const {
  return std::equal(members_.begin(), members_.end(), other.members_.begin(), other.members_.end(),
                    [](const Member& a, const Member& b) { return a.timing.same_steps(b.timing); });
}

void SensorGroup::sample(const Snapshot& snapshot, const SensorCallback& deliver) {
  const SnapshotData& data = snapshot.data();
  for (Member& member : members_) {
    const int64_t k = member.timing.first_at_or_after(data.step);
    if (member.timing.step_of(k) != data.step || member.timing.dropped(k)) continue;
    SensorMessage& message = member.message;
    message.index = k;
    message.step = data.step;
    message.time = data.sensor_stamp;
    // It cannot arrive before the step is done that it comes with.
    message.delivery = std::max(data.time, member.timing.delivery_of(k, data.sensor_stamp));
    const auto first = data.sensordata.begin() + member.description.first;
    message.values.assign(first, first + member.description.count);
    if (member.model != nullptr) member.model->apply(k, message.values);
    deliver(message);
  }
}

}  // namespace gloam
