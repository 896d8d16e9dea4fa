#include "control/inverse_kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/log.h"
#include "control/ik/program.h"
#include "control/task_frame.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

constexpr size_t kFrame = 0, kPosture = 1;  // tasks
constexpr int kNearPairs = 32;              // pairs of geoms that are kept apart at a time
// Divided by the gain: Levenberg-Marquardt damping per squared weighted error. Far from a goal it
// replaces the second derivatives that the program lacks; without it, a stretched arm of the size
// of assets/robots/arm jumps to and fro in front of a goal that is out of reach.
constexpr double kLargeErrorDamping = 5;
// A goal is out of reach if joints are slower than this [rad/s, m/s] while its weighted error is
// larger than this [-].
constexpr double kRestVelocity = 1e-3, kReachedError = 0.01;

class InverseKinematicsController final : public Controller {
 public:
  InverseKinematicsController(const RobotInstance& robot, TaskFrame task, ik::Program program)
      : name_(robot.name),
        options_(robot.options.controller),
        task_(std::move(task)),
        program_(std::move(program)),
        desired_(task_.joints.size()) {
    qpos_.resize(static_cast<size_t>(program_.kinematics().model().nq));
  }

  void reset(const mjModel*, const mjData* data) override {
    for (size_t i = 0; i < desired_.size(); ++i)
      desired_[i] = within_range(i, data->qpos[task_.joints[i].qpos]);
    fill(*data);
    program_.kinematics().update(qpos_.data());
    goal_ = to_pose(program_.kinematics().pose(task_.frame));
    posture_ = desired_;
    set_posture();
  }

  // Joints keep their desired positions and posture, and the frame its goal: all sag under load.
  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const InverseKinematicsController*>(&before);
    if (old == nullptr || old->options_.task.frame != options_.task.frame) return;
    for (size_t i = 0; i < desired_.size(); ++i)
      for (size_t j = 0; j < old->desired_.size(); ++j)
        if (task_.joints[i].name == old->task_.joints[j].name && !task_.joints[i].name.empty()) {
          desired_[i] = within_range(i, old->desired_[j]);
          posture_[i] = old->posture_[j];
        }
    goal_ = old->goal_;
    set_posture();
  }

  void control(const ControlInputs& in) override {
    if (in.pose_goal != nullptr && !(*in.pose_goal == goal_)) {
      goal_ = *in.pose_goal;
      has_warned_ = false;
    }
    fill(*in.data);
    const bool has_target = program_.set_target(kFrame, goal_).ok();
    const ik::SolutionStatus status =
        has_target ? program_.solve(qpos_.data(), in.period) : ik::SolutionStatus::kSingular;
    const bool solved = status == ik::SolutionStatus::kSolved;
    if (solved) watch_progress(in.period);
    if (!solved) warn("no joint velocities satisfy its limits; the joints stay where they are");
    for (size_t i = 0; i < desired_.size(); ++i) {
      const DrivenJoint& joint = task_.joints[i];
      const double step = solved ? program_.x()[static_cast<Eigen::Index>(i)] : 0;
      desired_[i] = within_range(i, desired_[i] + step);
      in.data->ctrl[joint.ctrl] = control_of_position(joint, *in.data, desired_[i],
                                                      step / in.period, options_.kp, options_.kd);
    }
  }

  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<InverseKinematicsController>(*this);
  }

 private:
  double within_range(size_t i, double q) const {
    const mjModel& model = program_.kinematics().model();
    const int joint = task_.joints[i].joint;
    if (!model.jnt_limited[joint]) return q;
    return std::clamp(q, model.jnt_range[2 * joint], model.jnt_range[2 * joint + 1]);
  }

  // The measured configuration with the desired positions of the joints that move the frame.
  void fill(const mjData& data) {
    std::copy_n(data.qpos, qpos_.size(), qpos_.begin());
    for (size_t i = 0; i < desired_.size(); ++i)
      qpos_[static_cast<size_t>(task_.joints[i].qpos)] = desired_[i];
    program_.kinematics().set_mocap(data);
  }

  // After fill(): only the joints that move the frame count.
  void set_posture() {
    for (size_t i = 0; i < posture_.size(); ++i)
      qpos_[static_cast<size_t>(task_.joints[i].qpos)] = posture_[i];
    has_warned_ = !program_.set_target(kPosture, qpos_).ok();
  }

  void watch_progress(double period) {
    const std::span<const double> e = program_.error(kFrame);
    const double position = std::hypot(e[0], e[1], e[2]), angle = std::hypot(e[3], e[4], e[5]);
    const double error =
        options_.task.position_cost * position + options_.task.orientation_cost * angle;
    if (has_warned_ || error < kReachedError ||
        program_.x().cwiseAbs().maxCoeff() > kRestVelocity * period) {
      return;
    }
    warn(fmt::format("the goal is out of reach: {:.3f} m and {:.3f} rad remain", position, angle));
  }

  // Once for each goal: the only place where control() allocates.
  void warn(std::string_view problem) {
    if (!std::exchange(has_warned_, true))
      log_warning("controller 'ik' of robot '{}': {}", name_, problem);
  }

  std::string name_;
  ControllerOptions options_;
  TaskFrame task_;
  ik::Program program_;
  std::vector<double> desired_;  // positions of task_.joints [rad or m]
  std::vector<double> posture_;  // their positions at the start [rad or m]
  std::vector<double> qpos_;     // (nq)
  Pose goal_;                    // X_WF
  bool has_warned_ = false;
};

