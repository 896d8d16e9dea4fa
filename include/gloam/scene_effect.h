#pragma once
// Smoke and fire of a scene file: [[gas]], [[fire]] and [[smoke]]. Part of gloam/scene.h;
// docs/effects.md has the models and their sources.

#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[gas]]: a box of air that is solved for: smoke, heat and what moves them. Colliders are walls
/// in it. Without one, fires and smoke get the generated place's rooms, or 8 x 8 x 4 m around them.
struct GasOptions {
  std::string name = {};              ///< unique
  std::optional<Vec3> position = {};  ///< of the box's centre [m]
  std::optional<Vec3> size = {};      ///< edges [m]; with neither: as without a [[gas]]
  std::optional<double> voxel = {};   ///< edge of a cell [m]; empty = 0.1, or more in large boxes
  Rational rate = {10, 1};            ///< steps of the solver per second of simulation time
  std::string medium = "smoke";       ///< what is carried, as of [[volume]]
  std::string fuel = "polyurethane";  ///< of its fires: propane heptane wood pmma
                                      ///< polyurethane polystyrene
  double temperature = 293;           ///< of the air around [K]
  std::optional<Vec3> wind = {};      ///< of the air around, blows in at open sides [m/s]; empty =
                                      ///< that of [weather]
  std::vector<std::string> closed = {};  ///< sides nothing passes: -x +x -y +y -z +z
  double vorticity = 0.4;                ///< confinement of eddies, 0 … 1
  double cooling = 0.02;                 ///< share of the heat that is lost each second [1/s]
  double settling = 0;                   ///< share of the smoke that is lost each second [1/s]
  SourceLoc loc = {};
};

/// [[fire]]: what burns, and how strongly.
struct FireOptions {
  std::string name = {};            ///< unique
  std::string body = {};            ///< full name of the body it is on; empty = world
  Vec3 position = {};               ///< of the middle of what burns, in that body [m]
  Vec3 size = {0.6, 0.6, 0.2};      ///< of the box in which fuel becomes gas [m]
  double power = 200e3;             ///< heat released once it has grown [W]
  std::string growth = "instant";   ///< NFPA's t²: instant slow medium fast ultrafast
  double start = 0;                 ///< [s]
  std::optional<double> stop = {};  ///< [s]; empty = it burns on
  SourceLoc loc = {};
};

/// [[smoke]]: a source without flames: a smoke machine, an exhaust, a steaming pot.
struct SmokeOptions {
  std::string name = {};              ///< unique
  std::string body = {};              ///< full name of the body it is on; empty = world
  Vec3 position = {};                 ///< of its middle, in that body [m]
  Vec3 size = {0.2, 0.2, 0.2};        ///< of the box that it comes from [m]
  double rate = 1e-4;                 ///< of the medium [kg/s]
  double heat = 0;                    ///< that comes with it [W]
  std::optional<Vec3> velocity = {};  ///< of the air in the box, in that body [m/s]
  double start = 0;                   ///< [s]
  std::optional<double> stop = {};    ///< [s]; empty = it goes on
  SourceLoc loc = {};
};

}  // namespace gloam
