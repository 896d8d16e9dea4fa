#pragma once
// Trajectories of joints: points, and the path that a simulation follows through them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "gloam/handle.h"
#include "gloam/result.h"

namespace gloam {

/// A point of a trajectory. Vectors have one number per joint, or are empty = not given.
struct TrajectoryPoint {
  double time = 0;                    ///< after the start [s]; only for TrajectoryProfile::kSpline
  std::vector<double> positions;      ///< [rad, m]; required
  std::vector<double> velocities;     ///< [rad/s, m/s]
  std::vector<double> accelerations;  ///< [rad/s², m/s²]
};

enum class TrajectoryProfile : uint8_t {
  /// Through points at given times, as in joint_trajectory_controller of ros2_controllers: quintic
  /// where both ends of a segment have accelerations and velocities, cubic where they have
  /// velocities, else linear.
  kSpline,
  /// From point to point along straight lines in joint space, at rest in each: trapezoidal
  /// velocity, as fast as max_velocity and max_acceleration allow. All joints arrive at the same
  /// time.
  kTrapezoidal,
  /// The same with quintic polynomials, which also start and end without acceleration.
  kQuintic,
};

const char* profile_name(TrajectoryProfile profile);  ///< "spline", "trapezoidal", "quintic"
/// Error: no such profile; the hint suggests the nearest name.
Result<TrajectoryProfile> profile_named(std::string_view name);

struct JointTrajectory {
  TrajectoryProfile profile = TrajectoryProfile::kSpline;
  std::vector<TrajectoryPoint> points;
  /// Limits, one per joint or one for all [rad/s, m/s], [rad/s², m/s²]; required for kTrapezoidal
  /// and kQuintic, whose points have positions only.
  std::vector<double> max_velocity, max_acceleration;
};

/// Position, velocity and acceleration of one joint [rad, m], per second, per second².
struct JointSample {
  double position = 0, velocity = 0, acceleration = 0;
};

/// A trajectory as polynomials in time. make() allocates; all other functions do not. Everything
/// after the first point is immutable and shared by copies, so a copy and begin() cost the same for
/// trajectories of any length.
class JointPath {
 public:
  /// Errors: no points, or more than 100,000; times that are negative or do not increase; vectors
  /// whose sizes are neither 0 nor `joints`; numbers that are not finite; missing or non-positive
  /// limits; limits for kSpline.
  static Result<JointPath> make(const JointTrajectory& trajectory, size_t joints);
  /// The errors of make().
  static Status check(const JointTrajectory& trajectory, size_t joints);

  /// Starts at these samples, one per joint. kTrapezoidal and kQuintic first brake from the initial
  /// velocity within max_acceleration.
  void begin(std::span<const JointSample> start);
  /// [s]; of kTrapezoidal and kQuintic after begin().
  double duration() const { return duration_; }
  size_t joints() const;
  /// Sample of a joint at a time after the start [s]; rests at the last point afterwards.
  JointSample at(double time, size_t joint) const;
  /// Index of the point that is approached at a time; the last one afterwards.
  size_t point_at(double time) const;

 private:
  using Polynomial = std::array<double, 6>;  ///< coefficients, by power of the time in the piece
  struct Piece {
    double length = 0, end = 0;  ///< [s]
    size_t point = 0;            ///< that it approaches
  };
  struct Plan;  ///< from the first point on
  struct Place {
    const Piece* piece;
    const Polynomial* polynomials;  ///< (joints)
    double time;                    ///< in the piece [s]
  };
  JointPath() = default;
  Place place_at(double time) const;
  void set_brake(std::span<const JointSample> start);

  std::shared_ptr<const Plan> plan_;
  std::vector<Piece> start_;              ///< until the first point; their ends are after the start
  std::vector<Polynomial> start_motion_;  ///< (start pieces x joints)
  std::vector<double> rest_;              ///< where it has braked, (joints)
  double reached_ = 0;                    ///< time of the first point [s]
  double shift_ = 0;                      ///< added to the ends of the plan's pieces [s]
  double duration_ = 0;
};

/// A trajectory that joints of a robot follow in a simulation.
struct ActiveTrajectory {
  std::vector<Joint> joints;  ///< in the order of the path's; some may have left it
  JointPath path;
  int64_t tag = 0;          ///< of FollowTrajectory
  int64_t start_step = -1;  ///< step before which it was started
  double start_time = 0;    ///< simulation time of that step [s]
  JointSample at(double time, size_t joint) const { return path.at(time - start_time, joint); }
  double end_time() const { return start_time + path.duration(); }
};

}  // namespace gloam
