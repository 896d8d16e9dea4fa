#pragma once
// Forces on bodies from outside of MuJoCo's pipeline, and how bodies move and answer to them, in
// the generalised coordinates of their joints. data's poses and centres of mass are of the present.

#include <mujoco/mujoco.h>

#include <span>
#include <vector>

namespace gloam {

// In line: what a step does hundreds of times must not call a library for nine products.
inline double dot3(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline void cross3(const double* a, const double* b, double* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/// Edges along the world's axes of the box around a box with half edges `half`, turned by `R`.
void edges_around(const double* R, const double* half, double* out);

/// Last of the degrees of freedom that move a body; -1 = none does. dof_parentid leads to the
/// others.
int last_dof(const mjModel& model, int body);

/// Velocity of a body where a point is [m/s], by its twist in data.cvel.
void velocity_at(const mjModel& model, const mjData& data, int body, const double* point,
                 double* velocity);

/// Adds a force [N] at a point and a torque [N m], in the world, to data.qfrc_applied.
void add_wrench(const mjModel& model, mjData& data, int body, const double* force,
                const double* torque, const double* point);

/// Factors the inertia of one tree anew, L' D L, after data.M was changed.
void factor_tree(const mjModel& model, mjData& data, int tree);

/// Motion of the point of a body and how it answers to forces there. Vectors are linear, then
/// angular, in the world.
struct BodyResponse {
  double velocity[6] = {};      ///< [m/s], [rad/s]
  double acceleration[6] = {};  ///< acceleration of the last step, without rotational terms
  double inverse[36] = {};      ///< inverse of its inertia, as all its joints share it: row by row
};

/// One body at a time. data.qLD is of the present.
class ResponseSolver {
 public:
  explicit ResponseSolver(const mjModel& model);
  /// J M^-1 J' along the chain of joints that move the body. `less`: taken off the last step's
  /// acceleration of those joints, from the last of them to the root; empty = nothing.
  BodyResponse solve(const mjModel& model, const mjData& data, int body, const double* point,
                     std::span<const double> less);
  /// Accelerations of those joints by a wrench at that point, in that order.
  void accelerations(const mjModel& model, const mjData& data, int body, const double* wrench,
                     std::span<double> out);

 private:
  std::vector<double> columns_;  // L^-T J', (nv x 6)
  std::vector<double> by_dof_;   // scratch, (nv)
  std::vector<int> chain_;       // scratch
};

/// Joints' degrees of freedom that move a body.
int chain_length(const mjModel& model, int body);

}  // namespace gloam
