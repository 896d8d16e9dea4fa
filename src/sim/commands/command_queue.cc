#include "sim/commands/command_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace gloam {
namespace {

// Whether a robot's trajectory moves one of `joints`; empty = all.
bool moves_any(const FollowTrajectory& waiting, const std::vector<Joint>& joints) {
  if (joints.empty() || waiting.joints.empty()) return true;
  return std::ranges::any_of(joints, [&](Joint joint) {
    return std::ranges::find(waiting.joints, joint.id, &Joint::id) != waiting.joints.end();
  });
}

// Whether a Command replaces another one that has not applied yet.
bool replaces(const Command& command, const Command& waiting) {
  const auto* other = std::get_if<FollowTrajectory>(&waiting.what);
  if (other == nullptr) return false;
  if (const auto* follow = std::get_if<FollowTrajectory>(&command.what))
    return follow->robot.id == other->robot.id && moves_any(*other, follow->joints);
  const auto* stop = std::get_if<StopTrajectory>(&command.what);
  return stop != nullptr && stop->robot.id == other->robot.id && moves_any(*other, stop->joints);
}

}  // namespace

CommandQueue::CommandQueue(int capacity, int64_t log_capacity)
    : arrivals_(capacity), log_capacity_(log_capacity) {}

CommandQueue::~CommandQueue() {
  Node* node = nullptr;
  while (arrivals_.try_pop(node)) delete_list(node);
  delete_list(pending_);
  delete_list(log_.load());
  delete_list(retired_.load());
}

Status CommandQueue::post(std::span<const Command> commands) {
  std::vector<QueuedCommand> queued;
  for (const Command& command : commands) queued.push_back({command});
  return post(std::move(queued));
}

Status CommandQueue::post(std::vector<QueuedCommand> commands) {
  delete_list(retired_.exchange(nullptr, std::memory_order_acquire));
  Node* list = nullptr;
  for (size_t i = commands.size(); i-- > 0;) {
    auto* node = new Node;
    node->command = std::move(commands[i].command);
    node->prepared = std::move(commands[i].prepared);
    node->next = list;
    list = node;
  }
  if (list == nullptr || arrivals_.try_push(list)) return {};  // the queue owns it now
  delete_list(list);
  return Error{ErrorKind::kIo,
               fmt::format("the command queue is full: {} commands are waiting for the simulation",
                           arrivals_.capacity()),
               {},
               "post fewer commands per step, or let the simulation step"};
}

void CommandQueue::drain_log() {
  Node* const newest = log_.exchange(nullptr, std::memory_order_acquire);
  const auto first = static_cast<std::ptrdiff_t>(entries_.size());
  for (Node* node = newest; node != nullptr; node = node->next)
    entries_.push_back({node->run, std::move(node->command)});
  delete_list(newest);
  std::reverse(entries_.begin() + first, entries_.end());
}

std::vector<LoggedCommand> CommandQueue::take_log() {
  const std::lock_guard lock(history_mutex_);
  drain_log();
  std::vector<LoggedCommand> fresh(entries_.begin() + static_cast<std::ptrdiff_t>(taken_),
                                   entries_.end());
  log_size_.fetch_sub(static_cast<int64_t>(fresh.size()), std::memory_order_relaxed);
  // Entries of runs that are over are wanted no longer.
  const auto end = std::find_if(entries_.rbegin(), entries_.rend(), [](const LoggedCommand& entry) {
    return std::holds_alternative<ResetSim>(entry.command.what);
  });
  entries_.erase(entries_.begin(), end.base());
  if (static_cast<int64_t>(entries_.size()) > log_capacity_) {
    lost_run_.store(entries_.back().run, std::memory_order_relaxed);
    entries_.clear();
  }
  taken_ = entries_.size();
  return fresh;
}

Result<std::vector<Command>> CommandQueue::history(int64_t run) {
  const std::lock_guard lock(history_mutex_);
  drain_log();
  if (lost_run_.load(std::memory_order_relaxed) == run) {
    return Error{ErrorKind::kPartial,
                 fmt::format("this run had more than {} Commands, and not all of them were kept",
                             log_capacity_),
                 {},
                 "take checkpoints after a reset, or post fewer Commands"};
  }
  std::vector<Command> commands;
  for (const LoggedCommand& entry : entries_)
    if (entry.run == run) commands.push_back(entry.command);
  return commands;
}

