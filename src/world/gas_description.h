#pragma once
// The scene file's [[gas]], [[fire]] and [[smoke]] tables on the compiled model, without MuJoCo
// types: boxes of air, and what gives smoke and heat to them.

#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "gloam/result.h"
#include "gloam/scene.h"
#include "world/medium_description.h"

namespace gloam {

struct CompiledWorld;

/// What burns, by its heat and its soot.
struct FuelDescription {
  float heat_of_combustion = 0;  ///< chemical [J/kg]
  float soot_yield = 0;          ///< soot per fuel [kg/kg]
  float radiated = 0;            ///< share of the heat that leaves as radiation
};

/// Gives fuel, smoke or heat from `start` to `stop`.
struct GasSourceDescription {
  std::string name;
  int body = 0;  ///< that it moves with
  Affine3f X_BS;
  Vec3f half_size;             ///< of its box [m]
  float power = 0;             ///< of a fire that has grown [W]
  float growth = 0;            ///< of a fire: power = growth t² [W/s²]; 0 = at once
  float smoke = 0;             ///< [kg/s]
  float heat = 0;              ///< [W]
  std::optional<Vec3f> jet;    ///< velocity of the air in it, in the body [m/s]
  double start = 0, stop = 0;  ///< [s]

  /// Heat released by a fire at a time [W].
  float power_at(double time) const;
  bool is_on(double time) const { return time >= start && time < stop; }
};

struct GasDescription {
  std::string name;
  Vec3f low;                   ///< corner of the box [m], axes along the world's
  int nx = 0, ny = 0, nz = 0;  ///< voxels
  float voxel = 0;             ///< [m]
  Rational rate;               ///< [Hz]
  MediumDescription medium;
  FuelDescription fuel;
  float temperature = 0;      ///< of the air around [K]
  std::optional<Vec3f> wind;  ///< [m/s]; empty = the scene's
  bool open[6] = {};          ///< sides of the box: -x +x -y +y -z +z
  float vorticity = 0, cooling = 0, settling = 0;
  SourceLoc loc;

  Vec3f size() const {
    return {voxel * static_cast<float>(nx), voxel * static_cast<float>(ny),
            voxel * static_cast<float>(nz)};
  }
};

struct GasesDescription {
  std::vector<GasDescription> gases;
  std::vector<GasSourceDescription> sources;  ///< each gives to whichever gas it is in
};

/// Errors: no such body or medium, a source in no box, boxes that overlap or have too many voxels.
Result<GasesDescription> describe_gases(const CompiledWorld& world);

}  // namespace gloam
