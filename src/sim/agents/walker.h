#pragma once
// Gait of a person: steps follow from the motion of the body, feet stay where they are put down.
//
// Cadence and step length grow alike with speed (a constant walk ratio: Sekiya and Nagasaki 1998).
// The fraction of stance falls with speed (Murray 1967, Nilsson et al. 1985). The hips rise and
// fall as step length requires (Gard and Childress 2001). Hips, knees and ankles turn as in
// gait_curves.h, pelvis, trunk and arms as in Perry and Burnfield 2010 at 1.3 m/s, less when
// slower.

#include <array>

#include "sim/agents/agent_math.h"
#include "world/agents/agent_description.h"

namespace gloam {

/// Height of the ground.
class GroundHeight {
 public:
  virtual ~GroundHeight() = default;
  /// Height of the surface that a foot at p finds [m].
  virtual double at(Vec3d p) const = 0;
};

/// Motion of the body over the feet, at an instant.
struct WalkInput {
  Vec3d p;              ///< on the ground below the hips [m]
  Vec3d velocity;       ///< in the plane [m/s]
  Vec3d acceleration;   ///< in the plane [m/s²]
  double heading = 0;   ///< [rad]
  double yaw_rate = 0;  ///< [rad/s]
  Vec3d push;           ///< velocity that comes of being pushed [m/s]
  double time = 0;      ///< [s]
};

using PersonPose = std::array<PartPose, kPersonParts>;

class Walker {
 public:
  explicit Walker(const PersonShape& shape, uint64_t seed);

  /// Stands with both feet side by side.
  void reset(const WalkInput& in, const GroundHeight& ground);
  /// Goes on by `dt` [s] to where `in` is.
  void step(double dt, const WalkInput& in, const GroundHeight& ground);
  /// Poses of all parts in the world.
  PersonPose pose(const WalkInput& in) const;

  /// Steps per second at a speed, and the fraction of the cycle that a foot stands.
  double cadence(double speed) const;
  static double stance_share(double speed);
  bool is_stepping() const { return state_.is_stepping != 0; }
  /// Is a foot (0 left, 1 right) on the ground?
  bool is_planted(int foot) const;
  uint64_t hash(uint64_t seed) const;

 private:
  struct Foot {
    Vec3d p;         // below the ankle on the sole [m]
    double yaw = 0;  // [rad]
    Vec3d from;      // place where it left the ground
    double from_yaw = 0;
    Vec3d to;  // place where it will come down
    double to_yaw = 0;
  };
  // Plain, without holes: it is hashed.
  struct State {
    Foot feet[2];
    double phase = 0;  // phase of the left foot: 0 = it comes down, 1 = again
    double stance = 0.62;
    double speed = 0;     // filtered [m/s]
    double activity = 0;  // 0 stands … 1 walks
    double ground = 0;    // below the hips, filtered [m]
    double bob = 0;       // descent of the hips from standing [m], filtered
    double lean[2] = {};  // lean of the trunk: forward, to the left [rad], filtered
    int64_t is_stepping = 0;
  };
  double phase_of(int foot) const;
  double in_usual_cycle(double phase) const;
  double usual_steps() const;
  Vec3d neutral(const WalkInput& in, int foot) const;
  double error_of(const WalkInput& in, int foot) const;
  void begin_step(const WalkInput& in);
  void advance(double dt, const WalkInput& in, const GroundHeight& ground);
  void aim(const WalkInput& in, int foot, double rate, const GroundHeight& ground);
  double pitch_of(int foot) const;
  PartPose foot_pose(int foot) const;
  void pose_legs(PersonPose* pose) const;
  void pose_trunk(const WalkInput& in, PersonPose* pose) const;

  PersonShape shape_;
  double idle_phase_ = 0;  // [rad]
  State state_;
};

}  // namespace gloam
