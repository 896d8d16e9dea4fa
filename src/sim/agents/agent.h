#pragma once
// One agent: what it means to do (behaviour), how it goes about it (steering), how its body follows
// (motion). Agents::tick calls these in turn for all.

#include <memory>
#include <optional>

#include "base/rng.h"
#include "sim/agents/behavior_tree.h"
#include "sim/agents/nav_world.h"
#include "sim/agents/vehicle.h"
#include "sim/agents/walker.h"

namespace gloam {

class Agents;

/// Intention of a behaviour.
struct AgentIntent {
  enum class Mode : uint8_t { kStand, kGo, kSpline };
  Mode mode = Mode::kStand;
  Vec3d goal;        ///< goal of kGo [m]
  double speed = 0;  ///< [m/s]
  Vec3d velocity;    ///< velocity of kSpline [m/s]
  bool faces = false;
  double facing = 0;  ///< heading that it turns to while it stands [rad]
};

/// Place and motion of the body. The struct has no padding: it is hashed.
struct AgentMotion {
  Vec3d p;                ///< on the ground [m]
  Vec3d velocity;         ///< own velocity, in the plane [m/s]
  Vec3d push;             ///< velocity added by pushes [m/s]
  Vec3d wanted;           ///< velocity that was decided on [m/s]
  Vec3d acceleration;     ///< [m/s²]
  double heading = 0;     ///< [rad]
  double yaw_rate = 0;    ///< [rad/s]
  double touched = -1e9;  ///< when a robot last did [s]
  double way = 0;         ///< along a spline [m]
  double pause_end = 0;   ///< end of a route's or a wanderer's pause [s]
  double progress = 0;    ///< when it was last seen to get on [s]
  double facing = 0;      ///< [rad]
  Vec3d seen_at;          ///< place of that [m]
  Vec3d goal;             ///< end of the path [m]
  int64_t waypoint = 0;   ///< index in the route
  int64_t draws = 0;      ///< random decisions so far
  int64_t has_goal = 0, is_facing = 0, is_whole = 1;
};

struct AgentBody {
  explicit AgentBody(const AgentDescription& description);

  const AgentDescription* description;
  AgentMotion motion;
  AgentIntent intent;
  NavPath path;
  Walker walker;         ///< gait of a person
  VehicleState vehicle;  ///< else
  std::unique_ptr<TreeState> tree;
  std::array<PartPose, kPersonParts> before, after;  ///< poses that are gone between
  Vec3d warned_goal{1e30, 0, 0};                     ///< goal that was reported as out of reach
  Vec3d force;                                       ///< sum of contacts' [N]
  int force_steps = 0;                               ///< number of steps that it covers
  bool robot_touches = false;

  WalkInput walk_input(double time) const;
  /// Into `after`.
  void find_pose(double time);
  RandomStream stream(uint64_t seed, const char* name) const {
    return {description->seed ^ seed, stream_id(name)};
  }
  uint64_t hash(uint64_t seed) const;
};

/// Velocity and heading follow what was decided, for `dt` [s]; pushes die down. Moves `p`.
void move_body(double dt, double time, const NavMesh& mesh, const NavWorld& world,
               AgentBody* agent);

/// A smooth curve through the points of a route (Catmull and Rom 1974).
struct AgentSpline {
  AgentSpline() = default;  ///< empty, for agents that follow none
  AgentSpline(const std::vector<WaypointOptions>& route, bool loop);
  double length() const { return lengths.back(); }
  /// At a way along it [m]; the direction there too.
  Vec3d at(double way, Vec3d* direction) const;
  /// Plans at which speeds a vehicle takes its bends, and stops at its end.
  void plan_speeds(const VehicleSize& size);
  /// Speed that is planned at a way along it [m/s]; without a plan infinite.
  double speed_at(double way) const;

  std::vector<Vec3d> points;    ///< close to each other
  std::vector<double> lengths;  ///< up to each [m]
  std::vector<double> speeds;   ///< planned at each [m/s]; empty = any
  bool loop = false;

 private:
  double wrapped_way(double way) const;
  size_t row_after(double way) const;
};

}  // namespace gloam
