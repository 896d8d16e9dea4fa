#pragma once
// Differential inverse kinematics: joint velocities that bring frames, postures and the centre of
// mass of a model to their targets, within limits. One convex quadratic program in the displacement
// Δq = v dt: min ½ Δqᵀ H Δq + cᵀ Δq with G Δq <= h. Tasks, limits and their defaults have the
// meaning that they have in the Python package Mink (K. Zakka, "Mink: Python inverse kinematics
// based on MuJoCo", 2024); docs/controllers.md lists the differences.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"
#include "gloam/world.h"

namespace gloam::ik {

enum class FrameKind { kBody, kSite, kGeom };

/// A frame of the model: the origin and axes of a body, site or geom.
struct FrameName {
  FrameKind kind = FrameKind::kBody;
  std::string name = {};  ///< full name, with the robot's prefix
};
/// "site arm/tool", "body NAME" or "geom NAME". Error: no such kind, or no name.
Result<FrameName> parse_frame(std::string_view text);

/// Regulates the pose of a frame B to a target T in the world. Error: e = log(T_BT), a twist in B,
/// translation first [m, rad], (6).
struct FrameTask {
  FrameName frame;
  Vec3 position_cost = {1, 1, 1};     ///< weight of the error along B's axes [1/m], >= 0
  Vec3 orientation_cost = {1, 1, 1};  ///< weight of the error about B's axes [1/rad], >= 0
  double gain = 1;                    ///< share of the error removed in one step, 0..1
  double lm_damping = 0;              ///< Levenberg-Marquardt damping per squared weighted error
};
/// The same for the pose of a frame in another frame of the model. Error: log(T_TB), (6).
struct RelativeFrameTask {
  FrameName frame, root;
  Vec3 position_cost = {1, 1, 1}, orientation_cost = {1, 1, 1};
  double gain = 1, lm_damping = 0;
};
/// Regulates all coordinates, except at free joints, to a configuration (nq).
/// Error: q - q_target [rad, m], (nv).
struct PostureTask {
  std::vector<double> cost = {1};  ///< one for all degrees of freedom, or (nv); >= 0
  double gain = 1, lm_damping = 0;
};
/// Regulates the centre of mass of a body and its descendants, in the world [m], (3).
struct ComTask {
  std::string body = {};  ///< full name; empty = body 1, the whole robot in a bare model
  Vec3 cost = {1, 1, 1};  ///< weight of the error along the world's axes [1/m], >= 0
  double gain = 1, lm_damping = 0;
};
/// Regulates all velocities, except at free joints, to zero.
struct DampingTask {
  std::vector<double> cost = {1};  ///< one for all degrees of freedom, or (nv); >= 0
};
using Task = std::variant<FrameTask, RelativeFrameTask, PostureTask, ComTask, DampingTask>;

/// Keeps hinges and slides within their ranges, and ball joints within their angle.
struct ConfigurationLimit {
  double gain = 0.95;       ///< share of the remaining distance that one step may cover, (0, 1]
  double min_distance = 0;  ///< kept from each end of the range [rad, m]; negative = beyond it
};
/// Bounds the velocities of joints.
struct VelocityLimit {
  /// Joints by full names, and bounds [rad/s, m/s] of their 1 (hinge, slide) or 3 (ball)
  /// velocities, >= 0.
  std::vector<std::pair<std::string, std::vector<double>>> velocities;
};
/// Keeps geoms apart: n·Δp >= -gain (d - min_distance) for each pair that is nearer than
/// `detection_distance`. Mink 1.3 bounds the displacement by gain (d - min_distance) / dt.
struct CollisionLimit {
  /// Groups of geoms by full names; each geom of the first group avoids each of the second. Pairs
  /// of one body, of bodies welded together, of parent and child, and pairs that contype and
  /// conaffinity exclude are skipped.
  std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> groups;
  double gain = 0.85;                ///< share of the remaining distance for one step, > 0
  double min_distance = 0.005;       ///< [m]; negative = penetration is allowed
  double detection_distance = 0.01;  ///< [m], > min_distance
  double bound_relaxation = 0;       ///< added to each bound [m], >= 0
};
using Limit = std::variant<ConfigurationLimit, VelocityLimit, CollisionLimit>;

struct Problem {
  std::vector<Task> tasks;
  std::vector<Limit> limits;
  double damping = 1e-12;  ///< added to the diagonal of H, >= 0
};

enum class SolutionStatus {
  kSolved,
  kInfeasible,  ///< the limits contradict each other
  kSingular,    ///< H is not positive definite: add a damping task; or inputs are not finite
};
struct Solution {
  SolutionStatus status = SolutionStatus::kSolved;
  std::span<const double> velocity;  ///< [rad/s, m/s], (nv); zero unless solved
};

/// Solves a problem repeatedly. Memory is reserved in create(). Not thread-safe.
class Solver {
 public:
  /// Errors: unknown names with the nearest one, wrong sizes, values outside their ranges.
  static Result<Solver> create(const World& world, const Problem& problem);
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;
  ~Solver();

  /// Target of a frame task in the world, of a relative one in its root. Error: another task.
  Status set_target(size_t task, const Pose& target);
  /// Target of a posture task (nq) or a centre-of-mass task (3). Error: another task or size.
  Status set_target(size_t task, std::span<const double> target);
  /// Velocity at the configuration `qpos` (nq) for a step of `dt` [s], > 0. Frames of mocap bodies
  /// have their poses in the model. The result is valid until the next call. Errors: a size, a
  /// target that has not been set.
  Result<Solution> solve(std::span<const double> qpos, double dt);
  /// Error of a task in the last solution, in its own units, not weighted.
  std::span<const double> error(size_t task) const;

 private:
  struct Impl;
  explicit Solver(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace gloam::ik
