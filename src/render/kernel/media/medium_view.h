#pragma once
// Participating media as the kernel reads them, and what they are at a point. Device-safe.

#include "render/kernel/math/ray.h"
#include "world/media/medium_description.h"

namespace gloam {

/// Edge of a cell of the grid of bounds, in voxels.
inline constexpr int kBoundsVoxels = 8;
/// Volumes of a scene, at most: a ray may pass through all of them at once.
inline constexpr int kMaxVolumes = 32;

/// Bounds that no lookup in a cell exceeds.
struct CellBounds {
  float low = 0, high = 0;  ///< of the density [kg/m³]
  float hottest = 0;        ///< [K]
};

/// Three bands that are computed side by side: red, green and blue of a camera, or one band thrice.
struct Bands {
  int band[3] = {0, 1, 2};
  GLOAM_HD static Bands only(MediumBand b) {
    const int i = static_cast<int>(b);
    return {{i, i, i}};
  }
  GLOAM_HD Vec3f of(const float* values) const {
    return {values[band[0]], values[band[1]], values[band[2]]};
  }
  GLOAM_HD bool is_visible() const { return band[0] == 0 && band[1] == 1 && band[2] == 2; }
};

struct VolumeView {
  Affine3f X_GW;  ///< world to voxels: the box is [0, nx] x [0, ny] x [0, nz]
  Vec3f voxel;    ///< edges of a voxel [m]
  int nx = 1, ny = 1, nz = 1;
  int cells_x = 1, cells_y = 1, cells_z = 1;
  float even_density = 0, even_temperature = 0, fade = 0;  ///< [kg/m³], [K], [m]
  DeviceSpan<const float> density, temperature;            ///< [kg/m³], [K]; empty = even
  DeviceSpan<const CellBounds> cells;                      ///< (cells_z x cells_y x cells_x)
  float mass_extinction[kMediumBands] = {};                ///< [m²/kg]
  float albedo[kMediumBands] = {};
  float g[kMediumBands] = {};
  float emission = 0;
  int glow = -1;         ///< row of MediaView::glows
  bool changes = false;  ///< its grids are others in every picture
};

/// Emission of a volume, for sampling points of it: a cell of the grid of bounds, then one of its
/// voxels. Steers sampling alone.
struct GlowView {
  static constexpr uint32_t kSums = kBoundsVoxels * kBoundsVoxels * kBoundsVoxels + 1;
  uint32_t volume = 0;
  Affine3f X_WG;                       ///< voxels to world
  Vec3f low_G, high_G;                 ///< corners of a box that holds all that glows [voxels]
  Vec3f center;                        ///< of that [m]
  float reach = 0;                     ///< half its diagonal [m]
  float strength = 0;                  ///< mean luminous intensity, at most [cd]
  float voxels_per_volume = 0;         ///< [1/m³]
  DeviceSpan<const float> cell_sums;   ///< running sums of the cells' probabilities, 0 to 1
  DeviceSpan<const int> rows;          ///< of each cell; -1 = dark
  DeviceSpan<const float> voxel_sums;  ///< the same of a cell's voxels, x fastest; kSums in a row
};

/// Luminance of black bodies by 1 / T, from kLow to kHigh.
struct BlackBodyTable {
  static constexpr int kSize = 1024;
  static constexpr float kLow = 800, kHigh = 10000;  ///< [K]
  DeviceSpan<const Vec3f> luminance;                 ///< linear Rec. 709 [cd/m²], (kSize)

  /// Darkness below kLow (there it is under 0.01 cd/m²); above kHigh as there.
  GLOAM_HD Vec3f at(float temperature) const {
    if (!(temperature >= kLow) || luminance.empty()) return {};
    const float x =
        (1 / kLow - 1 / min(temperature, kHigh)) * ((kSize - 1) / (1 / kLow - 1 / kHigh));
    const int i = static_cast<int>(min(x, kSize - 2.0f));
    return lerp(luminance[i], luminance[i + 1], x - static_cast<float>(i));
  }
};

struct MediaView {
  DeviceSpan<const VolumeView> volumes;
  DeviceSpan<const GlowView> glows;
  BlackBodyTable black_body;
};

namespace media {

/// Trilinear between the centres of voxels, constant outside them.
GLOAM_HD float grid_at(const VolumeView& v, const float* grid, Vec3f p_G) {
  const float x = clamp(p_G.x - 0.5f, 0.0f, static_cast<float>(v.nx - 1));
  const float y = clamp(p_G.y - 0.5f, 0.0f, static_cast<float>(v.ny - 1));
  const float z = clamp(p_G.z - 0.5f, 0.0f, static_cast<float>(v.nz - 1));
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
  const int dx = i + 1 < v.nx ? 1 : 0, dy = j + 1 < v.ny ? v.nx : 0;
  const int dz = k + 1 < v.nz ? v.nx * v.ny : 0;
  const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
  const float* at = grid + (k * v.ny + j) * v.nx + i;
  const auto plane = [&](const float* a) {
    return lerp(lerp(a[0], a[dx], fx), lerp(a[dy], a[dy + dx], fx), fy);
  };
  return lerp(plane(at), plane(at + dz), z - static_cast<float>(k));
}

/// [kg/m³] at a point inside the box.
GLOAM_HD float density_at(const VolumeView& v, Vec3f p_G) {
  float density = v.density.empty() ? v.even_density : grid_at(v, v.density.data, p_G);
  if (v.fade > 0) {
    const float x = min(p_G.x, static_cast<float>(v.nx) - p_G.x) * v.voxel.x;
    const float y = min(p_G.y, static_cast<float>(v.ny) - p_G.y) * v.voxel.y;
    const float z = min(p_G.z, static_cast<float>(v.nz) - p_G.z) * v.voxel.z;
    const float s = clamp(min(x, min(y, z)) / v.fade, 0.0f, 1.0f);
    density *= s * s * (3.0f - 2.0f * s);
  }
  return density;
}

/// [K] at a point inside the box.
GLOAM_HD float temperature_at(const VolumeView& v, Vec3f p_G) {
  return v.temperature.empty() ? v.even_temperature : grid_at(v, v.temperature.data, p_G);
}

GLOAM_HD bool is_inside(const VolumeView& v, Vec3f p_G) {
  return p_G.x >= 0 && p_G.y >= 0 && p_G.z >= 0 && p_G.x <= static_cast<float>(v.nx) &&
         p_G.y <= static_cast<float>(v.ny) && p_G.z <= static_cast<float>(v.nz);
}

/// Something in a cell may glow in these bands.
GLOAM_HD bool glows(const VolumeView& v, float hottest, Bands bands) {
  return v.emission > 0 && hottest >= BlackBodyTable::kLow && bands.is_visible();
}

/// Radiance of black bodies at this point, times the medium's emission [cd/m²].
GLOAM_HD Vec3f glow_at(const MediaView& media, const VolumeView& v, Vec3f p_G, Bands bands) {
  if (!(v.emission > 0) || !bands.is_visible()) return {};
  return media.black_body.at(temperature_at(v, p_G)) * v.emission;
}

}  // namespace media
}  // namespace gloam
