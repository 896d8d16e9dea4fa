// Topics of sensors: samples of one step from all sensors of a topic make a message.

#include <algorithm>
#include <utility>

#include "runtime/live/live_simulation.h"
#include "runtime/live/topic_feed.h"
#include "runtime/streams/due_steps.h"
#include "world/sensors/sensor_description.h"

namespace gloam {
namespace {

constexpr size_t kMaxIncompleteSteps = 1024;  // steps of which samples are not complete
constexpr const char* kAllSamples = "all samples";
constexpr const char* kUsedSamples = "used samples";

}  // namespace

// Two streams for all sensors: errors of a sensor's model hang on its samples before, so that it
// takes every one of them; of others only those that a topic has at its rate are looked at.
Status TopicFeed::set_sensors(const std::vector<TopicPointer>& topics) {
  const auto is_same = [](const auto& gathering, const TopicPointer& topic) {
    return gathering->outlet.topic->info.name == topic->info.name;
  };
  if (has_sensors_ && std::ranges::equal(gatherings_, topics, is_same)) return {};
  has_sensors_ = false;
  for (const char* const name : {kAllSamples, kUsedSamples}) streams_.close(name);
  gatherings_.clear();
  std::vector<Gathering*> modelled, plain;
  const std::vector<SensorDescription> sensors = describe_sensors(*simulation_.world().compiled());
  const auto has_model = [&sensors](const std::string& name) {
    const auto found = std::ranges::find(sensors, name, &SensorDescription::name);
    return found != sensors.end() && found->options != nullptr;
  };
  for (const TopicPointer& topic : topics) {
    gatherings_.push_back(std::make_unique<Gathering>());
    gatherings_.back()->outlet = make_outlet(topic);
    const bool any = std::ranges::any_of(topic->streams, has_model);
    (any ? modelled : plain).push_back(gatherings_.back().get());
  }
  GLOAM_TRY_STATUS(open_sensor_stream(std::move(modelled), SampleSteps::kAll));
  GLOAM_TRY_STATUS(open_sensor_stream(std::move(plain), SampleSteps::kUsed));
  has_sensors_ = true;
  return {};
}

Status TopicFeed::open_sensor_stream(std::vector<Gathering*> gatherings, SampleSteps steps) {
  if (gatherings.empty()) return {};
  LiveSensorsRequest request{
      .required = request_.required, .batch = batch_, .on_end = request_.on_end};
  request.on_lost = [this](const Error& why) {
    note("sensor topics", why);
    if (request_.on_end) request_.on_end(why);
  };
  std::map<std::string, SampleSlot> slots;
  std::vector<StepSchedule> schedules;
  for (Gathering* gathering : gatherings) {
    schedules.push_back(gathering->outlet.schedule);
    const std::vector<std::string>& parts = gathering->outlet.topic->streams;
    for (size_t part = 0; part < parts.size(); ++part) {
      request.sensors.push_back(parts[part]);
      slots[parts[part]] = {gathering, part};
    }
  }
  if (steps == SampleSteps::kUsed) request.used = first_of(schedules);
  GLOAM_TRY(auto stream,
            simulation_.open_live_sensors(
                std::move(request), [this, slots = std::move(slots)](const SensorMessage& message) {
                  const SampleSlot& slot = slots.at(message.sensor);
                  take_sample(slot.gathering, slot.part, message);
                }));
  streams_.add(steps == SampleSteps::kAll ? kAllSamples : kUsedSamples, std::move(stream));
  return {};
}

void TopicFeed::take_sample(Gathering* gathering, size_t part, const SensorMessage& message) {
  Outlet& outlet = gathering->outlet;
  const StepSchedule& schedule = outlet.schedule;
  if (schedule.step_of(schedule.first_at_or_after(message.step)) != message.step) return;
  const std::lock_guard lock(sensors_mutex_);
  auto& waiting = gathering->by_step;
  // Time has begun anew, or a sensor drops its samples: what cannot be completed goes.
  if (!waiting.empty() && message.step < waiting.begin()->first && part == 0) waiting.clear();
  if (waiting.size() > kMaxIncompleteSteps) waiting.erase(waiting.begin());
  Gathering::Samples& samples = waiting[message.step];
  samples.messages.resize(outlet.topic->streams.size());
  samples.messages[part] = message;
  if (++samples.count < samples.messages.size()) return;
  const TopicInfo& info = outlet.topic->info;
  const auto& encode = std::get<SampleEncoder>(outlet.topic->code);
  send(&outlet, encode(info, samples.messages, &outlet.bytes),
       {info, -1, message.step, message.time, message.delivery, {}});
  waiting.erase(message.step);
}

}  // namespace gloam
