#include "control/torque.h"

#include <fmt/format.h>

#include <algorithm>

#include "control/robot_joints.h"

namespace gloam {
namespace {

class TorqueController final : public Controller {
 public:
  TorqueController(std::vector<DrivenJoint> motors, const std::vector<double>& torques)
      : motors_(std::move(motors)), controls_(motors_.size()) {
    for (size_t i = 0; i < torques.size(); ++i)
      controls_[i] = control_of_torque(motors_[i], torques[i]);
  }

  void reset(const mjModel*, const mjData*) override { started_ = false; }

  void take_over(const mjModel*, const mjData*, const Controller& before) override {
    const auto* old = dynamic_cast<const TorqueController*>(&before);
    started_ = old != nullptr && old->started_ && old->controls_ == controls_;
  }

  void control(const ControlInputs& in) override {
    mjData* const data = in.data;
    if (started_) return;
    started_ = true;
    for (size_t i = 0; i < motors_.size(); ++i) data->ctrl[motors_[i].ctrl] = controls_[i];
  }
  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<TorqueController>(*this);
  }

 private:
  std::vector<DrivenJoint> motors_;
  std::vector<double> controls_;
  bool started_ = false;
};

}  // namespace

Result<std::unique_ptr<Controller>> make_torque_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  std::vector<DrivenJoint> motors = driven_joints(*world.model, robot);
  std::erase_if(motors, [](const DrivenJoint& j) { return j.takes_target || j.gear == 0; });
  if (motors.empty()) {
    return Error{
        ErrorKind::kInput,
        fmt::format(
            "robot '{}' has no motor on a joint, so controller 'torque' has nothing to control",
            robot.name),
        options.loc, "add <motor> actuators to its model"};
  }
  if (!options.target.empty() && options.target.size() != motors.size()) {
    return Error{ErrorKind::kInput,
                 fmt::format("'target' has {} values, but robot '{}' has {} motors",
                             options.target.size(), robot.name, motors.size()),
                 options.loc, "set one torque per motor, in the model's order"};
  }
  return std::unique_ptr<Controller>(
      std::make_unique<TorqueController>(std::move(motors), options.target));
}

}  // namespace gloam
