#include "control/drive/diff_drive.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "control/drive/wheels.h"

namespace gloam {
namespace {

double approach(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

// The PI loop of a motor: its bandwidth with the base's mass on the wheels, and the rate of its
// integral [1/s].
constexpr double kBandwidth = 20, kIntegralRate = 5;
// Explicit damping of a lifted wheel is stable below 2 inertias a period.
constexpr double kMostDamping = 0.5;

/// A wheel with the integral of its speed error [rad].
struct DrivenWheel {
  Wheel wheel;
  double damping = 0;  // of a motor: torque per speed error [N m s/rad]
  double integral = 0;
};

std::vector<DrivenWheel> with_loops(const std::vector<Wheel>& wheels, double inertia,
                                    double period) {
  std::vector<DrivenWheel> all;
  for (const Wheel& wheel : wheels) {
    all.push_back({wheel, std::min(kBandwidth * (wheel.inertia + inertia),
                                   kMostDamping * wheel.inertia / period)});
  }
  return all;
}

class DiffDriveController final : public Controller {
 public:
  DiffDriveController(const WheeledBase& base, const DriveOptions& options, double period)
      : radius_(base.radius), track_(base.track), options_(options) {
    const auto count = static_cast<double>(base.left.size() + base.right.size());
    const double inertia = base.mass * base.radius * base.radius / count;
    left_ = with_loops(base.left, inertia, period);
    right_ = with_loops(base.right, inertia, period);
  }

  void reset(const mjModel*, const mjData*) override {
    speed_ = yaw_rate_ = 0;
    for (DrivenWheel& row : left_) row.integral = 0;
    for (DrivenWheel& row : right_) row.integral = 0;
  }

  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const DiffDriveController*>(&before);
    if (old == nullptr) return;
    speed_ = old->speed_;
    yaw_rate_ = old->yaw_rate_;
    take_integrals(old->left_, &left_);
    take_integrals(old->right_, &right_);
  }

  void control(const ControlInputs& in) override {
    const DriveOptions& o = options_;
    const double vx = std::clamp(in.goal.vx, -o.max_speed, o.max_speed);
    const double turn = std::clamp(in.goal.yaw_rate, -o.max_yaw_rate, o.max_yaw_rate);
    speed_ = approach(speed_, vx, o.max_acceleration * in.period);
    yaw_rate_ = approach(yaw_rate_, turn, o.max_yaw_acceleration * in.period);
    const double difference = yaw_rate_ * track_ / 2;
    drive((speed_ - difference) / radius_, in, &left_);
    drive((speed_ + difference) / radius_, in, &right_);
  }

  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<DiffDriveController>(*this);
  }

 private:
  static void take_integrals(const std::vector<DrivenWheel>& from, std::vector<DrivenWheel>* to) {
    if (from.size() != to->size()) return;
    for (size_t i = 0; i < from.size(); ++i) (*to)[i].integral = from[i].integral;
  }

  static void drive(double speed, const ControlInputs& in, std::vector<DrivenWheel>* wheels) {
    for (DrivenWheel& row : *wheels) {
      const Wheel& wheel = row.wheel;
      const double wanted = wheel.turn * speed;
      double control = wheel.gear * wanted;
      if (!wheel.takes_speed) {
        const double error = wanted - in.data->qvel[wheel.dof];
        const double integral = row.integral + error * in.period;
        const double torque = row.damping * (error + kIntegralRate * integral);
        control = torque / (wheel.gear * wheel.gain);
        if (control >= wheel.lowest && control <= wheel.highest) row.integral = integral;
      }
      in.data->ctrl[wheel.ctrl] = std::clamp(control, wheel.lowest, wheel.highest);
    }
  }

  double radius_, track_;  // [m]
  std::vector<DrivenWheel> left_, right_;
  DriveOptions options_;
  double speed_ = 0, yaw_rate_ = 0;  // [m/s], [rad/s]
};

}  // namespace

Result<std::unique_ptr<Controller>> make_diff_drive_controller(const CompiledWorld& world,
                                                               const RobotInstance& robot) {
  GLOAM_TRY(const WheeledBase base, find_wheels(*world.model, robot));
  const ControllerOptions& options = robot.options.controller;
  return std::unique_ptr<Controller>(
      std::make_unique<DiffDriveController>(base, options.drive, 1 / options.rate.value()));
}

Result<RobotGoals> diff_drive_goals(const CompiledWorld&, const RobotInstance& robot) {
  const DriveOptions& o = robot.options.controller.drive;
  return RobotGoals{.velocity =
                        VelocityRanges{VelocityRange::within(o.max_speed), VelocityRange::within(0),
                                       VelocityRange::within(o.max_yaw_rate)}};
}

}  // namespace gloam
