#pragma once
// The scene file's [[agent]] and [[crowd]] tables without MuJoCo types: who there is, how large
// they are, and which bodies of the compiled model are theirs.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"
#include "places/vehicles.h"

namespace gloam {

struct CompiledWorld;

/// Order of kAgentKinds.
enum class AgentKind : uint8_t { kPerson, kCart, kForklift, kCar };
/// Order of kAgentBehaviors.
enum class AgentBehavior : uint8_t { kStand, kWander, kRoute, kSpline, kTree };

/// Moving rigid parts of a person. The frame of each is at the joint that it hangs from, the
/// pelvis's between the hips: x forward, y left, z up while standing with arms down.
enum PersonPart {
  kPelvis,
  kChest,
  kHead,
  kThighL,
  kShankL,
  kFootL,
  kThighR,
  kShankR,
  kFootR,
  kUpperArmL,
  kForearmL,
  kUpperArmR,
  kForearmR,
  kPersonParts
};
/// Parts of a vehicle that move as one; wheels in the order of kWheelNames, then the fork of a
/// forklift.
enum VehiclePart { kChassis, kWheelFL, kWheelFR, kWheelRL, kWheelRR, kFork, kVehicleParts };

/// "pelvis", "chassis" …; empty for a part that the kind does not have.
std::string_view part_name(AgentKind kind, int part);
int part_count(AgentKind kind);

/// Lengths of a person [m]: fractions of the height after Drillis and Contini 1966 (in Winter,
/// Biomechanics and Motor Control of Human Movement, fig. 4.1), varied by a few percent.
struct PersonShape {
  double height = 1.7;
  double girth = 1;         ///< thickness of trunk and limbs, of the mean
  double hip_height = 0.9;  ///< height of the hip joints while standing
  double hip = 0.08;        ///< distance of a hip joint from the middle
  double thigh = 0.41, shank = 0.42;
  double ankle = 0.066;  ///< above the sole
  double foot = 0.26;    ///< length
  double waist = 0.17;   ///< height of the chest's frame above the pelvis's
  double trunk = 0.33;   ///< from there up to the shoulders
  double shoulder = 0.19;
  double upper_arm = 0.31, forearm = 0.42;  ///< the latter with the hand
  double neck = 0.05;                       ///< height of the head's frame above the shoulders
  double mass = 72;                         ///< [kg]
};
/// Drawn by the seed: heights are normal, of women and men alike (1.69 m, deviation 0.09; NCD-RisC
/// 2016's means of both sexes in Europe), `height` [m] fixes it.
PersonShape draw_person(uint64_t seed, std::optional<double> height);

const VehicleSize& vehicle_size(AgentKind kind);

struct AgentDescription {
  std::string name;
  AgentKind kind = AgentKind::kPerson;
  AgentBehavior behavior = AgentBehavior::kWander;
  uint64_t seed = 0;       ///< its own: of the options and the name
  bool is_placed = false;  ///< else it begins at a random place that it can reach
  Vec3 position;           ///< [m]
  double heading = 0;      ///< from +x to +y [rad]
  double speed = 0;        ///< preferred speed [m/s]
  double radius = 0;       ///< distance that it keeps from walls [m]
  double height = 0;       ///< headroom that it needs [m]
  std::vector<WaypointOptions> route;
  bool loop = true;
  std::filesystem::path tree;
  double start = 0;  ///< [s]
  bool yields = true;
  SourceLoc loc;
  PersonShape person;   ///< shape, if it is a person
  VehicleSize vehicle;  ///< else

  int parts() const { return part_count(kind); }
  /// Name of the body of a part: NAME for the first, else NAME/PART.
  std::string body_name(int part) const;
  // In the compiled model, by part.
  std::array<int, kPersonParts> body = {}, mocap = {};
};

/// Those of a scene, crowds after agents, without bodies. Errors: a speed that a kind does not
/// reach.
Result<std::vector<AgentDescription>> list_agents(const Scene& scene);

/// Those of a compiled World, with their bodies.
Result<std::vector<AgentDescription>> describe_agents(const CompiledWorld& world);

}  // namespace gloam
