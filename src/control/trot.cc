#include "control/trot.h"

#include <algorithm>
#include <cmath>

#include "control/trot_force.h"
#include "control/trot_gait.h"
#include "control/trot_goal.h"
#include "control/trot_legs.h"
#include "control/trot_options.h"
#include "control/trot_state.h"
#include "control/trot_swing.h"

namespace gloam {
namespace {

/// The defaults fit kReferenceLeg; another size moves alike in scaled time (equal Froude number).
TrotOptions scaled(TrotOptions o, double leg_length) {
  const double length = leg_length / kReferenceLeg, time = std::sqrt(length);
  for (double* x : {&o.clearance, &o.press, &o.placement_limit, &o.position_leash}) *x *= length;
  for (double* x : {&o.period, &o.placement_gain}) *x *= time;
  for (double* x : {&o.reach_speed, &o.wake_speed}) *x *= length / time;
  for (double* x : {&o.kd_xy, &o.kd_z, &o.kd_tilt, &o.kd_yaw, &o.kd_swing}) *x /= time;
  for (double* x : {&o.kp_xy, &o.kp_z, &o.kp_tilt, &o.kp_yaw, &o.kp_swing}) *x /= length;
  o.height_integral /= length * time;
  return o;
}

/// Rotation vector that turns `R` to `R_goal`, world axes [rad].
Vector3d rotation_error(const Matrix3d& R_goal, const Matrix3d& R) {
  const Eigen::AngleAxisd turn(Matrix3d(R_goal * R.transpose()));
  return turn.angle() * turn.axis();
}

constexpr double kContactHold = 0.01;   // [s] a contact is believed for after its last report
constexpr double kLandingPhase = 0.6;   // a touch this late in the swing is the landing
constexpr double kFallDelay = 0.1;      // [s]
constexpr double kFallenDamping = 1.0;  // [N m s/rad]
constexpr double kGroundFilter = 0.03;  // [s] time constant of the ground height
constexpr double kSettledFoot = 0.03;   // [m] from its nominal place: good enough to stand on

class Trot final : public TrotController {
 public:
  Trot(const Quadruped& robot, const TrotOptions& options)
      : robot_(robot),
        options_(scaled(options, robot.leg_length)),
        shaper_(options_, options_.crouch * robot.leg_length - robot.legs[0].anchor_B[1].z()),
        gait_(options_.period, options_.duty),
        forces_(options_) {}

  void reset(const mjModel* model, const mjData* data) override;
  void control(const ControlInputs& in) override;
  void take_over(const mjModel* model, const mjData* data, const Controller& before) override;
  std::unique_ptr<Controller> clone() const override { return std::make_unique<Trot>(*this); }
  const TrotStatus& status() const override { return status_; }

 private:
  void choose_gait(double dt);
  void watch_feet(double dt);
  void watch_for_fall(double dt);
  Vector3d foothold(int leg) const;
  ForceProblem wanted_wrench(double dt);
  /// Also adds what the leg's motion takes to the wrench that the standing feet must give.
  Vector3d swing_torque(int leg, double dt, ForceProblem& problem);
  void write_torque(int leg, const Vector3d& torque, mjData* data);
  Vector3d nominal_W(int leg, double yaw) const {
    return Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * nominal_H_[leg];
  }

  Quadruped robot_;
  TrotOptions options_;
  GoalShaper shaper_;
  TrotGait gait_;
  ForceDistribution forces_;
  TrotState s_;
  TrotStatus status_;
  std::array<Vector3d, 4> nominal_H_;  // foot from B's origin when standing, z = 0

  double height_sum_ = 0;  // integral action [m/s²]
  double ground_ = 0;      // height of the standing feet's centres
  double fall_time_ = 0;

