#pragma once
// Behaviour trees with the nodes and the meaning that BehaviorTree.CPP 4 gives them (Faconti;
// behaviortree.dev), ticked at the rate of decisions. Trees are shared, memory is an agent's own.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "sim/agents/agent_math.h"

namespace gloam {

enum class NodeStatus : uint8_t { kIdle, kRunning, kSuccess, kFailure };

enum class TreeNodeKind : uint8_t {
  // Controls.
  kSequence,
  kSequenceWithMemory,
  kReactiveSequence,
  kFallback,
  kReactiveFallback,
  kParallel,
  // Decorators: one child.
  kInverter,
  kRepeat,
  kRetryUntilSuccessful,
  kKeepRunningUntilFailure,
  kTimeout,
  kDelay,
  kForceSuccess,
  kForceFailure,
  // Leaves.
  kAlwaysSuccess,
  kAlwaysFailure,
  kWait,         ///< for a time, standing
  kGoTo,         ///< runs until it is there
  kWander,       ///< the same, to a random place
  kFollow,       ///< runs; keeps `distance` from a robot or another agent
  kStopFor,      ///< runs, standing, as long as a robot is nearer than `distance`; then succeeds
  kStand,        ///< runs
  kFace,         ///< turns to a robot or agent and runs until it is faced
  kRobotNear,    ///< condition: a robot is nearer than `distance`
  kAgentNear,    ///< condition: another agent is
  kAtGoal,       ///< condition: `goal` is nearer than `distance`
  kTouched,      ///< condition: a robot has touched it within the last second
  kTimeReached,  ///< condition: simulation time is at least `seconds`
};

struct TreeNode {
  TreeNodeKind kind = TreeNodeKind::kAlwaysSuccess;
  std::vector<int> children;  ///< numbers of nodes
  // Values of its ports; tree_reader.cc lists the ports of each kind.
  Vec3d goal;           ///< [m]
  double seconds = 0;   ///< duration of waits, delays, timeouts
  double distance = 0;  ///< [m]
  double speed = 0;     ///< [m/s]; 0 = the agent's own
  int count = 0;        ///< number of cycles, attempts, successes; -1 = no end, all
  int failures = 1;     ///< failures that a Parallel allows
  std::string target;   ///< name of a robot or agent; "" = the nearest robot
  SourceLoc loc;
};

struct BehaviorTree {
  std::vector<TreeNode> nodes;  ///< the first is the root
};

/// Interface through which leaves see and control an agent.
class TreeHost {
 public:
  virtual ~TreeHost() = default;
  virtual double time() const = 0;  ///< [s]
  /// `is_new`: the node has just begun.
  virtual NodeStatus go_to(Vec3d goal, double speed, bool is_new) = 0;
  virtual NodeStatus wander(double speed, bool is_new) = 0;
  virtual NodeStatus follow(const std::string& target, double distance, double speed) = 0;
  virtual NodeStatus face(const std::string& target) = 0;
  virtual void stand() = 0;
  /// Distance to the nearest robot, or agent, or to a point [m].
  virtual double robot_distance() const = 0;
  virtual double agent_distance() const = 0;
  virtual double distance_to(Vec3d p) const = 0;
  virtual bool was_touched() const = 0;
};

/// State of one agent in its tree.
class TreeState {
 public:
  explicit TreeState(std::shared_ptr<const BehaviorTree> tree);
  void reset();
  /// One tick from the root; a tree that has ended begins anew at the next.
  NodeStatus tick(TreeHost* host);
  uint64_t hash(uint64_t seed) const;

 private:
  struct Memory {
    double begin = 0;  // [s]
    int32_t child = 0, count = 0;
    NodeStatus status = NodeStatus::kIdle;  // status of the last tick
    uint8_t padding[7] = {};
  };
  NodeStatus tick_node(int node, TreeHost* host);
  NodeStatus run(int node, TreeHost* host);
  NodeStatus run_list(int node, TreeHost* host);
  NodeStatus run_parallel(int node, TreeHost* host);
  NodeStatus run_decorator(int node, TreeHost* host);
  NodeStatus run_leaf(int node, TreeHost* host);
  void halt(int node);
  void halt_children(int node);

  std::shared_ptr<const BehaviorTree> tree_;
  std::vector<Memory> memory_;  // by node
};

/// Reads BehaviorTree.CPP's XML, format 4. SubTrees are put in place, with their ports. Errors,
/// with file and line: not XML; a node, port or value that there is not; SubTrees that hold
/// themselves; more than 64 nodes in each other, 4096 in all.
Result<std::shared_ptr<const BehaviorTree>> read_behavior_tree(const std::string& text,
                                                               const std::string& file);
Result<std::shared_ptr<const BehaviorTree>> read_behavior_tree_file(
    const std::filesystem::path& file);

}  // namespace gloam
