#include "control/drive/wheels.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "base/text.h"
#include "control/robot_joints.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kParallel = 0.98;      // cosine between a wheel's axis and the base's y axis
constexpr double kSmallestSide = 1e-3;  // lateral distance of a wheel from the middle [m]

/// A driven hinge with its place in the base's frame.
struct Candidate {
  std::string name;  // without the robot's prefix
  Wheel wheel;
  double y = 0;           // [m]
  double radius = 0;      // [m], 0 = unknown
  bool is_wheel = false;  // its axis is parallel to the base's y axis
};

// The largest radius of the body's geoms about the joint's axis.
double radius_of(const mjModel& model, int body) {
  double radius = 0;
  for (int i = 0; i < model.body_geomnum[body]; ++i) {
    const int geom = model.body_geomadr[body] + i;
    if (model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0) continue;
    const mjtNum* size = model.geom_size + 3 * geom;
    switch (model.geom_type[geom]) {
      case mjGEOM_SPHERE:
      case mjGEOM_CYLINDER:
      case mjGEOM_CAPSULE:
        radius = std::max(radius, size[0]);
        break;
      case mjGEOM_ELLIPSOID:
        radius = std::max(radius, std::max(size[0], size[2]));
        break;
      case mjGEOM_MESH: {
        std::array<double, 3> half = {size[0], size[1], size[2]};
        std::ranges::sort(half);
        radius = std::max(radius, half[2]);
        break;
      }
      default:
        break;
    }
  }
  return radius;
}

std::optional<Wheel> wheel_of(const mjModel& model, int actuator) {
  if (model.actuator_trntype[actuator] != mjTRN_JOINT || model.actuator_ctrlnum[actuator] != 1 ||
      model.actuator_gaintype[actuator] != mjGAIN_FIXED) {
    return {};
  }
  const double gain = model.actuator_gainprm[mjNGAIN * actuator];
  const mjtNum* bias = model.actuator_biasprm + mjNBIAS * actuator;
  const bool affine = model.actuator_biastype[actuator] == mjBIAS_AFFINE;
  const bool is_servo = affine && bias[1] == 0 && bias[2] == -gain;
  const bool is_motor = model.actuator_biastype[actuator] == mjBIAS_NONE;
  if (gain == 0 || (!is_servo && !is_motor)) return {};
  const int joint = model.actuator_trnid[2 * actuator];
  Wheel wheel;
  wheel.ctrl = model.actuator_ctrladr[actuator];
  wheel.dof = model.jnt_dofadr[joint];
  wheel.takes_speed = is_servo;
  wheel.gear = model.actuator_gear[6 * model.actuator_outadr[actuator]];
  wheel.gain = gain;
  wheel.inertia = model.dof_M0[wheel.dof];
  const bool limited = model.actuator_ctrllimited[wheel.ctrl];
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  wheel.lowest = limited ? model.actuator_ctrlrange[2 * wheel.ctrl] : -kInfinity;
  wheel.highest = limited ? model.actuator_ctrlrange[2 * wheel.ctrl + 1] : kInfinity;
  return wheel;
}

std::vector<Candidate> candidates_of(const mjModel& model, const RobotInstance& robot) {
  const DataPtr data(mj_makeData(&model));
  std::vector<Candidate> all;
  if (!data) return all;
  mj_kinematics(&model, data.get());
  const int root = robot.root_body;
  const Matrix3d R_WB =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat + 9 * root);
  for (int actuator = 0; actuator < model.nactuator; ++actuator) {
    const std::optional<Wheel> wheel = wheel_of(model, actuator);
    if (!wheel || !may_use(robot, actuator)) continue;
    const int joint = model.actuator_trnid[2 * actuator];
    if (model.jnt_type[joint] != mjJNT_HINGE || !is_part_of(model, model.jnt_bodyid[joint], root) ||
        wheel->gear == 0) {
      continue;
    }
    Candidate row{joint_name(model, joint, robot), *wheel};
    const Vector3d axis_B = R_WB.transpose() * Vector3d(data->xaxis + 3 * joint);
    row.y = (R_WB.transpose() * Vector3d(data->xanchor + 3 * joint) -
             R_WB.transpose() * Vector3d(data->xpos + 3 * root))
                .y();
    row.radius = radius_of(model, model.jnt_bodyid[joint]);
    row.is_wheel = std::abs(axis_B.y()) > kParallel;
    row.wheel.turn = axis_B.y() < 0 ? -1 : 1;
    all.push_back(std::move(row));
  }
  return all;
}

Error unsuited_base(const RobotInstance& robot, std::string_view reason, std::string hint) {
  return Error{
      ErrorKind::kInput,
      fmt::format("controller 'diff_drive' cannot drive robot '{}': {}", robot.name, reason),
      robot.options.controller.loc, std::move(hint)};
}

// The wheels of one side: the named ones, or all on that side.
Result<std::vector<Candidate>> side_of(const std::vector<Candidate>& all,
                                       const std::vector<std::string>& names, double side,
                                       const RobotInstance& robot) {
  std::vector<Candidate> wheels;
  if (names.empty()) {
    std::ranges::copy_if(all, std::back_inserter(wheels), [&](const Candidate& row) {
      return row.is_wheel && row.y * side > kSmallestSide;
    });
    return wheels;
  }
  for (const std::string& name : names) {
    const auto row = std::ranges::find(all, name, &Candidate::name);
    if (row == all.end()) {
      std::vector<std::string> known;
      for (const Candidate& one : all) known.push_back(one.name);
      return unsuited_base(robot, fmt::format("it has no driven wheel '{}'", name),
                           suggest_name(name, known));
    }
    wheels.push_back(*row);
  }
  return wheels;
}

double mean(const std::vector<Candidate>& wheels, double Candidate::* member) {
  double sum = 0;
  for (const Candidate& row : wheels) sum += row.*member;
  return sum / static_cast<double>(wheels.size());
}

}  // namespace

Result<WheeledBase> find_wheels(const mjModel& model, const RobotInstance& robot) {
  const DriveOptions& options = robot.options.controller.drive;
  const std::vector<Candidate> all = candidates_of(model, robot);
  GLOAM_TRY(const std::vector<Candidate> left, side_of(all, options.left, +1, robot));
  GLOAM_TRY(const std::vector<Candidate> right, side_of(all, options.right, -1, robot));
  if (left.empty() || right.empty()) {
    return unsuited_base(robot,
                         fmt::format("{} of its driven wheels are on the left, {} on the right",
                                     left.size(), right.size()),
                         "set drive.left and drive.right to the names of the wheels' joints");
  }
  WheeledBase base;
  base.mass = model.body_subtreemass[robot.root_body];
  base.radius = options.wheel_radius;
  if (base.radius == 0)
    base.radius = (mean(left, &Candidate::radius) + mean(right, &Candidate::radius)) / 2;
  if (!(base.radius > 0))
    return unsuited_base(robot, "its wheels have no collision geoms", "set drive.wheel_radius");
  base.track =
      options.track != 0 ? options.track : mean(left, &Candidate::y) - mean(right, &Candidate::y);
  if (!(base.track > 0)) {
    return unsuited_base(robot, "its left wheels are not to the left of its right wheels",
                         "set drive.track");
  }
  for (const Candidate& row : left) base.left.push_back(row.wheel);
  for (const Candidate& row : right) base.right.push_back(row.wheel);
  return base;
}

}  // namespace gloam