  struct Foot {
    bool bears = false;      // carries weight: stance force control
    bool swings = false;     // on its scheduled way
    double since_touch = 1;  // [s]
    Vector3d lift_off = Vector3d::Zero(), aim = Vector3d::Zero();
  };
  std::array<Foot, 4> feet_;
};

void Trot::reset(const mjModel*, const mjData* data) {
  measure(robot_, *data, {}, s_);
  const Vector3d com_B = s_.R_WB.transpose() * (s_.com_W - s_.p_WB);
  Vector3d center = Vector3d::Zero();
  for (int k = 0; k < 4; ++k) {
    nominal_H_[k] = {robot_.legs[k].anchor_B[1].x(), robot_.legs[k].foot_B.y(), 0};
    center += nominal_H_[k] / 4;
  }
  for (auto& foot : nominal_H_) foot += Vector3d(com_B.x() - center.x(), com_B.y() - center.y(), 0);

  status_ = {};
  height_sum_ = fall_time_ = 0;
  gait_.stand();
  forces_.reset();
  ground_ = 0;
  for (int k = 0; k < 4; ++k) {
    feet_[k] = {};
    feet_[k].lift_off = feet_[k].aim = s_.foot_W[k];
    ground_ += s_.foot_W[k].z() / 4;
  }
  shaper_.reset(s_, s_.p_WB.z() - ground_);
}

// The gait's numbers follow from the size of the legs: with other legs it starts over.
void Trot::take_over(const mjModel* model, const mjData* data, const Controller& before) {
  const auto* old = dynamic_cast<const Trot*>(&before);
  if (old == nullptr || old->robot_.leg_length != robot_.leg_length) return reset(model, data);
  const Quadruped robot = robot_;
  *this = *old;
  robot_ = robot;
}

void Trot::choose_gait(double dt) {
  const bool moving = shaper_.moving();
  double misplaced = 0;
  for (int k = 0; k < 4; ++k) {
    const Vector3d off = s_.foot_W[k] - s_.p_WB - nominal_W(k, s_.yaw);
    misplaced = std::max(misplaced, off.head<2>().norm());
  }
  const double speed = s_.v_W.head<2>().norm();
  if (!gait_.stepping()) {
    if (moving || speed > options_.wake_speed || misplaced > 3 * kSettledFoot) gait_.start();
  } else {
    gait_.advance(dt);
    if (!moving && gait_.between_steps() && speed < 0.6 * options_.wake_speed &&
        misplaced < kSettledFoot && std::abs(s_.omega_W.z()) < 0.3) {
      gait_.stand();
      shaper_.hold(s_);
    }
  }
  status_.stepping = gait_.stepping();
}

void Trot::watch_feet(double dt) {
  double height = 0;
  int standing = 0;
  for (int k = 0; k < 4; ++k) {
    Foot& foot = feet_[k];
    foot.since_touch = s_.touching[k] ? 0 : foot.since_touch + dt;
    const bool touches = foot.since_touch <= kContactHold;
    if (gait_.should_stand(k)) {
      const bool bore = foot.bears;
      foot.swings = false;
      foot.bears = touches;
      if (bore && !touches) foot.aim = s_.foot_W[k];
    } else if (!foot.swings) {
      foot = {.bears = false, .swings = true, .since_touch = 1};
      foot.lift_off = foot.aim = s_.foot_W[k];
    } else if (gait_.swing_phase(k) > kLandingPhase && s_.touching[k]) {
      foot.bears = true;
    }
    if (foot.bears) {
      height += s_.foot_W[k].z();
      ++standing;
    }
  }
  if (standing > 0) ground_ += (height / standing - ground_) * std::min(1.0, dt / kGroundFilter);
}

void Trot::watch_for_fall(double dt) {
  const bool down =
      s_.R_WB(2, 2) < 0.5 || s_.p_WB.z() - ground_ < 0.35 * options_.crouch * robot_.leg_length;
  fall_time_ = down ? fall_time_ + dt : 0;
  if (fall_time_ > kFallDelay) status_.fallen = true;
}

Vector3d Trot::foothold(int leg) const {
  const double left = (1 - gait_.swing_phase(leg)) * gait_.swing_time();
  const BodyGoal& goal = shaper_.goal();
  const Vector3d nominal = nominal_W(leg, s_.yaw + goal.velocity.yaw_rate * left);
  const Vector3d turning = goal.velocity.yaw_rate * Vector3d::UnitZ().cross(nominal);
  Vector3d offset = 0.5 * gait_.stance_time() * (s_.v_W + turning) +
                    options_.placement_gain * (s_.v_W - goal.v_W);
  offset.z() = 0;
  if (offset.norm() > options_.placement_limit) offset *= options_.placement_limit / offset.norm();
  Vector3d out = s_.p_WB + s_.v_W * left + nominal + offset;
  out.z() = ground_ - options_.press;
  return out;
}

ForceProblem Trot::wanted_wrench(double dt) {
  ForceProblem problem;
  problem.R_WH = s_.R_WH;
  for (int k = 0; k < 4; ++k) {
    problem.stands[k] = feet_[k].bears;
    problem.foot[k] = s_.foot_W[k] - s_.com_W;
    problem.foot[k].z() -= robot_.legs[k].foot_radius;
  }
  const BodyGoal& goal = shaper_.goal();
  Vector3d a =
      goal.a_W + options_.kp_xy * (goal.p_W - s_.p_WB) + options_.kd_xy * (goal.v_W - s_.v_W);
  const double height_error = goal.height - (s_.p_WB.z() - ground_);
  height_sum_ = std::clamp(height_sum_ + options_.height_integral * height_error * dt,
                           -options_.height_integral_limit, options_.height_integral_limit);
  a.z() = options_.kp_z * height_error - options_.kd_z * s_.v_W.z() + height_sum_;

  const Matrix3d level = Eigen::AngleAxisd(goal.yaw, Vector3d::UnitZ()).toRotationMatrix();
  const Vector3d kp_H(options_.kp_tilt, options_.kp_tilt, options_.kp_yaw);
  const Vector3d kd_H(options_.kd_tilt, options_.kd_tilt, options_.kd_yaw);
  const Vector3d turn = s_.R_WH.transpose() * rotation_error(level, s_.R_WB);
  const Vector3d rate = s_.R_WH.transpose() * (Vector3d(0, 0, goal.velocity.yaw_rate) - s_.omega_W);
  const Vector3d alpha = s_.R_WH * (kp_H.cwiseProduct(turn) + kd_H.cwiseProduct(rate));

  const Matrix3d inertia = s_.R_WB * composite_inertia(robot_, s_) * s_.R_WB.transpose();
  problem.wrench.head<3>() = robot_.mass * (a + Vector3d(0, 0, robot_.gravity));
  problem.wrench.tail<3>() = inertia * alpha + s_.omega_W.cross(inertia * s_.omega_W);
  return problem;
}

Vector3d Trot::swing_torque(int k, double dt, ForceProblem& problem) {
  Foot& foot = feet_[k];
  FootGoal goal;
  if (foot.swings) {
    foot.aim = foothold(k);
    goal = swing_point(foot.lift_off, foot.aim, options_.clearance, gait_.swing_phase(k),
                       gait_.swing_time());
  } else {  // late: keep going down, and along with the body
    foot.aim.z() = std::max(foot.aim.z() - options_.reach_speed * dt, ground_ - options_.clearance);
    goal = {foot.aim, Vector3d(0, 0, -options_.reach_speed), Vector3d::Zero()};
  }
  const Vector3d a_W = goal.a + options_.kp_swing * (goal.p - s_.foot_W[k]) +
                       options_.kd_swing * (goal.v - s_.foot_velocity_W[k]);
  const LegPose& pose = s_.pose[k];
  const Vector3d a_B = s_.R_WB.transpose() * a_W - foot_bias_acceleration(pose, s_.qd[k]);
  // Damped inverse: bounded near a straight knee.
  const Matrix3d JJt = pose.J * pose.J.transpose() + 1e-5 * Matrix3d::Identity();
  const Vector3d qdd = pose.J.transpose() * JJt.ldlt().solve(a_B);
  const Leg& leg = robot_.legs[k];
  const LegDynamics motion = leg_dynamics(leg, pose, s_.qd[k], qdd, Vector3d::Zero());
  const LegDynamics weight =
      leg_dynamics(leg, pose, Vector3d::Zero(), Vector3d::Zero(), s_.gravity_B);
  const Vector3d center_B = s_.R_WB.transpose() * (s_.com_W - s_.p_WB);
  problem.wrench.head<3>() += s_.R_WB * motion.force;
  problem.wrench.tail<3>() += s_.R_WB * (motion.moment - center_B.cross(motion.force));
  return motion.torque + weight.torque;
}

void Trot::write_torque(int k, const Vector3d& torque, mjData* data) {
  const Leg& leg = robot_.legs[k];
  for (int i = 0; i < 3; ++i) {
    // Most of the joint's friction, smoothly through zero: less than the whole stays stable.
    const double friction = leg.friction[i] * std::tanh(s_.qd[k][i] / 0.5) * 0.8;
    const double wanted = torque[i] + friction + leg.damping[i] * s_.qd[k][i];
    const double limit = leg.torque_limit[i];
    if (std::abs(wanted) > limit) ++status_.saturated;
    data->ctrl[leg.actuator[i]] = std::clamp(wanted, -limit, limit) / leg.torque_per_control[i];
  }
}

void Trot::control(const ControlInputs& in) {
  mjData* const data = in.data;
  const double period = in.period;
  ++status_.calls;
  measure(robot_, *data, in.loads, s_);
  watch_for_fall(period);
  if (status_.fallen) {
    for (int k = 0; k < 4; ++k) write_torque(k, -kFallenDamping * s_.qd[k], data);
    return;
  }
  shaper_.update(in.goal, s_, period);
  choose_gait(period);
  watch_feet(period);
  ForceProblem problem = wanted_wrench(period);
  for (int k = 0; k < 4; ++k)
    if (!feet_[k].bears) write_torque(k, swing_torque(k, period, problem), data);
  const auto& force = forces_.solve(problem);
  for (int k = 0; k < 4; ++k) {
    if (!feet_[k].bears) continue;
    const LegPose& pose = s_.pose[k];
    const LegDynamics weight =
        leg_dynamics(robot_.legs[k], pose, Vector3d::Zero(), Vector3d::Zero(), s_.gravity_B);
    // The ground pushes at the sole, not at the foot's centre, which rolls.
    const Vector3d sole = pose.foot + robot_.legs[k].foot_radius * s_.gravity_B.normalized();
    Vector3d torque = weight.torque;
    for (int i = 0; i < 3; ++i)
      torque[i] -= pose.axis[i].cross(sole - pose.anchor[i]).dot(s_.R_WB.transpose() * force[k]);
    write_torque(k, torque, data);
  }
}

}  // namespace

Result<std::unique_ptr<TrotController>> make_trot_controller(const mjModel& model,
                                                             const RobotInstance& robot,
                                                             const TrotOptions& options) {
  GLOAM_TRY(Quadruped quadruped, find_quadruped(model, robot));
  return std::unique_ptr<TrotController>(std::make_unique<Trot>(quadruped, options));
}

Result<std::unique_ptr<Controller>> make_trot_controller(const CompiledWorld& world,
                                                         const RobotInstance& robot) {
  GLOAM_TRY(std::unique_ptr<TrotController> trot,
            make_trot_controller(*world.model, robot, TrotOptions{}));
  return std::unique_ptr<Controller>(std::move(trot));
}

// The controller has no limits of its own; its tests walk as fast as this.
Result<RobotGoals> trot_goals(const CompiledWorld&, const RobotInstance&) {
  return RobotGoals{.velocity = VelocityRanges{{-1, 1}, {-0.25, 0.25}, {-0.8, 0.8}}};
}

}  // namespace gloam
