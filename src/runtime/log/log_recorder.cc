#include "runtime/log/log_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "base/own_file.h"
#include "ros/codec.h"
#include "ros/messages/gloam_msgs.h"
#include "runtime/log/command_text.h"
#include "runtime/log/run_text.h"
#include "runtime/log/wanted_topics.h"
#include "sim/loop/scene_schedule.h"
#include "topics/ros_values.h"

namespace gloam {
namespace {

constexpr int kBatch = 32;  // instants that are written at once: a log is in no hurry

// Error of a log that ends early, of which the part that was written stays readable.
Status partial(const Status& status) {
  if (status.ok()) return status;
  Error error = status.error();
  error.kind = ErrorKind::kPartial;
  return error;
}

}  // namespace

Result<std::unique_ptr<LogRecorder>> LogRecorder::start(LiveSimulation& simulation,
                                                        const LogRequest& request) {
  GLOAM_TRY(const auto table, simulation.topic_table());
  GLOAM_TRY(const auto wanted, wanted_topics(*table, request.topics));
  std::vector<TopicInfo> topics;
  for (const Topic* topic : wanted) topics.push_back(topic->info);
  if (request.overwrite) GLOAM_TRY_STATUS(remove_unless_written(request.file));
  GLOAM_TRY(auto sink, FileSink::create(request.file));
  McapWriterOptions options;
  options.durable = request.durable;
  LogQueueOptions queue;
  queue.overflow = request.required ? Overflow::kWait : Overflow::kDropOldest;
  auto writer = std::make_unique<McapWriter>(std::move(sink), std::move(options));
  std::unique_ptr<LogRecorder> log(new LogRecorder(simulation, request));
  GLOAM_TRY_STATUS(log->begin(std::make_unique<LogQueue>(std::move(writer), queue), topics));
  return log;
}

LogRecorder::LogRecorder(LiveSimulation& simulation, const LogRequest& request)
    : simulation_(simulation), request_(request), first_run_(simulation.latest().data().run) {}

Status LogRecorder::begin(std::unique_ptr<LogQueue> queue, const std::vector<TopicInfo>& topics) {
  channels_ = std::make_unique<LogChannels>(std::move(queue));
  std::vector<TopicInfo> outputs;
  std::vector<std::string> inputs;
  for (const TopicInfo& topic : topics)
    if (topic.is_input)
      inputs.push_back(topic.name);
    else
      outputs.push_back(topic);
  inputs_ = std::make_unique<InputLog>(
      std::move(inputs),
      [this](const TopicInfo& topic, double time, int64_t run, const MessageBytes& data) {
        // A log contains only the input topics that received a message.
        static_cast<void>(channels_->add(topic));
        write(topic.name, time, run, data);
      });
  GLOAM_TRY_STATUS(declare(outputs));
  worlds_ = std::make_unique<WorldLog>(request_, *channels_, simulation_);
  write_new_world(simulation_.latest());
  GLOAM_TRY_STATUS(fault_);
  // In a chunk of its own: a log that is cut anywhere behind it can be stepped again.
  GLOAM_TRY_STATUS(channels_->queue().push(LogQueueFlush{}));
  simulation_.take_command_log();  // of before
  simulation_.simulator().keep_hook_inputs(hook_inputs_);
  simulation_.keep_received_inputs(received_);
  return open_streams(outputs);
}

LogRecorder::~LogRecorder() {
  simulation_.simulator().keep_hook_inputs(nullptr);
  simulation_.keep_received_inputs(nullptr);
  topics_.reset();
  states_.reset();
}

Status LogRecorder::declare(const std::vector<TopicInfo>& outputs) {
  const std::string text = type_name<std_msgs::String>();
  GLOAM_TRY_STATUS(channels_->add({.name = kWorldTopic, .type = text}));
  GLOAM_TRY_STATUS(channels_->add({.name = kCommandTopic, .type = text}));
  GLOAM_TRY_STATUS(channels_->add({.name = kStateTopic, .type = type_name<gloam_msgs::State>()}));
  GLOAM_TRY_STATUS(
      channels_->add({.name = kInputTopic, .type = type_name<gloam_msgs::StepInput>()}));
  for (const TopicInfo& topic : outputs) GLOAM_TRY_STATUS(channels_->add(topic));
  return {};
}

Status LogRecorder::open_streams(const std::vector<TopicInfo>& outputs) {
  TopicRequest request{
      .width = request_.width, .height = request_.height, .required = request_.required};
  for (const TopicInfo& topic : outputs) request.topics.push_back(topic.name);
  GLOAM_TRY(topics_,
            simulation_.open_topic_batches(request, kBatch, [this](const TopicMessage& message) {
              write(message.topic.name, message.time, message.run, message.data);
            }));
  const Rational step_rate = simulation_.step_rate();
  SnapshotRequest states{
      .rate = request_.state_rate, .required = request_.required, .capacity = 256};
  if (states.rate.value() > step_rate.value()) states.rate = step_rate;
  GLOAM_TRY(states_, LiveSnapshots::open(
                         simulation_.stream_context(), states,
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
  channels_->write(topic, log_time(time, run), data);  // status() reports a failure
}

void LogRecorder::write_text(const char* topic, double time, int64_t run, std::string text) {
  encode(std_msgs::String{std::move(text)}, &bytes_);
  write(topic, time, run, bytes_);
}

// Everything that had led to a run's first step, if that is a checkpoint's: so it can be stepped
// again from its beginning.
bool LogRecorder::write_history(const Snapshot& now) {
  const auto checkpoint = simulation_.checkpoint();
  const int64_t run = now.data().run;
  if (!checkpoint.ok() || simulation_.latest().data().run != run) return false;
  const RunRecord& record = checkpoint->data().record;
  if (record.first_step == 0) return false;
  auto command = record.commands.begin();
  for (size_t i = 0; i < record.chapters.size() && record.chapters[i].from <= now.step(); ++i) {
    const RunRecord::Chapter& chapter = record.chapters[i];
    const auto world = chapter.compiled();
    if (!world.ok()) {
      log_warning("the log's run cannot be replayed: {}", world.error().to_string());
      return false;
    }
    keep(worlds_->write(**world, {run, chapter.from, true}, log_time(now.time(), run)));
    const bool is_last = i + 1 == record.chapters.size();
    const int64_t end =
        is_last ? record.first_step : std::min(record.first_step, record.chapters[i + 1].from);
    for (; command != record.commands.end() && command->step < end; ++command)
      write_text(kCommandTopic, now.time(), run, command_text({run, *command}, **world));
  }
  for (const StepInput& input : record.inputs) write_input(input, now.time(), run);
  world_ = now.data().world;
  return true;
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

void LogRecorder::write_inputs(const Snapshot& now) {
  const double timestep = simulation_.simulator().timestep().value();
  const std::vector<LoggedCommand> commands = simulation_.take_command_log();
  const std::vector<StepInput> hook_inputs = hook_inputs_->take();
  for (const LoggedCommand& logged : commands)
    write_text(kCommandTopic, time_of_step(now, timestep, logged.run, logged.command.step),
               logged.run, command_text(logged, *world_));
  for (const StepInput& input : hook_inputs)
    write_input(input, time_of_step(now, timestep, input.run, input.step), input.run);
  inputs_->take(now, timestep, commands, hook_inputs);
  inputs_->take(received_->take());
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

// Commands of the scene; a scene whose schedule is wrong does not run.
std::vector<Command> LogRecorder::schedule_of(const CompiledWorld& world) const {
  auto schedule = scene_schedule(world, simulation_.simulator().timestep());
  return schedule.ok() ? *std::move(schedule) : std::vector<Command>();
}

// Writes the World of a run that begins with a checkpoint, or that goes on in another World.
void LogRecorder::write_new_world(const Snapshot& now) {
  const bool may_have_history = now.data().run != world_run_ && now.step() > 0;
  const bool is_new = now.data().world != world_;
  if (is_new)
    if (auto table = simulation_.topic_table_of(now.data().world); table.ok())
      inputs_->follow(*std::move(table), schedule_of(*now.data().world));
  if (!(may_have_history && write_history(now)) && is_new) {
    world_ = now.data().world;
    keep(worlds_->write(*world_, {now.data().run, now.data().world_since, false},
                        log_time(now.time(), now.data().run)));
  }
  world_run_ = now.data().run;
}

void LogRecorder::take(const Snapshot& now) {
  write_new_world(now);
  write_inputs(now);
  write_state(now);
}

// Keeps the first failure.
void LogRecorder::keep(const Status& status) {
  if (fault_.ok()) fault_ = status;
}

Status LogRecorder::status() const {
  GLOAM_TRY_STATUS(topics_->status());
  return partial(channels_->queue().status());
}

Status LogRecorder::finish(const Snapshot& last) {
  if (!request_.required)  // nobody waits for a picture that a live run has begun
    for (LiveCamera* const camera : cameras()) camera->abandon();
  topics_.reset();
  states_.reset();
  take(last);
  if (hook_inputs_->lost() > 0)
    log_warning(
        "{}: values that a step hook wrote in {} steps were lost: the run cannot be replayed",
        request_.file.string(), hook_inputs_->lost());
  GLOAM_TRY_STATUS(partial(channels_->queue().close()));
  return partial(fault_);
}

}  // namespace gloam
