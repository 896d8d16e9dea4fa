#pragma once
// The scene file's [[gas]], [[fire]], [[smoke]], [[rotor]] and [[dust]] tables on the compiled
// model, without MuJoCo types: boxes of air, what gives smoke and heat to them, what stirs them.

#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "gloam/result.h"
#include "gloam/scene.h"
#include "world/media/medium_description.h"

namespace gloam {

struct CompiledWorld;

/// A fuel: its heat and its soot.
struct FuelDescription {
  float heat_of_combustion = 0;  ///< chemical [J/kg]
  float soot_yield = 0;          ///< soot per fuel [kg/kg]
  float radiated = 0;            ///< fraction of the heat that leaves as radiation
};

/// Gives fuel, smoke or heat from `start` to `stop`.
struct GasSourceDescription {
  std::string name;
  int body = 0;  ///< body that it moves with
  Affine3f X_BS;
  Vec3f half_size;             ///< half size of its box [m]
  float power = 0;             ///< power of a fire that has grown [W]
  float growth = 0;            ///< growth of a fire: power = growth t² [W/s²]; 0 = at once
  float smoke = 0;             ///< [kg/s]
  float heat = 0;              ///< [W]
  std::optional<Vec3f> jet;    ///< velocity of the air in it, in the body [m/s]
  double start = 0, stop = 0;  ///< [s]

  /// Heat released by a fire at a time [W].
  float power_at(double time) const;
  bool is_on(double time) const { return time >= start && time < stop; }
  /// Heat that a fire has released until `time` [J]: the integral of power_at.
  double heat_until(double time) const;
  /// Means over an interval: of power_at [W], and of is_on as 0 or 1.
  float mean_power(double from, double to) const;
  float share_on(double from, double to) const;
};

/// A disc that drives air against its thrust.
struct RotorDescription {
  std::string name;
  int body = 0;             ///< body that it moves with
  int actuator = -1;        ///< actuator whose force is the thrust; -1 = none
  Vec3f p_B;                ///< place of its hub [m]
  Vec3f axis_B;             ///< unit, along which positive thrust points
  float thrust = 0;         ///< [N]; per unit of the actuator's force, if there is one
  float radius = 0;         ///< [m]
  std::vector<int> blades;  ///< colliders that lie in the disc: air goes through them
};

/// Ground in a box that gives dust.
struct DustDescription {
  std::string name;
  Vec3f low, high;           ///< corners [m]
  float silt = 0, clay = 0;  ///< fractions, as in DustOptions
  float threshold = 0;       ///< friction velocity [m/s]
  bool holds(Vec3f p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
};

struct GasDescription {
  std::string name;
  Vec3f low;                   ///< corner of the box [m], axes along the world's
  int nx = 0, ny = 0, nz = 0;  ///< voxels
  float voxel = 0;             ///< [m]
  Rational rate;               ///< [Hz]
  MediumDescription medium;
  FuelDescription fuel;
  float flame_absorption = 0;  ///< flame_absorption_per_heat(); 0 = nothing burns
  float temperature = 0;       ///< temperature of the air around [K]
  std::optional<Vec3f> wind;   ///< [m/s]; empty = the scene's
  bool open[6] = {};           ///< sides of the box: -x +x -y +y -z +z
  float vorticity = 0, cooling = 0, settling = 0;
  SourceLoc loc;

  Vec3f size() const {
    return {voxel * static_cast<float>(nx), voxel * static_cast<float>(ny),
            voxel * static_cast<float>(nz)};
  }
  bool holds(const Vec3& p) const {
    const Vec3f edges = size();
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= low.x + edges.x &&
           p.y <= low.y + edges.y && p.z <= low.z + edges.z;
  }
};

struct GasesDescription {
  std::vector<GasDescription> gases;
  std::vector<GasSourceDescription> sources;  ///< each gives to whichever gas it is in
  std::vector<RotorDescription> rotors;       ///< likewise
  std::vector<DustDescription> dusts;  ///< areas of dust; the first of those that overlap counts
};

/// Errors: no such body or medium, a source in no box, boxes that overlap or have too many voxels.
Result<GasesDescription> describe_gases(const CompiledWorld& world);

}  // namespace gloam