void CommandQueue::begin_history(std::vector<Command> commands, int64_t run) {
  take_arrivals(0);
  discard_before(arrival_count_);
  const std::lock_guard lock(history_mutex_);
  drain_log();
  const auto kept = static_cast<std::ptrdiff_t>(taken_);
  entries_.erase(entries_.begin(), entries_.begin() + kept);
  std::vector<LoggedCommand> before;
  for (Command& command : commands) before.push_back({run, std::move(command)});
  taken_ = before.size();
  entries_.insert(entries_.begin(), before.begin(), before.end());
  log_lost_.fetch_add(1, std::memory_order_relaxed);
}

void CommandQueue::take_arrivals(int64_t step) {
  Node* node = nullptr;
  while (arrivals_.try_pop(node)) {
    while (node != nullptr) {
      Node* const rest = node->next;
      node->arrival = arrival_count_++;
      node->due = std::max(node->command.step, step);
      insert(node);
      node = rest;
    }
  }
}

void CommandQueue::insert(Node* node) {
  node->next = nullptr;
  if (pending_ == nullptr) {
    pending_ = pending_tail_ = node;
  } else if (pending_tail_->due <= node->due) {
    pending_tail_ = pending_tail_->next = node;
  } else {
    Node** place = &pending_;
    while ((*place)->due <= node->due) place = &(*place)->next;
    node->next = *place;
    *place = node;
  }
}

CommandQueue::Node* CommandQueue::pop_pending() {
  Node* node = pending_;
  pending_ = node->next;
  if (pending_ == nullptr) pending_tail_ = nullptr;
  return node;
}

void CommandQueue::discard_before(int64_t arrival) {
  Node* all = pending_;
  pending_ = pending_tail_ = nullptr;
  while (all != nullptr) {
    Node* node = all;
    all = all->next;
    if (node->arrival < arrival) {
      discarded_.fetch_add(1, std::memory_order_relaxed);
      retire(node);
    } else {
      // Its step counts from the reset; "next step" is step 0.
      node->due = std::max<int64_t>(node->command.step, 0);
      insert(node);
    }
  }
}

void CommandQueue::discard_trajectories(const Node& by) {
  Node** place = &pending_;
  pending_tail_ = nullptr;
  while (Node* const node = *place) {
    if (node->arrival < by.arrival && replaces(by.command, node->command)) {
      *place = node->next;
      discarded_.fetch_add(1, std::memory_order_relaxed);
      retire(node);
    } else {
      pending_tail_ = node;
      place = &node->next;
    }
  }
}

void CommandQueue::reset_now(int64_t step, int64_t run) {
  take_arrivals(step);
  discard_before(arrival_count_);
  Node* node = new Node;
  node->command.what = ResetSim{};
  log(node, run, step);
}

void CommandQueue::log(Node* node, int64_t run, int64_t step) {
  node->command.step = step;
  node->run = run;
  applied_.fetch_add(1, std::memory_order_relaxed);
  if (log_size_.load(std::memory_order_relaxed) >= log_capacity_) {
    log_lost_.fetch_add(1, std::memory_order_relaxed);
    lost_run_.store(run, std::memory_order_relaxed);
    retire(node);
    return;
  }
  log_size_.fetch_add(1, std::memory_order_relaxed);
  push(log_, node);
}

void CommandQueue::retire(Node* node) { push(retired_, node); }

void CommandQueue::push(std::atomic<Node*>& stack, Node* node) {
  // Only the sim thread pushes and readers take the whole stack, so the loop cannot see ABA.
  node->next = stack.load(std::memory_order_relaxed);
  while (!stack.compare_exchange_weak(node->next, node, std::memory_order_release)) {
  }
}

void CommandQueue::delete_list(Node* node) {
  while (node != nullptr) delete std::exchange(node, node->next);
}

}  // namespace gloam
