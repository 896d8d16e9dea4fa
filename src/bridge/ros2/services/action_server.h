#pragma once
// ActionServer: goals of one action: accepted, run one at a time on a thread of their own, told of,
// cancelled, and their results kept for those who ask later. Free of DDS and of the action's type:
// messages are CDR. The protocol is that of rcl_action (design.ros2.org, "Actions").

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "bridge/ros2/ros2_action.h"
#include "ros/messages/action_msgs.h"

namespace gloam::bridge {

using GoalId = std::array<uint8_t, 16>;

/// A running goal, as its work sees it.
class GoalContext {
 public:
  virtual ~GoalContext() = default;
  /// Asked to end: by its client, by a newer goal, or since the server ends.
  virtual bool is_cancelled() const = 0;
  /// A newer goal is why.
  virtual bool is_replaced() const = 0;
  /// Publishes a FeedbackMessage as CDR.
  virtual void feedback(std::span<const uint8_t> message) = 0;
  virtual const GoalId& id() const = 0;
};

/// End of a goal.
struct GoalEnd {
  int8_t status = action_msgs::GoalStatus::STATUS_SUCCEEDED;
  std::vector<uint8_t> response;  ///< GetResult_Response with that status
};

/// A goal that was read.
struct GoalRequest {
  GoalId id = {};
  std::function<GoalEnd(GoalContext&)> run = {};  ///< empty, without an end too: it is refused
  /// It is accepted and has ended so at once; goals that run go on.
  std::optional<GoalEnd> end = {};
};

/// Rule for a goal that comes while another runs.
enum class GoalPolicy : uint8_t {
  kRefuse,
  kReplace,  ///< the old one is asked to end
};

struct ActionOptions {
  std::string name, type;  ///< as of Ros2Action
  GoalPolicy policy = GoalPolicy::kRefuse;
  std::function<double()> clock;  ///< simulation time [s]
  /// Reads a SendGoal_Request. Error: it is damaged.
  std::function<Result<GoalRequest>(std::span<const uint8_t>)> accept;
  std::vector<uint8_t> unknown;  ///< GetResult_Response for a goal that there is not
  std::string send_goal_hash = {}, get_result_hash = {};  ///< of the services' types
};

class ActionServer {
 public:
  ActionServer(ActionOptions options, Ros2Publish publish);
  /// Cancels what runs and waits for it.
  ~ActionServer();
  ActionServer(const ActionServer&) = delete;
  ActionServer& operator=(const ActionServer&) = delete;

  Result<std::vector<uint8_t>> send_goal(std::span<const uint8_t> request);
  Result<std::vector<uint8_t>> cancel_goal(std::span<const uint8_t> request);
  using Reply = std::function<void(std::vector<uint8_t>)>;
  void get_result(std::span<const uint8_t> request, const Reply& reply);

 private:
  struct Goal;
  class Context;
  using Goals = std::map<GoalId, std::shared_ptr<Goal>>;

  void run();
  void run_goal(const std::shared_ptr<Goal>& goal);
  void tell_status();  // under mutex_
  void forget_old();   // under mutex_
  bool is_busy() const;

  const ActionOptions options_;
  const Ros2Publish publish_;
  std::mutex mutex_;
  std::condition_variable came_;
  Goals goals_;
  std::deque<std::shared_ptr<Goal>> waiting_;
  std::deque<GoalId> ended_;  // oldest first
  bool stopping_ = false;
  std::thread thread_;
};

/// The server with its services and topics.
Ros2Action make_action(ActionOptions options, Ros2Publish publish);

}  // namespace gloam::bridge
