#pragma once
// Participating media, without MuJoCo types: what a medium is made of, and where how much of it is.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/vec.h"
#include "gloam/result.h"

namespace gloam {

/// Bands of sensors: each uses its own band of the same field.
enum class MediumBand : uint8_t { kRed, kGreen, kBlue, k905nm, k1550nm, k8to14um };
inline constexpr int kMediumBands = 6;

/// Optical properties per band, in the order of MediumBand.
struct MediumDescription {
  std::string name;
  std::array<float, kMediumBands> mass_extinction{};  ///< [m²/kg], >= 0
  std::array<float, kMediumBands> albedo{};           ///< albedo of single scattering, 0..1
  std::array<float, kMediumBands> g{};  ///< mean cosine of scattering (Henyey–Greenstein), -1..1
  /// Emission per metre, relative to a black body of its absorption coefficient and temperature: 1
  /// by Kirchhoff's law, 0 = dark. Red, green and blue alone.
  float emission = 0;
};

/// Values at the centres of voxels, x fastest, (nz x ny x nx). Shared: whoever solves for the field
/// hands over a new one for every instant and never writes to it again.
using VolumeGrid = std::shared_ptr<const std::vector<float>>;

/// Volumes of more voxels than this are refused (1 GiB of floats).
inline constexpr uint64_t kMaxVolumeVoxels = uint64_t{1} << 28;

/// Over so many mean free paths contrast falls to 2 % (Koschmieder 1924): visibility times
/// extinction, at 550 nm.
inline constexpr double kKoschmieder = 3.912;

/// Thicker media are refused [1/m]: they are surfaces.
inline constexpr float kMaxExtinction = 1e5f;

/// A box that holds a medium; between voxels the field is trilinear, and constant from the
/// outermost voxels' centres to the walls.
struct VolumeDescription {
  std::string name;
  int medium = 0;       ///< row of the media
  Affine3f X_WV;        ///< rigid; V sits at the centre of the box
  Vec3f size{1, 1, 1};  ///< edges of the box [m]
  int nx = 1, ny = 1, nz = 1;
  VolumeGrid density;            ///< [kg/m³], >= 0; null = even_density everywhere
  VolumeGrid temperature;        ///< [K], >= 0; null = even_temperature everywhere
  float even_density = 0;        ///< [kg/m³]
  float even_temperature = 293;  ///< [K]
  float fade = 0;      ///< the density falls smoothly to zero over this distance from the walls [m]
  int field = -1;      ///< row of PoseFrame::fields, whose grids it shows instead; -1 = none
  bool flame = false;  ///< shows that field's flames
};

/// Errors: values that are not finite or outside their range.
Status check_medium(const MediumDescription& medium);
/// Errors: sizes that are not positive, too many voxels, grids that do not hold one value per
/// voxel. The values themselves are checked where they are read.
Status check_volume(const VolumeDescription& volume, size_t media);
/// To be asked before memory for a grid is.
Status check_volume_voxels(const std::string& name, int64_t nx, int64_t ny, int64_t nz);

}  // namespace gloam
