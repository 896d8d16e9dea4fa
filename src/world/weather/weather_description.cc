#include "world/weather/weather_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "base/text.h"
#include "geometry/mesh/single.h"
#include "world/media/medium_presets.h"
#include "world/media/volume_pattern.h"
#include "world/render_description.h"
#include "world/shapes/extent.h"
#include "world/weather/fallen_snow.h"

namespace gloam {
namespace {

// Water that a surface holds before it runs off, as rain: a porous millimetre [m].
constexpr double kHeldWater = 1e-3;
constexpr float kMargin = 400;            // [m] of air around the place
constexpr float kAbove = 15;              // [m] of air over its lowest point, at least
constexpr double kInWalls = 0.1;          // [m] of what hangs in rooms beyond their faces
constexpr double kPerHour = 1e-3 / 3600;  // mm/h as m/s

/// Box of what stands still, or two metres about the origin.
struct Bounds {
  Vec3f low{-1, -1, 0}, high{1, 1, 1};
};

Bounds bounds_of(const RenderDescription& description) {
  const ShelterMap& map = *description.weather.shelter;
  Bounds bounds;
  bounds.low = description.center - Vec3f{1, 1, 1} * (0.5f * description.extent);
  bounds.high = description.center + Vec3f{1, 1, 1} * (0.5f * description.extent);
  if (map.nx == 0) return bounds;
  bounds.low = {map.low.x, map.low.y, map.lowest};
  bounds.high = {map.low.x + map.cell * static_cast<float>(map.nx),
                 map.low.y + map.cell * static_cast<float>(map.ny), -1e30f};
  for (const float top : map.height) {
    if (!std::isfinite(top)) continue;
    bounds.high.z = std::max(bounds.high.z, top);
  }
  return bounds;
}

VolumeDescription box_of(const Bounds& bounds, std::string name) {
  VolumeDescription volume;
  volume.name = std::move(name);
  volume.size = bounds.high - bounds.low;
  volume.X_WV.p = (bounds.low + bounds.high) * 0.5f;
  return volume;
}

/// From below the ground to well above what stands there, and to all sides.
Bounds air_around(const Bounds& bounds, float height) {
  return {{bounds.low.x - kMargin, bounds.low.y - kMargin, bounds.low.z - 1},
          {bounds.high.x + kMargin, bounds.high.y + kMargin,
           std::max(bounds.low.z + height, bounds.high.z + 2)}};
}

/// All rooms, and kInWalls into their walls.
Bounds air_in(std::span<const Region> rooms) {
  const Extent extent = extent_of(rooms, kInWalls);
  return {to_vec3f(extent.low), to_vec3f(extent.high)};
}

/// Thinner with height and in billows, whose mean is one.
void set_profile(const WeatherOptions& options, uint64_t seed, float ground, float density,
                 VolumeDescription* volume) {
  constexpr int kAlong = 192;  // voxels
  const float voxel = max(volume->size.x, volume->size.y) / kAlong;
  const auto count = [](float edge, float step) {
    return std::max(2, static_cast<int>(std::lround(edge / step)));
  };
  volume->nx = count(volume->size.x, voxel), volume->ny = count(volume->size.y, voxel);
  volume->nz = count(volume->size.z, std::min(1.0f, volume->size.z / 12));
  volume->density = std::make_shared<const std::vector<float>>(
      haze_layer({volume->nx, volume->ny, volume->nz}, volume->size,
                 volume->X_WV.p.z - 0.5f * volume->size.z - ground, options.scale_height,
                 options.turbulence, density, seed));
}

Status add_fog(const WeatherOptions& options, std::span<const Region> rooms, const Bounds& bounds,
               uint64_t seed, RenderDescription* out) {
  const std::string name = options.medium.value_or("fog");
  const MediumDescription* medium = find_medium(name);
  if (medium == nullptr) {
    return Error{ErrorKind::kInput, fmt::format("weather: there is no medium '{}'", name),
                 options.loc, suggest_name(name, medium_names())};
  }
  const auto scale = static_cast<float>(options.scale_height);
  const bool in_rooms = options.where == "rooms";
  VolumeDescription volume =
      box_of(in_rooms ? air_in(rooms) : air_around(bounds, std::max(kAbove, 5 * scale)),
             "weather/" + name);
  volume.even_density = static_cast<float>(kKoschmieder / *options.visibility) /
                        medium->mass_extinction[static_cast<size_t>(MediumBand::kGreen)];
  if (scale > 0 || options.turbulence > 0)
    set_profile(options, seed, bounds.low.z, volume.even_density, &volume);
  volume.medium = static_cast<int>(out->media.size());
  out->media.push_back(*medium);
  out->volumes.push_back(std::move(volume));
  return {};
}

/// None of it where something shelters.
void add_falling(const ParticleSet& particles, const Bounds& bounds, RenderDescription* out) {
  const ShelterMap& map = *out->weather.shelter;
  MediumDescription medium = medium_of(particles);
  VolumeDescription volume = box_of(air_around(bounds, 50), "weather/" + medium.name);
  volume.medium = static_cast<int>(out->media.size());
  volume.even_density = particles.water;
  // A roof keeps off what falls: where there is one, the box is of voxels that are under it or not.
  constexpr float kVoxel = 0.5f, kHead = 1.5f;
  const auto is_roof = [&](float top) { return top > bounds.low.z + kHead; };
  if (std::any_of(map.height.begin(), map.height.end(), is_roof)) {
    volume.size = {bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y,
                   bounds.high.z - bounds.low.z + 1};
    volume.X_WV.p = bounds.low + volume.size * 0.5f;
    const float voxel = std::max(kVoxel, std::max(volume.size.x, volume.size.y) / 256);
    const auto count = [&](float edge) {
      return std::max(2, static_cast<int>(std::ceil(edge / voxel)));
    };
    volume.nx = count(volume.size.x), volume.ny = count(volume.size.y);
    volume.nz = count(volume.size.z);
    std::vector<float> density;
    density.reserve(static_cast<size_t>(volume.nx) * static_cast<size_t>(volume.ny) *
                    static_cast<size_t>(volume.nz));
    const ShelterView view = map.view();
    const Vec3f step{volume.size.x / static_cast<float>(volume.nx),
                     volume.size.y / static_cast<float>(volume.ny),
                     volume.size.z / static_cast<float>(volume.nz)};
    for (int k = 0; k < volume.nz; ++k) {
      for (int j = 0; j < volume.ny; ++j) {
        for (int i = 0; i < volume.nx; ++i) {
          const Vec3f middle{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f,
                             static_cast<float>(k) + 0.5f};
          density.push_back(particles.water *
                            view.open_above(bounds.low + middle * step, 0.5f * voxel));
        }
      }
    }
    volume.density = std::make_shared<const std::vector<float>>(std::move(density));
  }
  out->media.push_back(std::move(medium));
  out->volumes.push_back(std::move(volume));
}

}  // namespace

float WeatherDescription::wetness_at(double time) const {
  const double share = std::exp(-time / static_cast<double>(wetting_time));
  return static_cast<float>(wetness_end + (wetness_start - wetness_end) * share);
}

float WeatherDescription::snow_at(double time) const {
  // Three centimetres hide what is beneath but for one part in seven.
  constexpr double kHides = 0.015;  // [m]
  return static_cast<float>(1 - std::exp(-(snow_start + snow_rate * time) / kHides));
}

Status author_weather(const WeatherOptions& options, const WindDescription& wind,
                      std::span<const Region> rooms, const std::vector<Affine3f>& X_WB,
                      RenderDescription* out) {
  WeatherDescription& weather = out->weather;
  const double rain = options.rain.value_or(0), snow = options.snow.value_or(0);
  const uint64_t seed = weather.seed = wind.seed;
  weather.shelter = make_shelter_map(*out, X_WB);
  const Bounds bounds = bounds_of(*out);
  if (options.visibility) GLOAM_TRY_STATUS(add_fog(options, rooms, bounds, seed, out));
  const auto add = [&](ParticleSet particles) {
    particles.wind = {static_cast<float>(wind.speed * wind.along_x),
                      static_cast<float>(wind.speed * wind.along_y), 0};
    if (wind.gusts > 0) particles.gusts = std::make_shared<const Gusts>(wind);
    particles.seed = seed + weather.particles.size();
    add_falling(particles, bounds, out);
    weather.particles.push_back(std::move(particles));
  };
  if (rain > 0) {
    add(rain_particles(rain));
    for (const ParticleClass& drop : weather.particles.back().classes)
      if (drop.diameter >= 1e-3f) weather.impacts += drop.number * drop.fall_speed;
    weather.drips = find_drip_edges(*weather.shelter, rain * kPerHour);
  }
  if (snow > 0) add(snow_particles(snow));
  // From soaked without a film to half of what is level under water in a cloudburst.
  weather.wetness_end = rain > 0 ? static_cast<float>(0.5 + 0.25 * rain / (rain + 10)) : 0;
  weather.wetness_start =
      static_cast<float>(options.wetness.value_or(static_cast<double>(weather.wetness_end)));
  // Without rain it dries, at half a millimetre an hour.
  weather.wetting_time = static_cast<float>(kHeldWater / (std::max(rain, 0.5) * kPerHour));
  weather.snow_start = static_cast<float>(options.snow_cover.value_or(0));
  weather.snow_rate = static_cast<float>(snow_growth(options));
  weather.lens_drops = static_cast<float>(options.lens_drops.value_or(0));
  weather.drops_fall_on_lenses = rain > 0;
  return {};
}

}  // namespace gloam