// Pairs of the moving parts of a robot with every other geom, without those that MuJoCo excludes
// and those that penetrate each other from the start, which a limit could never separate.
ik::GeomPairs pairs_to_separate(const CompiledWorld& world, const std::vector<int>& dofs,
                                ik::Kinematics& at) {
  const mjModel& model = *world.model;
  std::set<std::pair<int, int>> excluded;
  for (int i = 0; i < model.nexclude; ++i)
    excluded.insert(
        std::minmax(model.exclude_signature[i] >> 16, model.exclude_signature[i] & 0xffff));
  const auto moves = [&](int geom) {
    return std::ranges::any_of(dofs, [&](int dof) {
      return is_part_of(model, model.geom_bodyid[geom], model.dof_bodyid[dof]);
    });
  };
  at.update(world.initial_key >= 0 ? model.key_qpos + world.initial_key * model.nq : model.qpos0);
  ik::GeomPairs pairs;
  for (int a = 0; a < model.ngeom; ++a) {
    const bool a_moves = moves(a);
    for (int b = a + 1; b < model.ngeom; ++b) {
      const int body_a = model.geom_bodyid[a], body_b = model.geom_bodyid[b];
      if ((!a_moves && !moves(b)) || !ik::may_collide(model, a, b) ||
          excluded.contains(std::minmax(body_a, body_b)) ||
          mj_geomDistance(&model, &at.data(), a, b, 0.001, nullptr) <= 0) {
        continue;
      }
      pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

ik::Problem problem_of(const ControllerOptions& options, const TaskFrame& task) {
  const TaskSpaceOptions& o = options.task;
  const double period = 1 / options.rate.value();
  const double gain = o.time_constant > period ? -std::expm1(-period / o.time_constant) : 1;
  ik::Problem problem;
  problem.damping = 1e-4;
  problem.tasks.push_back(
      ik::FrameTask{task.name,
                    {o.position_cost, o.position_cost, o.position_cost},
                    {o.orientation_cost, o.orientation_cost, o.orientation_cost},
                    gain,
                    kLargeErrorDamping / gain});
  problem.tasks.push_back(ik::PostureTask{{o.posture_cost}, gain, 0});
  problem.limits.push_back(ik::ConfigurationLimit{1, 0});
  return problem;
}

}  // namespace

Result<std::unique_ptr<Controller>> make_inverse_kinematics_controller(const CompiledWorld& world,
                                                                       const RobotInstance& robot) {
  const mjModel& model = *world.model;
  GLOAM_TRY(TaskFrame task, find_task_frame(model, robot));
  GLOAM_TRY(ik::Program program,
            ik::Program::create(model, task.dofs, problem_of(robot.options.controller, task)));
  const TaskSpaceOptions& options = robot.options.controller.task;
  program.limit_velocities(options.velocity_limit);
  if (const double distance = options.collision_distance; distance > 0) {
    ik::GeomPairs pairs = pairs_to_separate(world, task.dofs, program.kinematics());
    ik::CollisionLimit limit;
    limit.min_distance = distance;
    limit.detection_distance = 3 * distance;
    GLOAM_TRY_STATUS(program.avoid(limit, std::move(pairs), kNearPairs));
  }
  return std::unique_ptr<Controller>(
      std::make_unique<InverseKinematicsController>(robot, std::move(task), std::move(program)));
}

}  // namespace gloam
