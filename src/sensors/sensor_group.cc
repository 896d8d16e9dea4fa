#include "sensors/sensor_group.h"

#include <algorithm>
#include <limits>

#include "world/world.h"

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
    const Rational rate = sensor.rate.num > 0 ? sensor.rate : every_step;
    const TimingOptions timing =
        options != nullptr ? options->timing.value_or(TimingOptions{}) : TimingOptions{};
    auto made = SensorTiming::make(rate, timing, timestep, seed);
    if (!made.ok()) {
      Error error = made.error();
      error.kind = ErrorKind::kInput;
      error.message = "sensor '" + sensor.name + "': " + error.message;
      if (error.loc.file.empty()) error.loc = sensor.loc;
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

Status SensorGroup::open_probes(const std::shared_ptr<const CompiledWorld>& world,
                                const ProbeSources& sources) {
  for (Member& member : members_) {
    if (member.description.probe < 0) continue;
    if (instant_ == nullptr) instant_ = std::make_unique<ProbeInstant>(world);
    const auto row = static_cast<size_t>(member.description.probe);
    GLOAM_TRY(member.read, make_probe_reader(world->probes[row], {world, sources}));
  }
  return {};
}

namespace {

// The first step at or after `step` at which a sensor has a sample that is used.
int64_t next_sample(const SensorTiming& timing, const std::function<int64_t(int64_t)>& used,
                    int64_t step) {
  constexpr int kMaxTries = 32;
  int64_t next = timing.step_of(timing.first_at_or_after(step));
  for (int i = 0; used && i < kMaxTries; ++i) {
    const int64_t wanted = used(next);
    if (wanted == next) break;
    next = timing.step_of(timing.first_at_or_after(wanted));
  }
  return next;
}

}  // namespace

std::function<int64_t(int64_t step)> SensorGroup::due(
    std::function<int64_t(int64_t step)> used) const {
  struct Part {
    SensorTiming timing;
    int64_t lag;
  };
  std::vector<Part> parts;  // many sensors have the same steps
  for (const Member& member : members_) {
    const auto is_same = [&member](const Part& part) {
      return part.lag == member.lag() && part.timing.same_steps(member.timing);
    };
    if (std::ranges::none_of(parts, is_same)) parts.push_back({member.timing, member.lag()});
  }
  return [parts = std::move(parts), used = std::move(used)](int64_t step) {
    int64_t next = std::numeric_limits<int64_t>::max();
    for (const Part& part : parts) {
      const int64_t from = std::max<int64_t>(0, step - part.lag);
      next = std::min(next, next_sample(part.timing, used, from) + part.lag);
    }
    return next;
  };
}

bool SensorGroup::same_steps(const SensorGroup& other) const {
  return std::equal(members_.begin(), members_.end(), other.members_.begin(), other.members_.end(),
                    [](const Member& a, const Member& b) { return a.timing.same_steps(b.timing); });
}

// Fills values and time of the member's message: of the Snapshot's own state, but MuJoCo's sensors
// of the state before.
Status SensorGroup::read(const Snapshot& snapshot, Member* member) {
  const SnapshotData& data = snapshot.data();
  const auto count = static_cast<size_t>(member->description.count);
  SensorMessage& message = member->message;
  if (member->read) {
    message.time = data.time;
    message.values.resize(count);
    return member->read(*instant_, message.values);
  }
  message.time = data.sensor_stamp;
  const auto first = data.sensordata.begin() + member->description.first;
  message.values.assign(first, first + member->description.count);
  return {};
}

Status SensorGroup::sample(const Snapshot& snapshot, const SensorCallback& deliver) {
  const SnapshotData& data = snapshot.data();
  if (instant_ != nullptr) instant_->follow(snapshot);
  for (Member& member : members_) {
    const int64_t step = data.step - member.lag();
    if (step < 0) continue;
    const int64_t k = member.timing.first_at_or_after(step);
    if (member.timing.step_of(k) != step || member.timing.dropped(k)) continue;
    SensorMessage& message = member.message;
    message.index = k;
    message.step = step;
    GLOAM_TRY_STATUS(read(snapshot, &member));
    // It cannot arrive before the step is done that it comes with.
    message.delivery = std::max(data.time, member.timing.delivery_of(k, message.time));
    if (member.model != nullptr) member.model->apply(k, message.values);
    deliver(message);
  }
  return {};
}

}  // namespace gloam
