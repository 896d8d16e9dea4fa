#include "control/trot_goal.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kRiseSpeed = 0.15;   // [m/s] at which the height goal moves
constexpr double kMovingGoal = 0.01;  // [m/s, rad/s] a goal below it means "stand"

double approach(double from, double to, double step) {
  return from + std::clamp(to - from, -step, step);
}

}  // namespace

void GoalShaper::reset(const TrotState& state, double height) {
  goal_ = {};
  goal_.height = height;
  hold(state);
}

void GoalShaper::hold(const TrotState& state) {
  goal_.p_W = state.p_WB;
  goal_.yaw = state.yaw;
}

bool GoalShaper::moving() const {
  return std::abs(goal_.velocity.vx) > kMovingGoal || std::abs(goal_.velocity.vy) > kMovingGoal ||
         std::abs(goal_.velocity.yaw_rate) > kMovingGoal;
}

void GoalShaper::update(const VelocityTarget& target, const TrotState& state, double dt) {
  VelocityTarget& v = goal_.velocity;
  const Vector3d before(v.vx, v.vy, 0);
  v.vx = approach(v.vx, target.vx, options_.linear_acceleration * dt);
  v.vy = approach(v.vy, target.vy, options_.linear_acceleration * dt);
  v.yaw_rate = approach(v.yaw_rate, target.yaw_rate, options_.angular_acceleration * dt);
  const Vector3d v_H(v.vx, v.vy, 0);
  goal_.v_W = state.R_WH * v_H;
  goal_.a_W = state.R_WH * ((v_H - before) / dt + v.yaw_rate * Vector3d::UnitZ().cross(v_H));

  Vector3d lead = goal_.p_W + goal_.v_W * dt - state.p_WB;
  lead.z() = 0;
  if (lead.norm() > options_.position_leash) lead *= options_.position_leash / lead.norm();
  goal_.p_W = state.p_WB + lead;
  const double turn = std::remainder(goal_.yaw + v.yaw_rate * dt - state.yaw, 2 * M_PI);
  goal_.yaw = state.yaw + std::clamp(turn, -options_.yaw_leash, options_.yaw_leash);
  goal_.height = approach(goal_.height, standing_height_, kRiseSpeed * dt);
}

}  // namespace gloam
