#pragma once
// InputLog: what was asked of a simulation, as messages of its input topics at the steps at which
// it applied. Commands come from Python, bridges, controllers' schedules of the scene; controls
// also from step hooks.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "sim/loop/hook_inputs.h"
#include "sim/snapshots/snapshot.h"
#include "topics/topic_table.h"

namespace gloam {

/// Messages that clients have published to inputs that no Command can be turned back into. Filled
/// by the threads of clients, emptied by a log's.
class ReceivedInputs {
 public:
  struct Message {
    std::string topic;
    int64_t run = 0;
    double time = 0;  ///< simulation time at which it came [s]
    std::vector<uint8_t> data;
  };
  void add(Message message);
  std::vector<Message> take();

 private:
  std::mutex mutex_;
  std::vector<Message> messages_;
};

/// Simulation time of a step [s], as Snapshots have it: MuJoCo sums up time steps, which after many
/// differs from their product. `now` is a later Snapshot.
double time_of_step(const Snapshot& now, double timestep, int64_t run, int64_t step);

class InputLog {
 public:
  using Write =
      std::function<void(const TopicInfo&, double time, int64_t run, const MessageBytes&)>;
  /// `topics`: names of the inputs that are logged.
  InputLog(std::vector<std::string> topics, Write write)
      : topics_(std::move(topics)), write_(std::move(write)) {}

  /// Takes the encoders of the topics from another World's table. `schedule`: the Commands of its
  /// scene, by their steps (sim/loop/scene_schedule.h), which no list of posted Commands has.
  void follow(std::shared_ptr<const TopicTable> table, std::vector<Command> schedule);
  /// Writes what Commands and hooks have done since the last call. `now` comes after all of them.
  void take(const Snapshot& now, double timestep, const std::vector<LoggedCommand>& commands,
            const std::vector<StepInput>& hook_inputs);
  void take(const std::vector<ReceivedInputs::Message>& received);

 private:
  struct StepInputs {
    std::vector<Command> commands;
    std::vector<const StepInput*> hook_inputs;
  };
  using ByStep = std::map<std::pair<int64_t, int64_t>, StepInputs>;  // by run and step
  void begin_run(const Snapshot& now);
  void add_scheduled(int64_t end, ByStep* by_step);
  void set_controls(const Snapshot& now, const StepInputs& inputs);
  void set_control(int place, double value);

  const std::vector<std::string> topics_;
  const Write write_;
  std::shared_ptr<const TopicTable> table_;
  std::vector<Command> schedule_;
  int64_t scheduled_ = 0;         // Commands of the scene before this step of `run_` are logged
  int64_t run_ = -1;              // of `controls_`
  std::vector<double> controls_;  // (nu)
  std::vector<uint8_t> is_set_;   // (nu)
  MessageBytes bytes_;
};

}  // namespace gloam
