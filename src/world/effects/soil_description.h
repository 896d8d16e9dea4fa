#pragma once
// The scene file's [[soil]] tables as numbers: the cells of a bed of soft ground, where their
// surface lies before anything steps on it, and what the ground resists with.

#include <mujoco/mujoco.h>

#include <algorithm>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

/// Bekker's p = (k_c / b + k_phi) z^n, Mohr and Coulomb's c + p tan(phi), Janosi and Hanamoto's K,
/// Wong's k_u = k_0 + a_u z.
struct SoilStrength {
  double n = 1;             ///< exponent of sinkage
  double k_c = 0;           ///< [N/m^(n+1)]
  double k_phi = 0;         ///< [N/m^(n+2)]
  double cohesion = 0;      ///< [Pa]
  double tan_friction = 0;  ///< tangent of the angle of internal friction
  double shear = 0.01;      ///< K [m]
  double k_0 = 0;           ///< [N/m³]
  double a_u = 0;           ///< [N/m⁴]
  double aside = 0;         ///< fraction of what is displaced that rises beside it
  bool walls_stand = true;  ///< walls of prints do; else they fall in as the body leaves
};

struct SoilDescription {
  std::string name, kind;
  double x = 0, y = 0;            ///< middle [m]
  double size_x = 0, size_y = 0;  ///< [m]
  double depth = 0;               ///< depth where all of it lies [m]
  double growth = 0;              ///< growth of `depth` under falling snow [m/s]
  bool fallen = false;            ///< it is what [weather] has let fall
  int nx = 0, ny = 0;             ///< cells, rows along y
  double dx = 0, dy = 0;          ///< size of a cell [m]
  double level = 0;               ///< z of a level surface, or of the highest cell's [m]
  std::vector<float> rest;        ///< z of each cell's surface at rest [m]; empty = `level`
  std::vector<float> share;       ///< fraction of `depth` that lies in each cell, 0 … 1; empty = 1
  SoilStrength strength;
  SourceLoc loc;

  double low_x() const { return x - size_x / 2; }
  double low_y() const { return y - size_y / 2; }
  size_t cells() const { return static_cast<size_t>(nx) * static_cast<size_t>(ny); }
  /// At time 0; `level`, `rest` and `depth` are of then.
  double rest_of(size_t cell) const { return rest.empty() ? level : double{rest[cell]}; }
  double share_of(size_t cell) const { return share.empty() ? 1 : double{share[cell]}; }
  /// Depth over rest_of() at a time at which `fallen_depth` = growth * time [m].
  double depth_of(size_t cell, double fallen_depth) const {
    return share_of(cell) * (depth + fallen_depth);
  }
};

/// Height of a track against the undisturbed surface [m], of which what falls evens out: `kept` is
/// it with what had fallen when it was made added away from 0, `fallen` what has by now [m].
inline float track_height(float kept, float fallen) {
  return kept < 0 ? std::min(kept + fallen, 0.0f) : std::max(kept - fallen, 0.0f);
}

/// Measured strength of a kind of ground, after docs/soil.md. `kind`: one of kSoilKinds.
SoilStrength soil_strength(const std::string& kind);

/// Errors: beds that overlap, of too many cells, over ground where there is none, snow that falls
/// where no sky is open.
Result<std::vector<SoilDescription>> describe_soils(const Scene& scene, const mjModel& model);

}  // namespace gloam
