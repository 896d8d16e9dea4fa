#pragma once
// The scene file's [[soil]] tables as numbers: the cells of a bed of soft ground, where their
// surface lies before anything steps on it, and what the ground resists with.

#include <mujoco/mujoco.h>

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
  double tan_friction = 0;  ///< of the angle of internal friction
  double shear = 0.01;      ///< K [m]
  double k_0 = 0;           ///< [N/m³]
  double a_u = 0;           ///< [N/m⁴]
  double aside = 0;         ///< share of what is displaced that rises beside it
};

struct SoilDescription {
  std::string name, kind;
  double x = 0, y = 0;            ///< middle [m]
  double size_x = 0, size_y = 0;  ///< [m]
  double depth = 0;               ///< [m]
  int nx = 0, ny = 0;             ///< cells, rows along y
  double dx = 0, dy = 0;          ///< of a cell [m]
  double level = 0;               ///< z of a level surface, or of the highest cell's [m]
  std::vector<float> rest;        ///< z of each cell's surface at rest [m]; empty = `level`
  SoilStrength strength;
  SourceLoc loc;

  double low_x() const { return x - size_x / 2; }
  double low_y() const { return y - size_y / 2; }
  size_t cells() const { return static_cast<size_t>(nx) * static_cast<size_t>(ny); }
  double rest_of(size_t cell) const { return rest.empty() ? level : double{rest[cell]}; }
};

/// What was measured of a kind of ground, as docs/soil.md has it. `kind`: of kSoilKinds.
SoilStrength soil_strength(const std::string& kind);

/// Errors: beds that overlap, of too many cells, over ground where there is none.
Result<std::vector<SoilDescription>> describe_soils(const Scene& scene, const mjModel& model);

}  // namespace gloam
