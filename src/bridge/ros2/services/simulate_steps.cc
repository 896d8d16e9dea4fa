// The action SimulateSteps.

#include <limits>

#include "bridge/ros2/services/action_server.h"
#include "bridge/ros2/services/actions.h"
#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/typed_service.h"
#include "ros/codec.h"
#include "ros/messages/simulation_interfaces.h"
#include "ros/type_description.h"

namespace gloam::bridge {
namespace {

namespace steps_action = simulation_interfaces::action;
using StepStatus = action_msgs::GoalStatus;

GoalEnd steps_end(int8_t status, simulation_interfaces::Result result) {
  steps_action::SimulateSteps_GetResult_Response response;
  response.status = status;
  response.result.result = std::move(result);
  GoalEnd end{.status = status};
  encode(response, &end.response);
  return end;
}

GoalEnd run_steps(Operator& operations, uint64_t steps, GoalContext& context) {
  steps_action::SimulateSteps_FeedbackMessage feedback;
  feedback.goal_id.uuid = context.id();
  std::vector<uint8_t> bytes;
  const Status status =
      operations.step(static_cast<int64_t>(steps), [&](int64_t done, int64_t left) {
        feedback.feedback.completed_steps = static_cast<uint64_t>(done);
        feedback.feedback.remaining_steps = static_cast<uint64_t>(left);
        encode(feedback, &bytes);
        context.feedback(bytes);
        return !context.is_cancelled();
      });
  using Code = simulation_interfaces::Result;
  if (status.ok()) return steps_end(StepStatus::STATUS_SUCCEEDED, result_ok());
  const auto result = result_of(Code::RESULT_OPERATION_FAILED, status.error().to_string());
  return steps_end(
      context.is_cancelled() ? StepStatus::STATUS_CANCELED : StepStatus::STATUS_ABORTED, result);
}

}  // namespace

Ros2Action simulate_steps_action(Operator& operations, const std::string& ns, Ros2Publish publish) {
  Operator* const op = &operations;
  ActionOptions options;
  options.name = ns + "/simulate_steps";
  options.type = "simulation_interfaces/action/SimulateSteps";
  options.send_goal_hash = service_hash_of<steps_action::SimulateSteps_SendGoal_Request,
                                           steps_action::SimulateSteps_SendGoal_Response>();
  options.get_result_hash = service_hash_of<steps_action::SimulateSteps_GetResult_Request,
                                            steps_action::SimulateSteps_GetResult_Response>();
  options.clock = [op] { return op->simulation().latest().time(); };
  options.unknown = steps_end(StepStatus::STATUS_UNKNOWN, result_ok()).response;
  options.accept = [op](std::span<const uint8_t> bytes) -> Result<GoalRequest> {
    GLOAM_TRY(const auto request, decode<steps_action::SimulateSteps_SendGoal_Request>(bytes));
    GoalRequest goal{.id = request.goal_id.uuid};
    const uint64_t steps = request.goal.steps;
    if (steps >= 1 && steps <= static_cast<uint64_t>(std::numeric_limits<int64_t>::max() / 2))
      goal.run = [op, steps](GoalContext& context) { return run_steps(*op, steps, context); };
    return goal;
  };
  return make_action(std::move(options), std::move(publish));
}

}  // namespace gloam::bridge
