#include "control/flight/quadrotor.h"

#include <mujoco/mujoco.h>

#include <cmath>

#include "control/flight/flight_cascade.h"
#include "control/flight/flight_path.h"
#include "control/flight/mixer.h"

namespace gloam {
namespace {

using Eigen::Vector3d;

FlightState state_of(const Multirotor& vehicle, const mjData& data) {
  const mjtNum* q = data.qpos + vehicle.qpos;
  const mjtNum* v = data.qvel + vehicle.dof;
  return {{q[0], q[1], q[2]},
          {v[0], v[1], v[2]},
          Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized(),
          {v[3], v[4], v[5]}};  // MuJoCo keeps a free joint's angular velocity in its own frame
}

double yaw_of(const FlightState& state) {
  const Eigen::Matrix3d R = state.q_WB.toRotationMatrix();
  return std::atan2(R(1, 0), R(0, 0));
}

class QuadrotorController final : public Controller {
 public:
  QuadrotorController(Multirotor vehicle, const FlightOptions& options, double gravity)
      : vehicle_(std::move(vehicle)),
        path_(options),
        cascade_(options, vehicle_, gravity),
        mixer_(vehicle_) {}

  void reset(const mjModel*, const mjData* data) override {
    const FlightState state = state_of(vehicle_, *data);
    path_.reset(state.p_WB, yaw_of(state));
    cascade_.reset();
    saturated_ = false;
  }

  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const QuadrotorController*>(&before);
    if (old == nullptr) return;
    path_.continue_from(old->path_);
    cascade_.continue_from(old->cascade_);
    saturated_ = old->saturated_;
  }

  void control(const ControlInputs& in) override {
    const FlightState state = state_of(vehicle_, *in.data);
    path_.update(in.goal, state.p_WB, in.period);
    const FlightWrench wrench = cascade_.update(state, path_.setpoint(), in.period, saturated_);
    mixer_.mix(wrench, in.data->ctrl);
    saturated_ = mixer_.saturated();
  }

  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<QuadrotorController>(*this);
  }

 private:
  Multirotor vehicle_;
  FlightPath path_;
  FlightCascade cascade_;
  RotorMixer mixer_;
  bool saturated_ = false;
};

}  // namespace

Result<std::unique_ptr<Controller>> make_quadrotor_controller(const CompiledWorld& world,
                                                              const RobotInstance& robot) {
  GLOAM_TRY(Multirotor vehicle, find_multirotor(*world.model, robot));
  const Vector3d gravity(world.model->opt.gravity[0], world.model->opt.gravity[1],
                         world.model->opt.gravity[2]);
  return std::unique_ptr<Controller>(std::make_unique<QuadrotorController>(
      std::move(vehicle), robot.options.controller.flight, gravity.norm()));
}

Result<RobotGoals> quadrotor_goals(const CompiledWorld&, const RobotInstance& robot) {
  const FlightOptions& o = robot.options.controller.flight;
  const VelocityRange level = VelocityRange::within(o.max_speed);
  return RobotGoals{.velocity = VelocityRanges{level, level, VelocityRange::within(o.max_yaw_rate),
                                               VelocityRange::within(o.max_climb)}};
}

}  // namespace gloam
