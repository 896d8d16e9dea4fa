#pragma once
// Positions of a model's bodies at one configuration, with memory of its own, and the poses and
// Jacobians of frames there.

#include <mujoco/mujoco.h>

#include <Eigen/Dense>
#include <span>
#include <string>
#include <vector>

#include "gloam/joints/ik.h"
#include "world/world.h"

namespace gloam::ik {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
/// Layout of MuJoCo's Jacobians.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Transform {
  Matrix3d R;
  Vector3d p;
};
Transform to_transform(const Pose& X);
inline Transform inverse(const Transform& X) { return {X.R.transpose(), -(X.R.transpose() * X.p)}; }
inline Transform operator*(const Transform& X, const Transform& Y) {
  return {X.R * Y.R, X.R * Y.p + X.p};
}

/// A frame found in a model.
struct FrameId {
  FrameKind kind = FrameKind::kBody;
  int id = 0;
  int body(const mjModel& model) const;  ///< body that it is fixed to
};
/// Pose X_WB of a frame in data with positions of bodies.
Transform pose_of(const mjData& data, const FrameId& frame);
/// Error: no such frame; the hint has the nearest name.
Result<FrameId> find_frame(const mjModel& model, const FrameName& name);
/// Id of an element by its full name. Error: no such element; the hint has the nearest name.
Result<int> find_element(const mjModel& model, mjtObj type, const char* what,
                         const std::string& name);

class Kinematics {
 public:
  /// `dofs`: the degrees of freedom that may move, ascending; columns of all Jacobians, (n).
  Kinematics(const mjModel& model, std::vector<int> dofs);
  Kinematics(const Kinematics& other);
  Kinematics(Kinematics&&) noexcept = default;
  Kinematics& operator=(const Kinematics&) = delete;

  /// Computes positions at `qpos` (nq), which is copied. Mocap bodies stay.
  void update(const double* qpos);
  /// Poses of mocap bodies for the updates that follow.
  void set_mocap(const mjData& source);

  const mjModel& model() const { return *model_; }
  const mjData& data() const { return *data_; }
  mjData& data() { return *data_; }
  const std::vector<int>& dofs() const { return dofs_; }
  int size() const { return static_cast<int>(dofs_.size()); }

  Transform pose(const FrameId& frame) const { return pose_of(*data_, frame); }  ///< X_WB
  /// Velocity of the frame in its own axes, translation first, per velocity of the degrees of
  /// freedom: (6 x n).
  void body_jacobian(const FrameId& frame, MatrixXd& J_B);
  /// Velocity of a point that is fixed to a body, world axes: (3 x n).
  void point_jacobian(int body, const Vector3d& p_W, MatrixXd& J_W);
  /// Velocity of the centre of mass of a body and its descendants, world axes: (3 x n).
  void com_jacobian(int body, MatrixXd& J_W);

 private:
  const mjModel* model_;
  DataPtr data_;
  std::vector<int> dofs_;
  RowMatrix full_;  // (6 x nv)
};

}  // namespace gloam::ik
