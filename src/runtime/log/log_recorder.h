#pragma once
// LogRecorder: writes a running simulation as a log: its topics, and what it takes to step it again
// (World, Commands, states with their hashes).

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gloam/log.h"
#include "mcap/log_queue.h"
#include "runtime/live_simulation.h"

namespace gloam {

/// Whether a log has topics that are made of pictures. Error: no such topic.
Result<bool> logs_pictures(const World& world, const LogRequest& request);

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
  int64_t dropped() const { return static_cast<int64_t>(queue_->dropped()); }

 private:
  struct Channel {
    uint16_t id;
    uint32_t sequence = 0;
  };

  LogRecorder(LiveSimulation& simulation, const LogRequest& request)
      : simulation_(simulation), request_(request), first_run_(simulation.latest().data().run) {}
  Status add_channels(const std::vector<TopicInfo>& topics);
  Status add_channel(const TopicInfo& topic, const std::string& encoding, const std::string& schema,
                     const std::string& hash);
  Status embed_files(const CompiledWorld& world);
  Status open_streams(const std::vector<TopicInfo>& topics);
  void take(const Snapshot& now);
  void write_commands();
  void write_hook_inputs();
  void write_input(const StepInput& input, double time, int64_t run);
  void write_world(const Snapshot& now);
  bool write_history(const Snapshot& now);
  void write_new_world(const Snapshot& now);
  void write_state(const Snapshot& now);
  void write(const std::string& topic, double time, int64_t run, std::span<const uint8_t> data);
  uint64_t log_time(double time, int64_t run) const;

  LiveSimulation& simulation_;
  const LogRequest request_;
  std::unique_ptr<LogQueue> queue_;
  std::map<std::string, Channel> channels_;     // by topic
  std::map<std::string, uint16_t> schemas_;     // by message type
  const int64_t first_run_;                     // in which the log began
  std::shared_ptr<const CompiledWorld> world_;  // that was written last
  int64_t world_run_ = -1;                      // run in which it was looked for last
  int64_t last_run_ = -1, last_step_ = -1;      // of the last state that was written
  std::vector<uint8_t> bytes_;
  const std::shared_ptr<HookInputs> inputs_ = std::make_shared<HookInputs>();
  std::unique_ptr<TopicStream> topics_;
  std::unique_ptr<SnapshotStream> states_;
};

}  // namespace gloam
