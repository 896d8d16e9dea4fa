#include "runtime/live/topic_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/log.h"
#include "runtime/live/live_simulation.h"
#include "runtime/streams/due_steps.h"

namespace gloam {
namespace {

// Names of streams; of a camera or LiDAR they come before its own.
constexpr const char* kCamera = "camera ";
constexpr const char* kLidar = "lidar ";
constexpr const char* kInstants = "instants";

}  // namespace

Result<std::unique_ptr<TopicFeed>> TopicFeed::open(LiveSimulation& simulation, TopicTables& tables,
                                                   const TopicRequest& request,
                                                   TopicCallback on_message, int batch) {
  std::unique_ptr<TopicFeed> feed(
      new TopicFeed(simulation, tables, request, std::move(on_message), batch));
  GLOAM_TRY_STATUS(feed->set_topics(request.topics));
  return feed;
}

TopicFeed::~TopicFeed() {
  if (latched_ != nullptr) latched_->close();
}

// Streams of topics that stay go on; a camera gains or loses outputs without being reopened.
Status TopicFeed::set_topics(std::span<const std::string> names) {
  GLOAM_TRY(const auto table, tables_.of(simulation_.world().compiled()));
  GLOAM_TRY(const Wanted wanted, find_wanted(table, names));
  close_unwanted(&cameras_, kCamera, wanted.cameras);
  close_unwanted(&lidars_, kLidar, wanted.lidars);
  GLOAM_TRY_STATUS(set_latched(table, wanted.latched));
  for (const auto& [camera, topics] : wanted.cameras) GLOAM_TRY_STATUS(set_camera(camera, topics));
  for (const auto& [lidar, topics] : wanted.lidars) GLOAM_TRY_STATUS(set_lidar(lidar, topics));
  GLOAM_TRY_STATUS(set_sensors(wanted.sensors));
  return set_instants(wanted.instants);
}

Result<TopicFeed::Wanted> TopicFeed::find_wanted(const std::shared_ptr<const TopicTable>& table,
                                                 std::span<const std::string> names) {
  std::vector<const Topic*> all;
  for (const std::string& pattern : names) {
    GLOAM_TRY(const auto found, find_topics(*table, pattern));
    for (const Topic* topic : found) {
      const bool is_named = topic->info.name == pattern;
      if (topic->info.is_input && is_named)
        return Error{ErrorKind::kUsage,
                     fmt::format("'{}' is an input topic and cannot be subscribed to", pattern)};
      if (!topic->info.is_input && std::ranges::count(all, topic) == 0) all.push_back(topic);
    }
  }
  Wanted wanted;
  for (const Topic* found : all) {
    const TopicPointer topic(table, found);
    const TopicCode& code = topic->code;
    if (std::holds_alternative<FrameEncoder>(code) ||
        std::holds_alternative<FrameEncoderMaker>(code))
      wanted.cameras[topic->streams[0]].push_back(topic);
    else if (std::holds_alternative<ScanEncoder>(code))
      wanted.lidars[topic->streams[0]].push_back(topic);
    else if (std::holds_alternative<SampleEncoder>(code))
      wanted.sensors.push_back(topic);
    else if (std::holds_alternative<LatchedEncoder>(code))
      wanted.latched.push_back(topic);
    else
      wanted.instants.push_back(topic);
  }
  return wanted;
}

TopicFeed::Outlet TopicFeed::make_outlet(const TopicPointer& pointer) const {
  const Topic& topic = *pointer;
  Outlet outlet{pointer};
  const Rational step_rate = simulation_.step_rate(), timestep = {step_rate.den, step_rate.num};
  if (topic.info.rate.num > 0)
    outlet.schedule = outlet.messages = StepSchedule::at_most(topic.info.rate, timestep);
  if (topic.sampled.num > 0) {
    outlet.schedule = StepSchedule::at_most(topic.sampled, timestep);
    if (request_.every_sample) outlet.messages = outlet.schedule;
  }
  if (const auto* encode = std::get_if<FrameEncoder>(&topic.code)) outlet.encode_frame = *encode;
  if (const auto* make = std::get_if<FrameEncoderMaker>(&topic.code))
    outlet.encode_frame = (*make)();
  return outlet;
}

// Outlets of `topics`: those that were there before keep their state.
TopicFeed::Outlets TopicFeed::change(Outlets outlets,
                                     const std::vector<TopicPointer>& topics) const {
  Outlets changed;
  for (const TopicPointer& topic : topics) {
    const auto before = std::ranges::find_if(outlets, [&topic](const Outlet& outlet) {
      return outlet.topic != nullptr && outlet.topic->info.name == topic->info.name;
    });
    changed.push_back(before != outlets.end() ? std::move(*before) : make_outlet(topic));
    changed.back().topic = topic;
  }
  return changed;
}

void TopicFeed::close_unwanted(Parts* parts, const char* kind, const TopicsByStream& wanted) {
  for (const auto& [name, part] : *parts)
    if (!wanted.contains(name)) streams_.close(kind + name);
  std::erase_if(*parts, [&wanted](const auto& part) { return !wanted.contains(part.first); });
}

std::vector<LiveCamera*> TopicFeed::cameras() const {
  std::vector<LiveCamera*> cameras;
  for (const auto& [name, part] : cameras_) cameras.push_back(part.camera);
  return cameras;
}

// Leaves out the topics that are not in `table`, and takes the others from there.
void TopicFeed::keep_topics(const std::shared_ptr<const TopicTable>& table, Outlets* outlets) {
  Outlets next;
  for (Outlet& outlet : *outlets) {
    const auto same = std::ranges::find_if(*table, [&outlet](const Topic& topic) {
      return topic.info.name == outlet.topic->info.name;
    });
    if (same == table->end()) continue;
    outlet.topic = TopicPointer(table, &*same);
    next.push_back(std::move(outlet));
  }
  *outlets = std::move(next);
}

// Makes what reads instants of a World: at first, and after a recompile, when what is gone is
// silent.
Status TopicFeed::follow(const std::shared_ptr<const CompiledWorld>& world, InstantReader* reader) {
  GLOAM_TRY(const auto table, tables_.of(world));
  GLOAM_TRY(reader->solver, PoseSolver::create(world));
  keep_topics(table, &reader->outlets);
  for (Outlet& outlet : reader->outlets) {
    if (outlet.encode_instant && reader->table == table) continue;
    const TopicCode& code = outlet.topic->code;
    const auto* make = std::get_if<InstantEncoderMaker>(&code);
    outlet.encode_instant = make != nullptr ? (*make)() : std::get<InstantEncoder>(code);
  }
  reader->table = table;
  return {};
}

void TopicFeed::send(Outlet* outlet, const Status& encoded, TopicMessage message) {
  if (!encoded.ok()) return note(fmt::format("topic '{}'", outlet->topic->info.name), encoded);
  message.data = outlet->bytes;
  on_message_(message);
}

void TopicFeed::note(const std::string& what, const Status& fault) {
  const std::lock_guard lock(mutex_);
  if (!fault_.ok()) return;
  log_warning("{}: {}", what, fault.error().to_string());
  fault_ = fault;
}

Status TopicFeed::set_latched(const std::shared_ptr<const TopicTable>& table,
                              const std::vector<TopicPointer>& topics) {
  if (topics.empty() && latched_ == nullptr) return {};
  if (latched_ == nullptr) {
    latched_ = std::make_shared<LatchedTopics>(
        [this](const Snapshot& now) { return send_latched_again(now); });
    simulation_.add_latched(latched_);
  }
  return latched_->change([&]() -> Status {
    Outlets before = std::move(latched_outlets_), added;
    std::vector<TopicPointer> kept, others;
    for (const TopicPointer& topic : topics) {
      const bool is_there = std::ranges::any_of(
          before, [&topic](const Outlet& o) { return o.topic->info.name == topic->info.name; });
      (is_there ? kept : others).push_back(topic);
    }
    latched_outlets_ = change(std::move(before), kept);
    added = change({}, others);
    latched_table_ = table;
    GLOAM_TRY_STATUS(send_latched(&added, simulation_.latest()));
    std::ranges::move(added, std::back_inserter(latched_outlets_));
    return {};
  });
}

Status TopicFeed::send_latched(Outlets* outlets, const Snapshot& now) {
  const LatchedInputs inputs{now.time(), [this] { return simulation_.labels(); }};
  for (Outlet& outlet : *outlets) {
    const TopicInfo& info = outlet.topic->info;
    const Status encoded =
        std::get<LatchedEncoder>(outlet.topic->code)(info, inputs, &outlet.bytes);
    GLOAM_TRY_STATUS(encoded);
    send(&outlet, encoded, {info, now.data().run, now.step(), now.time(), now.time(), {}});
  }
  return {};
}

Status TopicFeed::send_latched_again(const Snapshot& now) {
  GLOAM_TRY(const auto table, tables_.of(now.data().world));
  if (table != latched_table_) keep_topics(table, &latched_outlets_);
  latched_table_ = table;
  return send_latched(&latched_outlets_, now);
}

Status TopicFeed::set_camera(const std::string& camera, const std::vector<TopicPointer>& topics) {
  Part& part = cameras_[camera];
  std::vector<std::string> outputs;
  Rational rate = {0, 1};  // all topics of a camera have its pictures: the fastest decides
  for (const TopicPointer& topic : topics) {
    if (std::ranges::count(outputs, topic->channel) == 0) outputs.push_back(topic->channel);
    if (topic->info.rate.value() > rate.value()) rate = topic->info.rate;
  }
  std::ranges::sort(outputs);  // the camera compares them with its present ones
  if (rate.value() != part.rate.value()) {
    streams_.close(kCamera + camera);
    part.camera = nullptr;
  }
  part.rate = rate;
  {
    const std::lock_guard lock(part.mutex);
    part.outlets = change(std::move(part.outlets), topics);
  }
  if (part.camera == nullptr) return open_camera(camera, std::move(outputs), &part);
  part.camera.load()->set_outputs(std::move(outputs));
  return {};
}

Status TopicFeed::open_camera(const std::string& camera, std::vector<std::string> outputs,
                              Part* part) {
  CameraRequest request{.camera = camera, .required = request_.required, .on_end = request_.on_end};
  request.render = simulation_.world().scene().render;
  request.width = request_.width;
  request.height = request_.height;
  request.outputs = std::move(outputs);
  if (part->rate.num > 0) request.rate = part->rate;
  const auto on_frame = [this, part](std::shared_ptr<const CameraFrame> frame) {
    const std::lock_guard lock(part->mutex);
    const LiveCamera* const camera = part->camera;  // null: it opens with all outputs
    for (Outlet& outlet : part->outlets) {
      if (camera != nullptr && !camera->has_made(outlet.topic->channel))
        continue;  // a later frame's
      const TopicInfo& info = outlet.topic->info;
      send(&outlet, outlet.encode_frame(info, *frame, &outlet.bytes),
           {info, -1, frame->step, frame->time, frame->delivery, {}});
    }
  };
  GLOAM_TRY(auto stream, simulation_.open_live_camera(request, on_frame));
  part->camera = stream.get();
  streams_.add(kCamera + camera, std::move(stream));
  return {};
}

Status TopicFeed::set_lidar(const std::string& lidar, const std::vector<TopicPointer>& topics) {
  Part* const part = &lidars_[lidar];
  {
    const std::lock_guard lock(part->mutex);
    part->outlets = change(std::move(part->outlets), topics);
  }
  if (streams_.has(kLidar + lidar)) return {};
  const LidarRequest request{lidar, request_.required, request_.on_end};
  const auto on_scan = [this, part](std::shared_ptr<const LidarScan> scan) {
    const std::lock_guard lock(part->mutex);
    for (Outlet& outlet : part->outlets) {
      const TopicInfo& info = outlet.topic->info;
      const auto& encode = std::get<ScanEncoder>(outlet.topic->code);
      send(&outlet, encode(info, *scan, &outlet.bytes),
           {info, -1, scan->step, scan->start, scan->end, {}});
    }
  };
  GLOAM_TRY(auto stream, simulation_.open_lidar(request, on_scan));
  streams_.add(kLidar + lidar, std::move(stream));
  return {};
}

// One stream of the steps at which one of the topics is due. It is reopened for other topics;
// encoders that accumulate values over time go on.
Status TopicFeed::set_instants(const std::vector<TopicPointer>& topics) {
  std::vector<std::string> names;
  for (const TopicPointer& topic : topics) names.push_back(topic->info.name);
  if (names == std::exchange(instant_names_, names) && streams_.has(kInstants)) return {};
  streams_.close(kInstants);
  instants_.outlets = change(std::move(instants_.outlets), topics);
  if (topics.empty()) return {};
  const SnapshotRequest request{.required = request_.required, .on_end = request_.on_end};
  std::vector<StepSchedule> schedules;
  for (const Outlet& outlet : instants_.outlets) schedules.push_back(outlet.schedule);
  instants_.performance = [this] { return simulation_.stats(); };
  GLOAM_TRY_STATUS(follow(simulation_.world().compiled(), &instants_));
  const auto on_snapshot = [this](const Snapshot& now) {
    if (const Status taken = take_instant(&instants_, now); !taken.ok())
      note("state topics", taken);
  };
  GLOAM_TRY(auto stream, LiveSnapshots::open(simulation_.stream_context(), request, on_snapshot,
                                             first_of(schedules), batch_));
  streams_.add(kInstants, std::move(stream));
  return {};
}

Status TopicFeed::take_instant(InstantReader* reader, const Snapshot& now) {
  const auto is_due = [&now](const Outlet& outlet) {
    return outlet.schedule.step_of(outlet.schedule.first_at_or_after(now.step())) == now.step();
  };
  if (std::ranges::none_of(reader->outlets, is_due)) return {};
  const auto& world = now.data().world;
  if (reader->solver->world() != world) GLOAM_TRY_STATUS(follow(world, reader));
  TopicInstant instant(now, *reader->solver, reader->performance);
  for (Outlet& outlet : reader->outlets) {
    if (!is_due(outlet)) continue;
    const TopicInfo& info = outlet.topic->info;
    const Status encoded = outlet.encode_instant(info, instant, &outlet.bytes);
    if (!encoded.ok() || is_message(&outlet, now.step()))
      send(&outlet, encoded, {info, now.data().run, now.step(), now.time(), now.time(), {}});
  }
  return {};
}

// Whether a message was due since the sample before.
bool TopicFeed::is_message(Outlet* outlet, int64_t step) {
  const int64_t before = outlet->sampled < step ? outlet->sampled : -1;
  outlet->sampled = step;
  const StepSchedule& messages = outlet->messages;
  return messages.step_of(messages.first_at_or_after(before + 1)) <= step;
}

void TopicFeed::flush() {
  streams_.each([](Stream& stream) { stream.flush(); });
}

Status TopicFeed::status() const {
  Status first;
  streams_.each([&first](Stream& stream) {
    if (first.ok()) first = stream.status();
  });
  if (!first.ok()) return first;
  const std::lock_guard lock(mutex_);
  return fault_;
}

}  // namespace gloam
