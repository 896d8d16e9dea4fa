#include "runtime/streams/topic_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/log.h"
#include "runtime/live_simulation.h"
#include "runtime/streams/due_steps.h"

namespace gloam {

Result<std::unique_ptr<TopicFeed>> TopicFeed::open(LiveSimulation& simulation, TopicTables& tables,
                                                   const TopicRequest& request,
                                                   TopicCallback on_message, int batch) {
  std::unique_ptr<TopicFeed> feed(new TopicFeed(tables, request, std::move(on_message), batch));
  GLOAM_TRY(feed->table_, tables.of(simulation.world().compiled()));
  GLOAM_TRY_STATUS(feed->open_all(simulation));
  return feed;
}

Status TopicFeed::open_all(LiveSimulation& simulation) {
  std::vector<const Topic*> wanted;
  for (const std::string& pattern : request_.topics) {
    GLOAM_TRY(const auto found, find_topics(*table_, pattern));
    for (const Topic* topic : found) {
      const bool is_named = topic->info.name == pattern;
      if (topic->info.is_input && is_named)
        return Error{ErrorKind::kUsage,
                     fmt::format("'{}' is an input topic and cannot be subscribed to", pattern)};
      if (!topic->info.is_input && std::ranges::count(wanted, topic) == 0) wanted.push_back(topic);
    }
  }
  const Rational step_rate = simulation.step_rate(), timestep = {step_rate.den, step_rate.num};
  std::map<std::string, Outlets> cameras, lidars;
  Outlets sensors, instants, latched;
  for (const Topic* topic : wanted) {
    Outlet outlet{topic};
    if (topic->info.rate.num > 0)
      outlet.schedule = outlet.messages = StepSchedule::at_most(topic->info.rate, timestep);
    if (topic->sampled.num > 0) {
      outlet.schedule = StepSchedule::at_most(topic->sampled, timestep);
      if (request_.every_sample) outlet.messages = outlet.schedule;
    }
    if (const auto* encode = std::get_if<FrameEncoder>(&topic->code)) outlet.encode_frame = *encode;
    if (const auto* make = std::get_if<FrameEncoderMaker>(&topic->code))
      outlet.encode_frame = (*make)();
    if (outlet.encode_frame)
      cameras[topic->streams[0]].push_back(std::move(outlet));
    else if (std::holds_alternative<ScanEncoder>(topic->code))
      lidars[topic->streams[0]].push_back(std::move(outlet));
    else if (std::holds_alternative<SampleEncoder>(topic->code))
      sensors.push_back(std::move(outlet));
    else if (std::holds_alternative<InstantEncoder>(topic->code) ||
             std::holds_alternative<InstantEncoderMaker>(topic->code))
      instants.push_back(std::move(outlet));
    else
      latched.push_back(std::move(outlet));
  }
  GLOAM_TRY_STATUS(open_latched(simulation, std::move(latched)));
  for (auto& [camera, outlets] : cameras)
    GLOAM_TRY_STATUS(open_camera(simulation, camera, std::move(outlets)));
  for (auto& [lidar, outlets] : lidars)
    GLOAM_TRY_STATUS(open_lidar(simulation, lidar, std::move(outlets)));
  GLOAM_TRY_STATUS(open_sensors(simulation, std::move(sensors)));
  return open_snapshots(simulation, std::move(instants));
}

TopicFeed::~TopicFeed() {
  if (latched_ != nullptr) latched_->close();
}

// Leaves out the topics that are not in `table`, and takes the others from there.
void TopicFeed::keep_topics(const TopicTable& table, Outlets* outlets) {
  Outlets next;
  for (Outlet& outlet : *outlets) {
    const auto same = std::ranges::find_if(table, [&outlet](const Topic& topic) {
      return topic.info.name == outlet.topic->info.name;
    });
    if (same == table.end()) continue;
    outlet.topic = &*same;
    next.push_back(std::move(outlet));
  }
  *outlets = std::move(next);
}

// Makes what reads instants of a World: at first, and after a recompile, when what is gone is
// silent.
Status TopicFeed::follow(const std::shared_ptr<const CompiledWorld>& world, InstantReader* reader) {
  GLOAM_TRY(const auto table, tables_.of(world));
  GLOAM_TRY(reader->solver, PoseSolver::create(world));
  keep_topics(*table, &reader->outlets);
  for (Outlet& outlet : reader->outlets) {
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

Status TopicFeed::open_latched(LiveSimulation& simulation, Outlets outlets) {
  if (outlets.empty()) return {};
  latched_outlets_ = std::move(outlets);
  latched_table_ = table_;
  latched_ = std::make_shared<LatchedTopics>(
      [this, &simulation](const Snapshot& now) { return send_latched(simulation, now); });
  GLOAM_TRY_STATUS(latched_->send(simulation.latest()));
  simulation.add_latched(latched_);
  return {};
}

Status TopicFeed::send_latched(LiveSimulation& simulation, const Snapshot& now) {
  GLOAM_TRY(const auto table, tables_.of(now.data().world));
  if (table != latched_table_) keep_topics(*table, &latched_outlets_);
  latched_table_ = table;
  const LatchedInputs inputs{now.time(), [&simulation] { return simulation.labels(); }};
  for (Outlet& outlet : latched_outlets_) {
    const TopicInfo& info = outlet.topic->info;
    const Status encoded =
        std::get<LatchedEncoder>(outlet.topic->code)(info, inputs, &outlet.bytes);
    GLOAM_TRY_STATUS(encoded);
    send(&outlet, encoded, {info, now.data().run, now.step(), now.time(), now.time(), {}});
  }
  return {};
}

Status TopicFeed::open_camera(LiveSimulation& simulation, const std::string& camera,
                              Outlets outlets) {
  CameraRequest request{.camera = camera, .required = request_.required, .on_end = request_.on_end};
  request.render = simulation.world().scene().render;
  request.width = request_.width;
  request.height = request_.height;
  request.outputs.clear();
  for (const Outlet& outlet : outlets) {
    if (std::ranges::count(request.outputs, outlet.topic->channel) == 0)
      request.outputs.push_back(outlet.topic->channel);
    // All topics of a camera have its pictures: the fastest decides.
    if (outlet.topic->info.rate.value() > request.rate.value())
      request.rate = outlet.topic->info.rate;
  }
  auto shared = std::make_shared<Outlets>(std::move(outlets));
  GLOAM_TRY(auto stream, simulation.open_live_camera(
                             request, [this, shared](std::shared_ptr<const CameraFrame> frame) {
                               for (Outlet& outlet : *shared) {
                                 const TopicInfo& info = outlet.topic->info;
                                 send(&outlet, outlet.encode_frame(info, *frame, &outlet.bytes),
                                      {info, -1, frame->step, frame->time, frame->delivery, {}});
                               }
                             }));
  cameras_.push_back(stream.get());
  streams_.push_back(std::move(stream));
  return {};
}

Status TopicFeed::open_lidar(LiveSimulation& simulation, const std::string& lidar,
                             Outlets outlets) {
  auto shared = std::make_shared<Outlets>(std::move(outlets));
  LidarRequest request{lidar, request_.required, request_.on_end};
  GLOAM_TRY(auto stream,
            simulation.open_lidar(request, [this, shared](std::shared_ptr<const LidarScan> scan) {
              for (Outlet& outlet : *shared) {
                const TopicInfo& info = outlet.topic->info;
                const auto& encode = std::get<ScanEncoder>(outlet.topic->code);
                send(&outlet, encode(info, *scan, &outlet.bytes),
                     {info, -1, scan->step, scan->start, scan->end, {}});
              }
            }));
  streams_.push_back(std::move(stream));
  return {};
}

// One stream of the steps at which one of the topics is due.
Status TopicFeed::open_snapshots(LiveSimulation& simulation, Outlets outlets) {
  if (outlets.empty()) return {};
  const SnapshotRequest request{.required = request_.required, .on_end = request_.on_end};
  std::vector<StepSchedule> schedules;
  for (const Outlet& outlet : outlets) schedules.push_back(outlet.schedule);
  auto reader = std::make_shared<InstantReader>();
  reader->performance = [&simulation] { return simulation.stats(); };
  reader->outlets = std::move(outlets);
  GLOAM_TRY_STATUS(follow(simulation.world().compiled(), reader.get()));
  const auto on_snapshot = [this, reader](const Snapshot& now) {
    if (const Status taken = take_instant(reader.get(), now); !taken.ok())
      note("state topics", taken);
  };
  GLOAM_TRY(auto stream, LiveSnapshots::open(simulation.stream_context(), request, on_snapshot,
                                             first_of(schedules), batch_));
  streams_.push_back(std::move(stream));
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

int64_t TopicFeed::dropped() const {
  int64_t dropped = 0;
  for (const auto& stream : streams_) dropped += stream->dropped();
  return dropped;
}

void TopicFeed::flush() {
  for (const auto& stream : streams_) stream->flush();
}

Status TopicFeed::status() const {
  for (const auto& stream : streams_) GLOAM_TRY_STATUS(stream->status());
  const std::lock_guard lock(mutex_);
  return fault_;
}

}  // namespace gloam
