#include "bridge/ros2/services/action_server.h"

#include <algorithm>
#include <atomic>

#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/typed_service.h"
#include "ros/messages/simulation_interfaces.h"

namespace gloam::bridge {
namespace {

using action_msgs::GoalStatus;
using CancelRequest = action_msgs::srv::CancelGoal_Request;
using CancelResponse = action_msgs::srv::CancelGoal_Response;
// Messages that have the same bytes for every action.
using AnySendGoalResponse = simulation_interfaces::action::SimulateSteps_SendGoal_Response;
using AnyGetResultRequest = simulation_interfaces::action::SimulateSteps_GetResult_Request;

constexpr size_t kMostEnded = 64, kMostReplies = 64;

bool is_end(int8_t status) { return status >= GoalStatus::STATUS_SUCCEEDED; }

int64_t nanoseconds(const builtin_interfaces::Time& time) {
  return int64_t{time.sec} * 1'000'000'000 + time.nanosec;
}

}  // namespace

struct ActionServer::Goal {
  GoalRequest request;
  builtin_interfaces::Time stamp;
  int8_t status = GoalStatus::STATUS_ACCEPTED;  // with what follows under the server's mutex
  std::vector<uint8_t> response;
  std::vector<Reply> replies;
  std::atomic<bool> cancelled{false}, replaced{false};
};

class ActionServer::Context final : public GoalContext {
 public:
  Context(ActionServer& server, Goal& goal) : server_(server), goal_(goal) {}
  bool is_cancelled() const override { return goal_.cancelled; }
  bool is_replaced() const override { return goal_.replaced; }
  void feedback(std::span<const uint8_t> message) override {
    server_.publish_(server_.options_.name + "/_action/feedback", message);
  }
  const GoalId& id() const override { return goal_.request.id; }

 private:
  ActionServer& server_;
  Goal& goal_;
};

ActionServer::ActionServer(ActionOptions options, Ros2Publish publish)
    : options_(std::move(options)), publish_(std::move(publish)), thread_([this] { run(); }) {}

ActionServer::~ActionServer() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    waiting_.clear();
    for (const auto& [id, goal] : goals_) goal->cancelled = true;
  }
  came_.notify_all();
  thread_.join();
}

bool ActionServer::is_busy() const {
  return std::ranges::any_of(goals_,
                             [](const auto& entry) { return !is_end(entry.second->status); });
}

Result<std::vector<uint8_t>> ActionServer::send_goal(std::span<const uint8_t> bytes) {
  GLOAM_TRY(GoalRequest request, options_.accept(bytes));
  AnySendGoalResponse response;
  response.stamp = ros_time_of(options_.clock());
  const std::lock_guard lock(mutex_);
  const bool has_ended = request.end.has_value();
  const bool refused = (!request.run && !has_ended) || stopping_ || goals_.contains(request.id) ||
                       (!has_ended && options_.policy == GoalPolicy::kRefuse && is_busy());
  if (!refused && has_ended) {
    const auto goal = std::make_shared<Goal>();
    goal->stamp = response.stamp;
    goal->status = request.end->status;
    goal->response = request.end->response;
    goal->request.id = request.id;
    goals_.emplace(request.id, goal);
    ended_.push_back(request.id);
    response.accepted = true;
    tell_status();
    forget_old();
  } else if (!refused) {
    for (const auto& [id, goal] : goals_) {
      if (is_end(goal->status)) continue;
      goal->replaced = goal->cancelled = true;
    }
    const auto goal = std::make_shared<Goal>();
    goal->stamp = response.stamp;
    goal->request = std::move(request);
    goals_.emplace(goal->request.id, goal);
    waiting_.push_back(goal);
    response.accepted = true;
    tell_status();
    came_.notify_all();
  }
  std::vector<uint8_t> answer;
  encode(response, &answer);
  return answer;
}

