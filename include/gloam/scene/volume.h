#pragma once
// Volumes of smoke, fog and dust: [[volume]]. Part of gloam/scene.h; docs/media.md has examples.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [volume.pattern]: a procedural density, 0 … 1, multiplied by the density of the volume.
struct VolumePatternOptions {
  std::string kind = {};  ///< plume: rises from the middle of the floor; cloud: fills the box
  uint64_t seed = 0;      ///< another shape of the same kind
  int resolution = 64;    ///< voxels along the longest edge, 8 … 256
  SourceLoc loc = {};
};

/// [[volume]]: a box that contains a medium. Its amount is `density` or `visibility`, uniform or
/// for the value one of `grid` or `pattern`.
struct VolumeOptions {
  std::string name = {};                 ///< unique
  Vec3 position = {};                    ///< centre of the box in the world [m]
  std::optional<Quat> orientation = {};  ///< rotation of the box in the world
  Vec3 size = {};                        ///< edges of the box [m]
  std::string medium = {};               ///< smoke fog mist haze dust; empty = the numbers below
  /// Optical numbers: one for all bands, or one each for red, green, blue, 905 nm, 1550 nm, 8–14
  /// µm.
  std::vector<double> mass_extinction = {};  ///< [m²/kg]
  std::vector<double> albedo = {};           ///< single-scattering albedo, 0 … 1
  std::vector<double> g = {};                ///< mean cosine of scattering, -1 … 1
  std::optional<double> density = {};        ///< [kg/m³]
  std::optional<double> visibility =
      {};                    ///< distance at which contrast falls to 2 %, in green light [m]
  double temperature = 293;  ///< [K]
  /// Thermal emission of light, relative to a black body (1: Kirchhoff's law).
  double emission = 0;
  double fade = 0;  ///< distance from the walls over which the density falls smoothly to zero [m]
  std::filesystem::path grid = {};              ///< density: .npy of float32, (nz, ny, nx)
  std::filesystem::path temperature_grid = {};  ///< temperatures [K], of the same shape
  std::optional<VolumePatternOptions> pattern = {};
  SourceLoc loc = {};
};

}  // namespace gloam
