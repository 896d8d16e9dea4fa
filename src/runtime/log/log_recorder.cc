#include "runtime/log/log_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/log.h"
#include "ros/codec.h"
#include "ros/message_types.h"
#include "ros/messages/gloam_msgs.h"
#include "runtime/log/command_text.h"
#include "runtime/log/run_text.h"
#include "topics/ros_values.h"

namespace gloam {
namespace {

constexpr int kBatch = 32;  // instants that are written at once: a log is in no hurry

// As rosbag2 writes it: YAML, with the numbers of rmw's enums.
std::string qos_text(const TopicQos& qos) {
  return fmt::format(
      "- history: 1\n  depth: {}\n  reliability: {}\n  durability: {}\n  deadline:\n    sec: "
      "9223372036\n    nsec: 854775807\n  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  "
      "liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n  "
      "avoid_ros_namespace_conventions: false",
      qos.depth, qos.is_reliable ? 1 : 2, qos.is_latched ? 1 : 2);
}

std::span<const uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

// Topics of the log: those that are asked for, else the usual ones. Error: there is no such topic.
Result<std::vector<const Topic*>> wanted_topics(const TopicTable& table,
                                                const std::vector<std::string>& patterns) {
  std::vector<const Topic*> wanted;
  for (const Topic& topic : table)
    if (patterns.empty() && topic.info.is_logged && !topic.info.is_input) wanted.push_back(&topic);
  for (const std::string& pattern : patterns) {
    GLOAM_TRY(const auto found, find_topics(table, pattern));
    for (const Topic* topic : found)
      if (!topic->info.is_input && std::ranges::count(wanted, topic) == 0) wanted.push_back(topic);
  }
  return wanted;
}

// Error of a log that ends early, of which the part that was written stays readable.
Status partial(const Status& status) {
  if (status.ok()) return status;
  Error error = status.error();
  error.kind = ErrorKind::kPartial;
  return error;
}

}  // namespace

Result<bool> logs_pictures(const World& world, const LogRequest& request) {
  GLOAM_TRY(const TopicTable table, make_topic_table(world.compiled()));
  GLOAM_TRY(const auto topics, wanted_topics(table, request.topics));
  return std::ranges::any_of(topics, [](const Topic* topic) { return !topic->channel.empty(); });
}

Result<std::unique_ptr<LogRecorder>> LogRecorder::start(LiveSimulation& simulation,
                                                        const LogRequest& request) {
  GLOAM_TRY(const auto table, simulation.topic_table());
  GLOAM_TRY(const auto wanted, wanted_topics(*table, request.topics));
  std::vector<TopicInfo> topics;
  for (const Topic* topic : wanted) topics.push_back(topic->info);
  if (request.overwrite) {
    std::error_code code;  // what is in the way is told of by the sink
    std::filesystem::remove(request.file, code);
  }
  GLOAM_TRY(auto sink, FileSink::create(request.file));
  McapWriterOptions options;
  options.durable = request.durable;
  std::unique_ptr<LogRecorder> log(new LogRecorder(simulation, request));
  LogQueueOptions queue;
  queue.policy = request.required ? LogQueuePolicy::kWait : LogQueuePolicy::kDropOldest;
  log->queue_ = std::make_unique<LogQueue>(
      std::make_unique<McapWriter>(std::move(sink), std::move(options)), queue);
  GLOAM_TRY_STATUS(log->add_channels(topics));
  log->write_new_world(simulation.latest());
  // In a chunk of its own: a log that is cut anywhere behind it can be stepped again.
  GLOAM_TRY_STATUS(log->queue_->push(LogQueueFlush{}));
  if (request.embed) GLOAM_TRY_STATUS(log->embed_files(*log->world_));
  simulation.take_command_log();  // of before
  simulation.simulator().keep_hook_inputs(log->inputs_);
  GLOAM_TRY_STATUS(log->open_streams(topics));
  return log;
}

LogRecorder::~LogRecorder() {
  simulation_.simulator().keep_hook_inputs(nullptr);
  topics_.reset();
  states_.reset();
}

Status LogRecorder::add_channel(const TopicInfo& topic, const std::string& encoding,
                                const std::string& schema, const std::string& hash) {
  uint16_t& schema_id = schemas_[topic.type];
  if (schema_id == 0 && !schema.empty()) {
    schema_id = static_cast<uint16_t>(schemas_.size());
    GLOAM_TRY_STATUS(
        queue_->push(McapSchema{schema_id, topic.type, "ros2msg", {schema.begin(), schema.end()}}));
  }
  const auto id = static_cast<uint16_t>(channels_.size() + 1);
  McapChannel channel{id, schema_id, topic.name, encoding, {}};
  if (encoding == "cdr")
    channel.metadata = {{"offered_qos_profiles", qos_text(topic.qos)}, {"topic_type_hash", hash}};
  GLOAM_TRY_STATUS(queue_->push(std::move(channel)));
  channels_[topic.name] = {id};
  return {};
}

Status LogRecorder::add_channels(const std::vector<TopicInfo>& topics) {
  GLOAM_TRY_STATUS(add_channel({.name = kWorldTopic, .type = "gloam/World"}, "json", "", ""));
  GLOAM_TRY_STATUS(add_channel({.name = kCommandTopic, .type = "gloam/Command"}, "json", "", ""));
  const MessageType &state = message_type<gloam_msgs::State>(),
                    &input = message_type<gloam_msgs::StepInput>();
  GLOAM_TRY_STATUS(
      add_channel({.name = kStateTopic, .type = state.name}, "cdr", state.text, state.hash));
  GLOAM_TRY_STATUS(
      add_channel({.name = kInputTopic, .type = input.name}, "cdr", input.text, input.hash));
  for (const TopicInfo& topic : topics) {
    GLOAM_TRY(const MessageInfo type, message_info(topic.type));
    GLOAM_TRY_STATUS(add_channel(topic, "cdr", type.definition, type.hash));
  }
  return {};
}

Status LogRecorder::embed_files(const CompiledWorld& world) {
  for (const Dependency& file : world.files) {
    if (!file.exists) continue;
    GLOAM_TRY(auto bytes, read_file(file.path));
    McapAttachment attachment;
    attachment.name = file.path.string();
    attachment.media_type = "application/octet-stream";
    attachment.data.assign(bytes.begin(), bytes.end());
    GLOAM_TRY_STATUS(queue_->push(std::move(attachment)));
  }
  return {};
}

Status LogRecorder::open_streams(const std::vector<TopicInfo>& topics) {
  TopicRequest request{
      .width = request_.width, .height = request_.height, .required = request_.required};
  for (const TopicInfo& topic : topics) request.topics.push_back(topic.name);
  GLOAM_TRY(topics_,
            simulation_.open_topic_batches(request, kBatch, [this](const TopicMessage& message) {
              write(message.topic.name, message.time, message.run, message.data);
            }));
  const Rational step_rate = simulation_.step_rate();
  SnapshotRequest states{
      .rate = request_.state_rate, .required = request_.required, .capacity = 256};
  if (states.rate.value() > step_rate.value()) states.rate = step_rate;
  GLOAM_TRY(states_, LiveSnapshots::open(
                         simulation_.simulator(), states,
                         [this](const Snapshot& now) { take(now); }, {}, kBatch));
  return {};
}

// Log time goes on over resets: a run begins where the one before ended.
uint64_t LogRecorder::log_time(double time, int64_t run) const {
  const RunEnds& ends = simulation_.simulator().run_ends();
  const double at = ends.start_of(run) - ends.start_of(first_run_) + time;
  return static_cast<uint64_t>(std::llround(std::max(0.0, at) * 1e9));
}

void LogRecorder::write(const std::string& topic, double time, int64_t run,
                        std::span<const uint8_t> data) {
  const auto found = channels_.find(topic);
  if (found == channels_.end()) return;  // came with a recompile
  LogQueueMessage message;
  message.channel = found->second.id;
  message.sequence = found->second.sequence++;
  message.log_time = message.publish_time = log_time(time, run);
  message.data = queue_->take_buffer();
  message.data.assign(data.begin(), data.end());
  static_cast<void>(queue_->push(std::move(message)));  // status() tells of a failure
}

void LogRecorder::write_world(const Snapshot& now) {
  world_ = now.data().world;
  const auto timestep = simulation_.simulator().own_timestep();
  RunText text = describe_run(*world_, simulation_.seed(), timestep);
  text.run = now.data().run;
  text.step = now.data().world_since;
  const std::string json = to_json(text);
  write(kWorldTopic, now.time(), now.data().run, bytes_of(json));
}

// Everything that had led to a run's first step, if that is a checkpoint's: so it can be stepped
// again from its beginning.
bool LogRecorder::write_history(const Snapshot& now) {
  const auto checkpoint = simulation_.checkpoint();
  const int64_t run = now.data().run;
  if (!checkpoint.ok() || simulation_.latest().data().run != run) return false;
  const RunRecord& record = checkpoint->data().record;
  if (record.first_step == 0) return false;
  RunText text;
  for (const RunRecord::Chapter& chapter : record.chapters) {
    if (chapter.from > now.step()) break;
    text = describe_run(*chapter.world, record.seed, record.timestep);
    text.run = run;
    text.step = chapter.from;
    text.has_history = true;
    const std::string json = to_json(text);
    write(kWorldTopic, now.time(), run, bytes_of(json));
  }
  for (const Command& command : record.commands) {
    if (command.step >= record.first_step) break;  // this run's own
    const std::string json = command_text({run, command}, record.world_at(command.step));
    write(kCommandTopic, now.time(), run, bytes_of(json));
  }
  for (const StepInput& input : record.inputs) write_input(input, now.time(), run);
  world_ = now.data().world;
  return true;
}

void LogRecorder::write_commands() {
  for (const LoggedCommand& logged : simulation_.take_command_log()) {
    const std::string json = command_text(logged, *world_);
    const double time =
        static_cast<double>(logged.command.step) * simulation_.simulator().timestep().value();
    write(kCommandTopic, time, logged.run, bytes_of(json));
  }
}

void LogRecorder::write_input(const StepInput& input, double time, int64_t run) {
  gloam_msgs::StepInput message;
  message.header = ros_header(time, "");
  message.run = run;
  message.step = input.step;
  message.index = input.index;
  message.value = input.value;
  encode(message, &bytes_);
  write(kInputTopic, time, run, bytes_);
}

void LogRecorder::write_hook_inputs() {
  for (const StepInput& input : inputs_->take()) {
    const double time =
        static_cast<double>(input.step) * simulation_.simulator().timestep().value();
    write_input(input, time, input.run);
  }
}

void LogRecorder::write_state(const Snapshot& now) {
  gloam_msgs::State state;
  state.header = ros_header(now.time(), "");
  if (now.data().run == last_run_ && now.step() == last_step_) return;
  last_run_ = now.data().run;
  last_step_ = now.step();
  state.run = now.data().run;
  state.step = now.step();
  state.hash = now.hash();
  state.state.assign(now.state().begin(), now.state().end());
  encode(state, &bytes_);
  write(kStateTopic, now.time(), now.data().run, bytes_);
}

// Writes the World of a run that begins with a checkpoint, or that goes on in another World.
void LogRecorder::write_new_world(const Snapshot& now) {
  const bool may_have_history = now.data().run != world_run_ && now.step() > 0;
  if (!(may_have_history && write_history(now)) && now.data().world != world_) write_world(now);
  world_run_ = now.data().run;
}

void LogRecorder::take(const Snapshot& now) {
  write_new_world(now);
  write_commands();
  write_hook_inputs();
  write_state(now);
}

Status LogRecorder::status() const {
  GLOAM_TRY_STATUS(topics_->status());
  return partial(queue_->status());
}

Status LogRecorder::finish(const Snapshot& last) {
  topics_.reset();
  states_.reset();
  take(last);
  if (inputs_->lost() > 0)
    log_warning(
        "{}: what a step hook wrote in {} steps found no room: the run cannot be stepped "
        "again",
        request_.file.string(), inputs_->lost());
  return partial(queue_->close());
}

}  // namespace gloam
