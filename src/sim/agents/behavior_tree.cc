#include "sim/agents/behavior_tree.h"

#include "base/hash.h"

namespace gloam {

TreeState::TreeState(std::shared_ptr<const BehaviorTree> tree)
    : tree_(std::move(tree)), memory_(tree_->nodes.size()) {}

void TreeState::reset() { memory_.assign(memory_.size(), Memory{}); }

NodeStatus TreeState::tick(TreeHost* host) {
  const NodeStatus status = tick_node(0, host);
  if (status != NodeStatus::kRunning) reset();
  return status;
}

uint64_t TreeState::hash(uint64_t seed) const {
  return hash_bytes(memory_.data(), memory_.size() * sizeof(Memory), seed);
}

void TreeState::halt(int node) {
  Memory& memory = memory_[static_cast<size_t>(node)];
  if (memory.status == NodeStatus::kIdle && memory.child == 0) return;
  memory = {};
  halt_children(node);
}

void TreeState::halt_children(int node) {
  for (const int child : tree_->nodes[static_cast<size_t>(node)].children) halt(child);
}

NodeStatus TreeState::tick_node(int node, TreeHost* host) {
  const NodeStatus status = run(node, host);
  memory_[static_cast<size_t>(node)].status = status;
  return status;
}

NodeStatus TreeState::run(int node, TreeHost* host) {
  const TreeNodeKind kind = tree_->nodes[static_cast<size_t>(node)].kind;
  if (kind < TreeNodeKind::kParallel) return run_list(node, host);
  if (kind == TreeNodeKind::kParallel) return run_parallel(node, host);
  if (kind < TreeNodeKind::kAlwaysSuccess) return run_decorator(node, host);
  return run_leaf(node, host);
}

// Sequences go on at success, fallbacks at failure. What is not reactive remembers where it was;
// what is begins at its first child each time, and halts those behind the one that ends the tick.
NodeStatus TreeState::run_list(int node, TreeHost* host) {
  const TreeNode& n = tree_->nodes[static_cast<size_t>(node)];
  Memory& memory = memory_[static_cast<size_t>(node)];
  const bool is_fallback =
      n.kind == TreeNodeKind::kFallback || n.kind == TreeNodeKind::kReactiveFallback;
  const bool is_reactive =
      n.kind == TreeNodeKind::kReactiveSequence || n.kind == TreeNodeKind::kReactiveFallback;
  const NodeStatus goes_on = is_fallback ? NodeStatus::kFailure : NodeStatus::kSuccess;
  const NodeStatus ends = is_fallback ? NodeStatus::kSuccess : NodeStatus::kFailure;
  if (is_reactive) memory.child = 0;
  for (; memory.child < static_cast<int>(n.children.size()); ++memory.child) {
    const NodeStatus status = tick_node(n.children[static_cast<size_t>(memory.child)], host);
    if (status == goes_on) continue;
    if (is_reactive)
      for (size_t i = static_cast<size_t>(memory.child) + 1; i < n.children.size(); ++i)
        halt(n.children[i]);
    if (status == NodeStatus::kRunning) return status;
    const int child = memory.child;
    halt_children(node);
    memory.child = n.kind == TreeNodeKind::kSequenceWithMemory ? child : 0;
    return ends;
  }
  halt_children(node);
  memory.child = 0;
  return goes_on;
}

NodeStatus TreeState::run_parallel(int node, TreeHost* host) {
  const TreeNode& n = tree_->nodes[static_cast<size_t>(node)];
  const int size = static_cast<int>(n.children.size());
  const int wanted = n.count < 0 ? size : n.count,
            most_failures = n.failures < 0 ? size : n.failures;
  int good = 0, bad = 0;
  for (const int child : n.children) {
    NodeStatus status = memory_[static_cast<size_t>(child)].status;
    if (status != NodeStatus::kSuccess && status != NodeStatus::kFailure)
      status = tick_node(child, host);
    good += status == NodeStatus::kSuccess;
    bad += status == NodeStatus::kFailure;
  }
  NodeStatus status = NodeStatus::kRunning;
  if (good >= wanted)
    status = NodeStatus::kSuccess;
  else if (bad >= most_failures || size - bad < wanted)
    status = NodeStatus::kFailure;
  if (status != NodeStatus::kRunning) halt_children(node);
  return status;
}

NodeStatus TreeState::run_decorator(int node, TreeHost* host) {
  const TreeNode& n = tree_->nodes[static_cast<size_t>(node)];
  Memory& memory = memory_[static_cast<size_t>(node)];
  const int child = n.children.front();
  const bool is_new = memory.status != NodeStatus::kRunning;
  if (is_new) memory.begin = host->time(), memory.count = 0;
  const auto ended = [&](NodeStatus status) {
    halt(child);
    return status;
  };
  if (n.kind == TreeNodeKind::kDelay && host->time() - memory.begin < n.seconds)
    return NodeStatus::kRunning;
  if (n.kind == TreeNodeKind::kTimeout && !is_new && host->time() - memory.begin >= n.seconds)
    return ended(NodeStatus::kFailure);
  const NodeStatus status = tick_node(child, host);
  if (status == NodeStatus::kRunning) return status;
  const bool is_good = status == NodeStatus::kSuccess;
  switch (n.kind) {
    case TreeNodeKind::kInverter:
      return ended(is_good ? NodeStatus::kFailure : NodeStatus::kSuccess);
    case TreeNodeKind::kForceSuccess:
      return ended(NodeStatus::kSuccess);
    case TreeNodeKind::kForceFailure:
      return ended(NodeStatus::kFailure);
    case TreeNodeKind::kKeepRunningUntilFailure:
      return is_good ? ended(NodeStatus::kRunning) : ended(NodeStatus::kFailure);
    case TreeNodeKind::kRepeat:  // one cycle a tick, so that none goes on for ever in one
      if (!is_good) return ended(NodeStatus::kFailure);
      ++memory.count;
      return ended(n.count >= 0 && memory.count >= n.count ? NodeStatus::kSuccess
                                                           : NodeStatus::kRunning);
    case TreeNodeKind::kRetryUntilSuccessful:
      if (is_good) return ended(NodeStatus::kSuccess);
      ++memory.count;
      return ended(n.count >= 0 && memory.count >= n.count ? NodeStatus::kFailure
                                                           : NodeStatus::kRunning);
    default:
      return ended(status);
  }
}

NodeStatus TreeState::run_leaf(int node, TreeHost* host) {
  const TreeNode& n = tree_->nodes[static_cast<size_t>(node)];
  Memory& memory = memory_[static_cast<size_t>(node)];
  const bool is_new = memory.status != NodeStatus::kRunning;
  if (is_new) memory.begin = host->time();
  const auto is = [](bool yes) { return yes ? NodeStatus::kSuccess : NodeStatus::kFailure; };
  switch (n.kind) {
    case TreeNodeKind::kAlwaysSuccess:
      return NodeStatus::kSuccess;
    case TreeNodeKind::kWait:
      host->stand();
      return host->time() - memory.begin >= n.seconds ? NodeStatus::kSuccess : NodeStatus::kRunning;
    case TreeNodeKind::kGoTo:
      return host->go_to(n.goal, n.speed, is_new);
    case TreeNodeKind::kWander:
      return host->wander(n.speed, is_new);
    case TreeNodeKind::kFollow:
      return host->follow(n.target, n.distance, n.speed);
    case TreeNodeKind::kFace:
      return host->face(n.target);
    case TreeNodeKind::kStand:
      host->stand();
      return NodeStatus::kRunning;
    case TreeNodeKind::kStopFor:
      if (host->robot_distance() >= n.distance) return NodeStatus::kSuccess;
      host->stand();
      return NodeStatus::kRunning;
    case TreeNodeKind::kRobotNear:
      return is(host->robot_distance() < n.distance);
    case TreeNodeKind::kAgentNear:
      return is(host->agent_distance() < n.distance);
    case TreeNodeKind::kAtGoal:
      return is(host->distance_to(n.goal) < n.distance);
    case TreeNodeKind::kTouched:
      return is(host->was_touched());
    case TreeNodeKind::kTimeReached:
      return is(host->time() >= n.seconds);
    default:
      return NodeStatus::kFailure;
  }
}

}  // namespace gloam
