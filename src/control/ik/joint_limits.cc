#include "control/ik/joint_limits.h"

#include <fmt/format.h>

#include "control/ik/ranges.h"

namespace gloam::ik {
namespace {

int column_of(const Kinematics& at, int dof) {
  const auto found = std::ranges::lower_bound(at.dofs(), dof);
  return found != at.dofs().end() && *found == dof ? static_cast<int>(found - at.dofs().begin())
                                                   : -1;
}

}  // namespace

Result<ConfigurationRows> ConfigurationRows::create(const Kinematics& at,
                                                    const ConfigurationLimit& options) {
  if (!(options.gain > 0 && options.gain <= 1))
    return refuse_value("the gain of a configuration limit must lie within (0, 1]");
  GLOAM_TRY_STATUS(check_finite({&options.min_distance, 1}, "'min_distance' of a limit"));
  ConfigurationRows rows;
  rows.gain_ = options.gain;
  const mjModel& model = at.model();
  for (int joint = 0; joint < model.njnt; ++joint) {
    const int column = column_of(at, model.jnt_dofadr[joint]), qpos = model.jnt_qposadr[joint];
    const double* range = model.jnt_range + 2 * joint;
    if (column < 0 || !model.jnt_limited[joint] || model.jnt_type[joint] == mjJNT_FREE) continue;
    if (model.jnt_type[joint] != mjJNT_BALL) {
      rows.slots_.push_back(
          {column, qpos, range[0] + options.min_distance, range[1] - options.min_distance});
      continue;
    }
    const double angle = range[1] - options.min_distance;
    if (!(angle > 0))
      return refuse_value("'min_distance' of a configuration limit leaves a ball joint no angle");
    rows.balls_.push_back({column, qpos, angle});
  }
  return rows;
}

void ConfigurationRows::add_to(ConstraintRows rows, Kinematics& at, double) const {
  const double* q = at.data().qpos;
  for (const Slot& slot : slots_) {
    rows.all->bound(slot.column, gain_ * (slot.low - q[slot.qpos]),
                    gain_ * (slot.high - q[slot.qpos]));
  }
  for (int i = 0; i < count(); ++i) {
    const Ball& ball = balls_[static_cast<size_t>(i)];
    Vector3d turn;  // from the ball's zero [rad]
    mju_quat2Vel(turn.data(), q + ball.qpos, 1);
    const double angle = turn.norm();
    rows.bound(i) = gain_ * (ball.max_angle - angle);
    if (angle > 1e-9) rows.row(i).segment<3>(ball.column) = (turn / angle).transpose();
  }
}

Result<VelocityRows> VelocityRows::create(const Kinematics& at, const VelocityLimit& options) {
  VelocityRows rows;
  const mjModel& model = at.model();
  for (const auto& [name, velocities] : options.velocities) {
    GLOAM_TRY(const int joint, find_element(model, mjOBJ_JOINT, "joint", name));
    const int type = model.jnt_type[joint];
    const size_t width = type == mjJNT_BALL ? 3 : 1;
    if (type == mjJNT_FREE || velocities.size() != width) {
      return Error{ErrorKind::kInput,
                   type == mjJNT_FREE
                       ? fmt::format("joint '{}' is free and has no velocity limit", name)
                       : fmt::format("the velocity limit of joint '{}' has {} values instead of {}",
                                     name, velocities.size(), width)};
    }
    GLOAM_TRY_STATUS(check_costs(velocities));
    for (size_t i = 0; i < width; ++i) {
      const int column = column_of(at, model.jnt_dofadr[joint] + static_cast<int>(i));
      if (column >= 0) rows.bounds_.emplace_back(column, velocities[i]);
    }
  }
  return rows;
}

VelocityRows VelocityRows::uniform(int n, double limit) {
  VelocityRows rows;
  for (int i = 0; i < n; ++i) rows.bounds_.emplace_back(i, limit);
  return rows;
}

void VelocityRows::add_to(ConstraintRows rows, Kinematics&, double dt) const {
  for (const auto& [column, velocity] : bounds_)
    rows.all->bound(column, -velocity * dt, velocity * dt);
}

}  // namespace gloam::ik
