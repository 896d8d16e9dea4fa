#include "world/sky/authored_sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/memory.h"
#include "geometry/image/image_file.h"
#include "world/sky/environment.h"

namespace gloam {
namespace {

Error sky_error(const SkyOptions& options, std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), options.loc, std::move(hint)};
}
/// Errors of the functions below, which have no place in the file, get the table's.
Error in_sky(const SkyOptions& options, const Error& error) {
  return sky_error(options, fmt::format("[sky]: {}", error.to_string()));
}

Status read_map(const SkyOptions& options, EnvironmentDescription* out) {
  const std::string name = options.file.filename().string();
  constexpr uint64_t kPixelBytes = 64;  // decoded, as texels, and the tables to draw from them
  const uint64_t most = std::min(kMaxImagePixels, memory_room().bytes / kPixelBytes);
  const Result<ImageF> image = read_float_image(options.file, most);
  if (!image.ok()) return in_sky(options, image.error());
  if (image->width != 2 * image->height) {
    return sky_error(
        options,
        fmt::format("'{}' has {} x {} pixels; an equirectangular sky must be twice as wide as high",
                    name, image->width, image->height));
  }
  out->name = name;
  out->width = image->width;
  out->height = image->height;
  const auto channels = static_cast<size_t>(image->channels);
  out->texels.resize(image->texels.size() / channels);
  const auto above_zero = [](float x) { return max(x, 0); };  // filters of pictures undershoot
  for (size_t i = 0; i < out->texels.size(); ++i) {
    const float* texel = &image->texels[i * channels];
    const Vec3f c =
        channels < 3 ? Vec3f{texel[0], texel[0], texel[0]} : Vec3f{texel[0], texel[1], texel[2]};
    if (!std::isfinite(c.x + c.y + c.z)) {
      return sky_error(
          options,
          fmt::format("'{}' contains a value that is not finite in column {}, row {}", name,
                      i % static_cast<size_t>(out->width), i / static_cast<size_t>(out->width)));
    }
    out->texels[i] = {above_zero(c.x), above_zero(c.y), above_zero(c.z)};
  }
  out->turn = static_cast<float>(options.turn.value_or(0) * kDegree);
  out->scale = static_cast<float>(options.scale.value_or(1));
  if (!options.illuminance) return {};
  const float level = illuminance(*out, {0, 0, 1});
  if (!(level > 0)) {
    return sky_error(options, fmt::format("'{}' is black above the horizon", name),
                     "no scale can give it an illuminance");
  }
  out->scale = static_cast<float>(*options.illuminance / level);
  return {};
}

void make_even(const SkyOptions& options, EnvironmentDescription* out) {
  Vec3f color{1, 1, 1};
  if (options.color) {
    color = {static_cast<float>(options.color->x), static_cast<float>(options.color->y),
             static_cast<float>(options.color->z)};
  }
  out->name = "even sky";
  out->width = 8;
  out->height = 4;
  out->texels.assign(32, color / luminance(color));
  out->scale = static_cast<float>(*options.luminance);
}

CivilTime clock_of(const SkyOptions& o) {
  return {o.date->year,   o.date->month,           o.date->day, o.time->hour, o.time->minute,
          o.time->second, o.utc_offset.value_or(0)};
}

/// Unit, X east, Y north, Z up.
Result<Vec3f> direction_of_sun(const SkyOptions& o) {
  if (o.sun_elevation) {
    constexpr double kSouth = 180;
    const double azimuth = o.sun_azimuth.value_or(kSouth) * kDegree;
    const double elevation = *o.sun_elevation * kDegree;
    return Vec3f{static_cast<float>(std::cos(elevation) * std::sin(azimuth)),
                 static_cast<float>(std::cos(elevation) * std::cos(azimuth)),
                 static_cast<float>(std::sin(elevation))};
  }
  const Result<SunPosition> sun = sun_position(clock_of(o), {*o.latitude, *o.longitude});
  if (!sun.ok()) return in_sky(o, sun.error());
  return sun->to_sun;
}

Status make_clear(const SkyOptions& options, LightLevels* levels, RenderDescription* out) {
  GLOAM_TRY(const Vec3f sun, direction_of_sun(options));
  const double north = options.north.value_or(0) * kDegree;
  AtmosphereOptions air;
  air.to_sun = turned_north(sun, north);
  air.turbidity = options.turbidity.value_or(air.turbidity);
  air.ground_albedo = options.ground_albedo.value_or(air.ground_albedo);
  air.altitude = options.altitude.value_or(air.altitude);
  GLOAM_TRY(SkyLight sky, make_sky(air));
  EnvironmentDescription& environment = out->sky.environment;
  environment.name = "clear sky";
  environment.width = sky.width;
  environment.height = sky.height;
  environment.texels = std::move(sky.texels);
  const bool moves = options.speed.value_or(0) > 0;
  if (moves) {
    out->sky.day = DayCycle{
        clock_of(options), {*options.latitude, *options.longitude}, *options.speed, north, air};
  }
  if (!moves && !(luminance(sky.sun_illuminance) > 0)) return {};  // it has set

  LightDescription light;
  light.name = "sun";
  light.type = PunctualLightType::kDirectional;
  light.intensity = sky.sun_illuminance;
  light.radius = static_cast<float>(std::sin(sky.sun_angular_radius));
  light.is_static = !moves;
  light.of_sky = true;
  light.body = 0;
  const Frame frame = Frame::from_z(air.to_sun);
  light.X_BL = {frame.x, frame.y, frame.z, {}};
  levels->illuminance.push_back(luminance(light.intensity));
  out->lights.push_back(std::move(light));
  return {};
}

}  // namespace

Status author_sky(const SkyOptions& options, LightLevels* levels, RenderDescription* out) {
  if (!options.file.empty()) return read_map(options, &out->sky.environment);
  if (!options.luminance) return make_clear(options, levels, out);
  make_even(options, &out->sky.environment);
  return {};
}

}  // namespace gloam
