#include "world/weather/weather_air.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/mesh/single.h"
#include "world/media/medium_presets.h"
#include "world/media/volume_pattern.h"
#include "world/render_description.h"
#include "world/shapes/extent.h"
#include "world/weather/shelter_map.h"

namespace gloam {
namespace {

constexpr double kInWalls = 0.1;       // [m] of what hangs in rooms beyond their faces
constexpr float kBillowReach = 480;    // [m] to each side of the middle, in which fog billows
constexpr int kAlong = 192;            // voxels of billows along an edge
constexpr float kPerScaleHeight = 32;  // voxels of a profile without billows
constexpr float kRoofVoxel = 0.5f;     // edge of a voxel under roofs, at least [m]
constexpr int kMostRoofVoxels = 256;   // along an edge
constexpr float kRoofHeight = 1.5f;    // height over the lowest ground of what is a roof [m]

struct Box {
  Vec3f low, high;
};

Box air_everywhere(const RenderDescription& description, float from, float to) {
  constexpr float kGrid = 0.5f * kAirReach;
  const Vec3f c = description.center;
  const float x = std::round(c.x / kGrid) * kGrid, y = std::round(c.y / kGrid) * kGrid;
  return {{x - kAirReach, y - kAirReach, from}, {x + kAirReach, y + kAirReach, to}};
}

/// All rooms, and kInWalls into their walls.
Box air_in(std::span<const Region> rooms) {
  const Extent extent = extent_of(rooms, kInWalls);
  return {to_vec3f(extent.low), to_vec3f(extent.high)};
}

VolumeDescription volume_of(const Box& box, std::string name, int medium, float density) {
  VolumeDescription volume;
  volume.name = std::move(name);
  volume.medium = medium;
  volume.size = box.high - box.low;
  volume.X_WV.p = (box.low + box.high) * 0.5f;
  volume.even_density = density;
  return volume;
}

/// visit(part of `all` around `inner`), which reaches as far up and down as `all`.
template <class Visit>
void each_side(const Box& all, const Box& inner, const Visit& visit) {
  const float bottom = all.low.z, top = all.high.z;
  visit(Box{{all.low.x, all.low.y, bottom}, {inner.low.x, all.high.y, top}});
  visit(Box{{inner.high.x, all.low.y, bottom}, {all.high.x, all.high.y, top}});
  visit(Box{{inner.low.x, all.low.y, bottom}, {inner.high.x, inner.low.y, top}});
  visit(Box{{inner.low.x, inner.high.y, bottom}, {inner.high.x, all.high.y, top}});
}

/// Densities of the box, thinner with the height over `base`; in billows, whose mean is one, if
/// `turbulence` > 0.
void set_profile(const WeatherOptions& options, double turbulence, uint64_t seed,
                 VolumeDescription* volume) {
  const auto count = [](float edge, float step) {
    return std::max(2, static_cast<int>(std::lround(edge / step)));
  };
  const auto scale = static_cast<float>(options.scale_height);
  volume->nx = volume->ny = 2;
  float step = scale > 0 ? scale / kPerScaleHeight : volume->size.z;
  if (turbulence > 0) {
    const float voxel = max(volume->size.x, volume->size.y) / kAlong;
    volume->nx = count(volume->size.x, voxel), volume->ny = count(volume->size.y, voxel);
    step = std::min(1.0f, volume->size.z / 12);
  }
  volume->nz = std::min(count(volume->size.z, step), 1024);
  const float low = volume->X_WV.p.z - 0.5f * volume->size.z - static_cast<float>(options.base);
  volume->density = std::make_shared<const std::vector<float>>(
      haze_layer({volume->nx, volume->ny, volume->nz}, volume->size, low, options.scale_height,
                 turbulence, volume->even_density, seed));
}

/// Bounds of the roofs: what keeps off what falls, in columns from the lowest ground up.
bool find_roofs(const ShelterMap& map, Box* roofs) {
  *roofs = {{1e30f, 1e30f, map.lowest}, {-1e30f, -1e30f, -1e30f}};
  for (int j = 0; j < map.ny; ++j) {
    for (int i = 0; i < map.nx; ++i) {
      const float top =
          map.height[static_cast<size_t>(j) * static_cast<size_t>(map.nx) + static_cast<size_t>(i)];
      if (!(top > map.lowest + kRoofHeight)) continue;
      const float x = map.low.x + map.cell * static_cast<float>(i);
      const float y = map.low.y + map.cell * static_cast<float>(j);
      roofs->low = {std::min(roofs->low.x, x), std::min(roofs->low.y, y), roofs->low.z};
      roofs->high = {std::max(roofs->high.x, x + map.cell), std::max(roofs->high.y, y + map.cell),
                     std::max(roofs->high.z, top)};
    }
  }
  return roofs->high.x > roofs->low.x;
}

/// Voxels of the box in which it falls, and those under a roof.
void set_open(const ShelterView& sky, float voxel, const Box& box, VolumeDescription* volume) {
  const auto count = [&](float edge) {
    return std::max(2, static_cast<int>(std::ceil(edge / voxel)));
  };
  volume->nx = count(volume->size.x), volume->ny = count(volume->size.y);
  volume->nz = count(volume->size.z);
  std::vector<float> density;
  density.reserve(static_cast<size_t>(volume->nx) * static_cast<size_t>(volume->ny) *
                  static_cast<size_t>(volume->nz));
  const Vec3f step{volume->size.x / static_cast<float>(volume->nx),
                   volume->size.y / static_cast<float>(volume->ny),
                   volume->size.z / static_cast<float>(volume->nz)};
  for (int k = 0; k < volume->nz; ++k) {
    for (int j = 0; j < volume->ny; ++j) {
      for (int i = 0; i < volume->nx; ++i) {
        const Vec3f middle{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f,
                           static_cast<float>(k) + 0.5f};
        density.push_back(volume->even_density *
                          sky.open_above(box.low + middle * step, 0.5f * voxel));
      }
    }
  }
  volume->density = std::make_shared<const std::vector<float>>(std::move(density));
}

}  // namespace

Status add_fog(const WeatherOptions& options, std::span<const Region> rooms, uint64_t seed,
               RenderDescription* out) {
  const std::string kind = options.medium.value_or("fog"), name = "weather/" + kind;
  const MediumDescription* medium = find_medium(kind);
  if (medium == nullptr) {
    return Error{ErrorKind::kInput, fmt::format("weather: there is no medium '{}'", kind),
                 options.loc, suggest_name(kind, medium_names())};
  }
  const float density = static_cast<float>(kKoschmieder / *options.visibility) /
                        medium->mass_extinction[static_cast<size_t>(MediumBand::kGreen)];
  const int row = static_cast<int>(out->media.size());
  out->media.push_back(*medium);
  const auto scale = static_cast<float>(options.scale_height);
  const auto base = static_cast<float>(options.base);
  const bool is_even = !(scale > 0) && !(options.turbulence > 0);
  const auto add = [&](const Box& box, bool has_profile, double turbulence) {
    VolumeDescription volume = volume_of(box, name, row, density);
    if (has_profile) set_profile(options, turbulence, seed, &volume);
    out->volumes.push_back(std::move(volume));
  };
  if (options.where == "rooms") {
    add(air_in(rooms), !is_even, options.turbulence);
    return {};
  }
  const float top = base + (scale > 0 ? kScaleHeights * scale : static_cast<float>(options.height));
  if (is_even) {
    add(air_everywhere(*out, base - kAirDepth, top), false, 0);
    return {};
  }
  add(air_everywhere(*out, base - kAirDepth, base), false, 0);
  const Box above = air_everywhere(*out, base, top);
  if (!(options.turbulence > 0)) {
    add(above, true, 0);
    return {};
  }
  const Vec3f around{kAirReach - kBillowReach, kAirReach - kBillowReach, 0};
  const Box billows{above.low + around, above.high - around};
  add(billows, true, options.turbulence);
  each_side(above, billows, [&](const Box& side) { add(side, scale > 0, 0); });
  return {};
}

void add_falling(const ParticleSet& particles, const WeatherOptions& options,
                 RenderDescription* out) {
  const auto base = static_cast<float>(options.base);
  MediumDescription medium = medium_of(particles);
  const std::string name = "weather/" + medium.name;
  const int row = static_cast<int>(out->media.size());
  out->media.push_back(std::move(medium));
  const Box all = air_everywhere(*out, base - kAirDepth, base + kFallHeight);
  const auto add = [&](const Box& box) {
    if (!(box.high.x > box.low.x && box.high.y > box.low.y && box.high.z > box.low.z)) return;
    out->volumes.push_back(volume_of(box, name, row, particles.water));
  };
  // A roof keeps off what falls: around roofs the air is of voxels that are under one or not.
  const ShelterMap& map = *out->weather.shelter;
  Box roofs;
  if (!find_roofs(map, &roofs)) return add(all);
  const float edge = std::max(roofs.high.x - roofs.low.x, roofs.high.y - roofs.low.y);
  const float voxel = std::max(kRoofVoxel, edge / kMostRoofVoxels);
  roofs = {roofs.low - Vec3f{voxel, voxel, 0}, roofs.high + Vec3f{voxel, voxel, voxel}};
  VolumeDescription sheltered = volume_of(roofs, name, row, particles.water);
  set_open(map.view(), voxel, roofs, &sheltered);
  out->volumes.push_back(std::move(sheltered));
  add({{roofs.low.x, roofs.low.y, roofs.high.z}, {roofs.high.x, roofs.high.y, all.high.z}});
  add({{roofs.low.x, roofs.low.y, all.low.z}, {roofs.high.x, roofs.high.y, roofs.low.z}});
  each_side(all, roofs, add);
}

}  // namespace gloam