Result<std::vector<uint8_t>> ActionServer::cancel_goal(std::span<const uint8_t> bytes) {
  GLOAM_TRY(const CancelRequest request, decode<CancelRequest>(bytes));
  const GoalId& id = request.goal_info.goal_id.uuid;
  const int64_t until = nanoseconds(request.goal_info.stamp);
  const bool has_id = id != GoalId{};
  CancelResponse response;
  const std::lock_guard lock(mutex_);
  const auto named = goals_.find(id);
  if (has_id && named == goals_.end()) {
    response.return_code = CancelResponse::ERROR_UNKNOWN_GOAL_ID;
  } else if (has_id && is_end(named->second->status)) {
    response.return_code = CancelResponse::ERROR_GOAL_TERMINATED;
  }
  for (const auto& [other, goal] : goals_) {
    const bool is_old = until != 0 && nanoseconds(goal->stamp) <= until;
    const bool is_meant = (has_id && other == id) || is_old || (!has_id && until == 0);
    if (!is_meant || is_end(goal->status)) continue;
    goal->cancelled = true;
    goal->status = GoalStatus::STATUS_CANCELING;
    response.goals_canceling.push_back({{other}, goal->stamp});
  }
  if (!response.goals_canceling.empty()) {
    response.return_code = CancelResponse::ERROR_NONE;
    tell_status();
  }
  std::vector<uint8_t> answer;
  encode(response, &answer);
  return answer;
}

void ActionServer::get_result(std::span<const uint8_t> bytes, const Reply& reply) {
  const Result<AnyGetResultRequest> request = decode<AnyGetResultRequest>(bytes);
  if (!request.ok()) return;
  std::vector<uint8_t> answer = options_.unknown;
  {
    const std::lock_guard lock(mutex_);
    const auto found = goals_.find(request->goal_id.uuid);
    if (found != goals_.end()) {
      Goal& goal = *found->second;
      if (!is_end(goal.status)) {
        if (goal.replies.size() < kMostReplies) goal.replies.push_back(reply);
        return;
      }
      answer = goal.response;
    }
  }
  reply(std::move(answer));
}

void ActionServer::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    came_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    const std::shared_ptr<Goal> goal = std::move(waiting_.front());
    waiting_.pop_front();
    if (goal->status == GoalStatus::STATUS_ACCEPTED) goal->status = GoalStatus::STATUS_EXECUTING;
    tell_status();
    lock.unlock();
    run_goal(goal);
    lock.lock();
  }
}

void ActionServer::run_goal(const std::shared_ptr<Goal>& goal) {
  Context context(*this, *goal);
  GoalEnd end = goal->request.run(context);
  std::vector<Reply> replies;
  {
    const std::lock_guard lock(mutex_);
    goal->status = end.status;
    goal->response = end.response;
    goal->request.run = {};
    std::swap(replies, goal->replies);
    ended_.push_back(goal->request.id);
    tell_status();
    forget_old();
  }
  for (const Reply& reply : replies) reply(end.response);
}

void ActionServer::tell_status() {
  action_msgs::GoalStatusArray message;
  for (const auto& [id, goal] : goals_)
    message.status_list.push_back({{{id}, goal->stamp}, goal->status});
  std::vector<uint8_t> bytes;
  encode(message, &bytes);
  publish_(options_.name + "/_action/status", bytes);
}

void ActionServer::forget_old() {
  while (ended_.size() > kMostEnded) {
    goals_.erase(ended_.front());
    ended_.pop_front();
  }
}

Ros2Action make_action(ActionOptions options, Ros2Publish publish) {
  Ros2Action action{.name = options.name, .type = options.type};
  const std::string send_goal_hash = options.send_goal_hash;
  const std::string get_result_hash = options.get_result_hash;
  const std::string base = options.name + "/_action/", type = options.type;
  const auto server = std::make_shared<ActionServer>(std::move(options), std::move(publish));
  action.services.push_back(
      {.name = base + "send_goal",
       .type = type + "_SendGoal",
       .answer = [server](std::span<const uint8_t> bytes) { return server->send_goal(bytes); },
       .hash = send_goal_hash});
  action.services.push_back(
      {.name = base + "cancel_goal",
       .type = service_type<CancelRequest>(),
       .answer = [server](std::span<const uint8_t> bytes) { return server->cancel_goal(bytes); },
       .hash = service_hash_of<CancelRequest, CancelResponse>()});
  action.services.push_back(
      {.name = base + "get_result",
       .type = type + "_GetResult",
       .answer_later = [server](
                           std::span<const uint8_t> bytes,
                           const ActionServer::Reply& reply) { server->get_result(bytes, reply); },
       .hash = get_result_hash});
  action.topics.push_back({.name = base + "feedback", .type = type + "_FeedbackMessage"});
  action.topics.push_back({.name = base + "status",
                           .type = ros_type_name<action_msgs::GoalStatusArray>(),
                           .qos = {.is_reliable = true, .is_latched = true, .depth = 1}});
  action.server = server;
  return action;
}

}  // namespace gloam::bridge
