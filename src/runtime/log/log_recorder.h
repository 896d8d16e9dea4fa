#pragma once
// LogRecorder: writes a running simulation as a log: its topics, and what it takes to step it again
// (World, Commands, states with their hashes).

#include <memory>
#include <string>
#include <vector>

#include "gloam/log.h"
#include "runtime/live/input_log.h"
#include "runtime/live/live_simulation.h"
#include "runtime/live/topic_feed.h"
#include "runtime/log/log_channels.h"
#include "runtime/log/world_log.h"

namespace gloam {

class LogRecorder {
 public:
  /// Before the first step. Errors: the file exists, no such topic, those of the streams.
  static Result<std::unique_ptr<LogRecorder>> start(LiveSimulation& simulation,
                                                    const LogRequest& request);
  ~LogRecorder();

  /// Why it writes no more, if so.
  Status status() const;
  /// After the simulation has stopped: writes what waits, the last state and the log's index.
  Status finish(const Snapshot& last);
  /// Messages lost because the disk was slow, real-time runs alone.
  int64_t dropped() const { return static_cast<int64_t>(channels_->queue().dropped()); }
  /// Cameras whose pictures it writes.
  std::vector<LiveCamera*> cameras() const { return topics_->cameras(); }

 private:
  LogRecorder(LiveSimulation& simulation, const LogRequest& request);
  Status begin(std::unique_ptr<LogQueue> queue, const std::vector<TopicInfo>& topics);
  Status declare(const std::vector<TopicInfo>& outputs);
  Status open_streams(const std::vector<TopicInfo>& outputs);
  void take(const Snapshot& now);
  void keep(const Status& status);
  void write_inputs(const Snapshot& now);
  void write_input(const StepInput& input, double time, int64_t run);
  void write_text(const char* topic, double time, int64_t run, std::string text);
  bool write_history(const Snapshot& now);
  std::vector<Command> schedule_of(const CompiledWorld& world) const;
  void write_new_world(const Snapshot& now);
  void write_state(const Snapshot& now);
  void write(const std::string& topic, double time, int64_t run, std::span<const uint8_t> data);
  uint64_t log_time(double time, int64_t run) const;

  LiveSimulation& simulation_;
  const LogRequest request_;
  std::unique_ptr<LogChannels> channels_;
  std::unique_ptr<WorldLog> worlds_;
  Status fault_;             // of the states' thread: a file that could not be embedded
  const int64_t first_run_;  // in which the log began
  std::shared_ptr<const CompiledWorld> world_;  // that was written last
  int64_t world_run_ = -1;                      // run in which it was looked for last
  int64_t last_run_ = -1, last_step_ = -1;      // of the last state that was written
  std::vector<uint8_t> bytes_;
  const std::shared_ptr<HookInputs> hook_inputs_ = std::make_shared<HookInputs>();
  const std::shared_ptr<ReceivedInputs> received_ = std::make_shared<ReceivedInputs>();
  std::unique_ptr<InputLog> inputs_;
  std::unique_ptr<TopicFeed> topics_;
  std::unique_ptr<SnapshotStream> states_;
};

}  // namespace gloam
