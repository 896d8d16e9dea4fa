#pragma once
// Commands on their way to the sim thread: posted by any thread, kept in order of (step, arrival)
// until their step, then in the log with the step they really applied at. The sim thread neither
// locks, allocates nor frees here: nodes are made and deleted by the threads that post and read.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "gloam/command.h"
#include "sim/commands/lock_free_queue.h"
#include "sim/loop/prepared_input.h"

namespace gloam {

/// A Command with the parts of it that were made in advance; null for most.
struct QueuedCommand {
  Command command;
  std::unique_ptr<PreparedInput> prepared = nullptr;
};

class CommandQueue {
 public:
  /// `capacity` = commands in flight between two steps; `log_capacity` = length of the log.
  CommandQueue(int capacity, int64_t log_capacity);
  ~CommandQueue();
  CommandQueue(const CommandQueue&) = delete;
  CommandQueue& operator=(const CommandQueue&) = delete;

  // ---- any thread ----
  /// kIo Error when the queue is full: the command is not taken.
  Status post(Command command) { return post(std::span<const Command>(&command, 1)); }
  /// The same for several that come to the simulation together: all or none.
  Status post(std::span<const Command> commands);
  Status post(std::vector<QueuedCommand> commands);
  /// Commands that have applied since the last call, in order.
  std::vector<LoggedCommand> take_log();
  /// Commands that have applied in `run`, the present one, in order. Error: some were not kept.
  Result<std::vector<Command>> history(int64_t run);
  /// Commands that have applied, over all runs.
  int64_t applied() const { return applied_.load(std::memory_order_relaxed); }
  /// What the log does not hold, so that a replay of it would not be exact: commands that found it
  /// full, recompiles.
  int64_t log_lost() const { return log_lost_.load(std::memory_order_relaxed); }
  /// Commands for later steps that a reset threw away, a recompile that took their thing away, or
  /// a later trajectory that replaced theirs.
  int64_t discarded() const { return discarded_.load(std::memory_order_relaxed); }

  // ---- the sim thread ----
  /// True when due() could find something: cheap, called before every step.
  bool maybe_due(int64_t step) const {
    return arrivals_.size() > 0 || (pending_ != nullptr && pending_->due <= step);
  }
  /// Calls apply(command, prepared) for the commands due before `step`, oldest first, and logs
  /// them. A ResetSim ends the round: what was posted before it is thrown away, what came after it
  /// waits. Returns true when there was one.
  template <class Apply>
  bool apply_due(int64_t step, int64_t run, Apply&& apply) {
    take_arrivals(step);
    while (pending_ != nullptr && pending_->due <= step) {
      Node* node = pop_pending();
      const bool reset = std::holds_alternative<ResetSim>(node->command.what);
      if (!reset) apply(static_cast<const Command&>(node->command), node->prepared);
      if (reset) discard_before(node->arrival);
      if (ends_trajectories(node->command)) discard_trajectories(*node);
      log(node, run, step);
      if (reset) return true;
    }
    return false;
  }
  /// Between two steps: every Command that waits becomes the QueuedCommand translate(command), or
  /// is thrown away where that is nothing. What was logged before is of another World: from here on
  /// the log cannot be replayed. Allocates.
  template <class Translate>
  void translate(int64_t step, Translate&& translate) {
    take_arrivals(step);
    Node* all = pending_;
    pending_ = pending_tail_ = nullptr;
    while (all != nullptr) {
      Node* node = std::exchange(all, all->next);
      if (std::optional<QueuedCommand> next =
              translate(static_cast<const Command&>(node->command))) {
        node->command = std::move(next->command);
        node->prepared = std::move(next->prepared);
        insert(node);
      } else {
        discarded_.fetch_add(1, std::memory_order_relaxed);
        retire(node);
      }
    }
    log_lost_.fetch_add(1, std::memory_order_relaxed);
  }
  /// A reset that did not come as a Command: throws away everything that waits and logs a ResetSim.
  /// Allocates.
  void reset_now(int64_t step, int64_t run);
  /// A simulation that goes on in `run` from a checkpoint, to which these Commands have led. Those
  /// that wait are thrown away, and the log can no longer be replayed. Allocates.
  void begin_history(std::vector<Command> commands, int64_t run);

 private:
  struct Node {
    Command command;
    std::unique_ptr<PreparedInput> prepared = nullptr;  ///< once applied: what it has replaced
    int64_t due = 0, arrival = 0, run = 0;
    Node* next = nullptr;
  };

  void take_arrivals(int64_t step);
  void insert(Node* node);
  Node* pop_pending();
  void discard_before(int64_t arrival);
  static bool ends_trajectories(const Command& command) {
    return std::holds_alternative<FollowTrajectory>(command.what) ||
           std::holds_alternative<StopTrajectory>(command.what);
  }
  void discard_trajectories(const Node& by);
  void log(Node* node, int64_t run, int64_t step);
  void retire(Node* node);
  void drain_log();
  static void push(std::atomic<Node*>& stack, Node* node);
  static void delete_list(Node* node);

  LockFreeQueue<Node*> arrivals_;  // of lists
  Node* pending_ = nullptr;        // sorted by (due, arrival)
  Node* pending_tail_ = nullptr;
  int64_t arrival_count_ = 0;
  int64_t log_capacity_;
  std::atomic<int64_t> log_size_{0}, applied_{0}, log_lost_{0}, discarded_{0};
  std::atomic<Node*> log_{nullptr};      // stack, newest first
  std::atomic<Node*> retired_{nullptr};  // to be deleted by the next thread that posts
  std::atomic<int64_t> lost_run_{-1};    // the last run of which the log is not whole

  std::mutex history_mutex_;            // guards what follows
  std::vector<LoggedCommand> entries_;  // out of log_: of the present run, and those not yet taken
  size_t taken_ = 0;                    // of entries_
};

}  // namespace gloam
