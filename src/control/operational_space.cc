#include "control/operational_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "control/frame_dynamics.h"
#include "control/task_frame.h"

namespace gloam {
namespace {

using ik::MatrixXd;
using ik::Vector3d;
using ik::VectorXd;
// A task has up to 6 rows: position, then orientation, world axes.
using TaskVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using TaskMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

// Directions whose inverse effective mass is below this share of the largest are singular.
constexpr double kSingularShare = 1e-5;

Vector3d rotation_between(const Eigen::Matrix3d& R_goal, const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(R_goal * R.transpose()));
  return turn.angle() * turn.axis();
}

// The inverse of a positive semidefinite matrix, continuous where directions become singular.
TaskMatrix bounded_inverse(const TaskMatrix& A) {
  const Eigen::SelfAdjointEigenSolver<TaskMatrix> eigen(A);
  const TaskVector& values = eigen.eigenvalues();
  const double least = std::max(kSingularShare * values.maxCoeff(), 1e-12);
  TaskVector inverse(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
    inverse[i] = values[i] >= least ? 1 / values[i] : std::max(values[i], 0.0) / (least * least);
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

class OperationalSpaceController final : public Controller {
 public:
  OperationalSpaceController(const mjModel& model, const RobotInstance& robot, TaskFrame task)
      : options_(robot.options.controller.task),
        task_(std::move(task)),
        now_(model, task_.frame, task_.dofs) {
    first_row_ = options_.position_stiffness > 0 ? 0 : 3;
    rows_ =
        (options_.position_stiffness > 0 ? 3 : 0) + (options_.orientation_stiffness > 0 ? 3 : 0);
    const auto n = static_cast<Eigen::Index>(task_.dofs.size());
    posture_.setZero(n);
    factor_.setZero(n, n);
    by_mass_.setZero(n, 6);
    acceleration_.setZero(n);
    torque_.setZero(n);
    rest_.setZero(n);
  }

  void reset(const mjModel* model, const mjData* data) override {
    for (size_t i = 0; i < task_.joints.size(); ++i)
      posture_[static_cast<Eigen::Index>(i)] = data->qpos[task_.joints[i].qpos];
    now_.update(*model, *data);
    goal_ = to_pose(now_.X_WF);
  }

  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const OperationalSpaceController*>(&before);
    if (old == nullptr || old->options_.frame != options_.frame) return;
    goal_ = old->goal_;
    if (old->posture_.size() == posture_.size()) posture_ = old->posture_;
  }

  void control(const ControlInputs& in) override {
    if (in.pose_goal != nullptr) goal_ = *in.pose_goal;
    now_.update(*in.model, *in.data);
    factor_ = now_.M;
    const Eigen::LLT<Eigen::Ref<MatrixXd>> inertia(factor_);
    if (inertia.info() != Eigen::Success) return;  // the state is not finite: the run ends
    fill_posture_torque(*in.data);
    torque_ = rest_ + now_.bias;
    if (rows_ > 0) add_task_torque(inertia);
    for (size_t i = 0; i < task_.joints.size(); ++i) {
      const DrivenJoint& joint = task_.joints[i];
      in.data->ctrl[joint.ctrl] = control_of_torque(joint, torque_[static_cast<Eigen::Index>(i)]);
    }
  }

  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<OperationalSpaceController>(*this);
  }

 private:
  // τ₀
  void fill_posture_torque(const mjData& data) {
    const double k = options_.posture_stiffness, c = 2 * options_.damping_ratio * std::sqrt(k);
    for (size_t i = 0; i < task_.joints.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const DrivenJoint& joint = task_.joints[i];
      acceleration_[row] = k * (posture_[row] - data.qpos[joint.qpos]) - c * data.qvel[joint.dof];
    }
    rest_ = now_.M.lazyProduct(acceleration_);
  }

  TaskVector desired_acceleration() const {
    const ik::Transform goal = ik::to_transform(goal_);
    Eigen::Matrix<double, 6, 1> error, k;
    error << goal.p - now_.X_WF.p, rotation_between(goal.R, now_.X_WF.R);
    k << Vector3d::Constant(options_.position_stiffness),
        Vector3d::Constant(options_.orientation_stiffness);
    const Eigen::Matrix<double, 6, 1> a =
        k.cwiseProduct(error) -
        2 * options_.damping_ratio * k.cwiseSqrt().cwiseProduct(now_.velocity) - now_.drift;
    return a.segment(first_row_, rows_);
  }

  // Jᵀ Λ (a_d - J̇ v - J M⁻¹ τ₀)
  template <class Factor>
  void add_task_torque(const Factor& inertia) {
    const auto J = now_.J.middleRows(first_row_, rows_);
    auto by_mass = by_mass_.leftCols(rows_);  // M⁻¹ Jᵀ
    by_mass = J.transpose();
    inertia.solveInPlace(by_mass);
    const TaskMatrix mobility = J.lazyProduct(by_mass);
    const TaskVector a = desired_acceleration() - by_mass.transpose().lazyProduct(rest_);
    const TaskVector force = bounded_inverse(mobility).lazyProduct(a);
    torque_ += J.transpose().lazyProduct(force);
  }

  TaskSpaceOptions options_;
  TaskFrame task_;
  FrameDynamics now_;
  int first_row_ = 0, rows_ = 6;  // of the task, in now_.J
  VectorXd posture_;              // q₀ [rad or m]
  Pose goal_;                     // X_WF
  MatrixXd factor_, by_mass_;     // (n x n), (n x 6)
  VectorXd acceleration_;         // (n)
  VectorXd torque_, rest_;        // τ, τ₀ [N m or N]
};

// Errors unless every joint between the frame and the world has a motor.
Status check_motors(const mjModel& model, const RobotInstance& robot, const TaskFrame& task) {
  for (int body = task.frame.body(model); body > 0; body = model.body_parentid[body]) {
    for (int i = 0; i < model.body_jntnum[body]; ++i) {
      const int joint = model.body_jntadr[body] + i;
      const auto row = std::ranges::find(task.joints, joint, &DrivenJoint::joint);
      if (row != task.joints.end() && !row->takes_target) continue;
      const char* const name = mj_id2name(&model, mjOBJ_JOINT, joint);
      const char* const problem = row != task.joints.end() ? "is driven by a position servo"
                                  : model.jnt_type[joint] == mjJNT_FREE ? "is free"
                                                                        : "has no motor";
      return controller_error(
          robot,
          fmt::format("joint '{}' {}", name != nullptr ? name : std::to_string(joint), problem),
          "every joint between the frame and the world needs a <motor>; servos can use 'ik'");
    }
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<Controller>> make_operational_space_controller(const CompiledWorld& world,
                                                                      const RobotInstance& robot) {
  const mjModel& model = *world.model;
  GLOAM_TRY(TaskFrame task, find_task_frame(model, robot));
  GLOAM_TRY_STATUS(check_motors(model, robot, task));
  return std::unique_ptr<Controller>(
      std::make_unique<OperationalSpaceController>(model, robot, std::move(task)));
}

}  // namespace gloam
