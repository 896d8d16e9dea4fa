#include "world/sky/atmosphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "world/sky/air.h"

namespace gloam {
namespace {

constexpr double kEyeHeight = 2;  // [m]
constexpr int kSteps = 64;        // along a view
constexpr int kAzimuths = 65;     // azimuths of views, over the half circle from the sun
constexpr double kNight = 2e-4;   // [cd/m²]

/// Radiance along a view without the phase functions, which alone change fast from texel to texel.
struct Parts {
  Bands rayleigh{}, aerosol{}, even{};
};
struct ColorParts {
  Vec3f rayleigh, aerosol, even;
};

Error option_error(std::string message) { return {ErrorKind::kInput, std::move(message)}; }

Status check(const AtmosphereOptions& o) {
  if (!(std::abs(length(o.to_sun) - 1) < 1e-3f)) {
    return option_error(fmt::format("direction to the sun ({}, {}, {}) is not a unit vector",
                                    o.to_sun.x, o.to_sun.y, o.to_sun.z));
  }
  if (!(o.turbidity >= 1 && o.turbidity <= 10)) {
    return option_error(fmt::format("turbidity {} is outside of 1..10", o.turbidity));
  }
  if (!(o.ground_albedo >= 0 && o.ground_albedo <= 1)) {
    return option_error(fmt::format("ground albedo {} is outside of 0..1", o.ground_albedo));
  }
  if (!(o.altitude >= 0 && o.altitude <= 9000)) {
    return option_error(fmt::format("altitude {} m is outside of 0..9000 m", o.altitude));
  }
  if (o.width < 8 || o.width > 8192 || o.height < 4 || o.height > 4096 || o.height % 2 != 0) {
    return option_error(
        fmt::format("a sky of {} x {} texels is not supported: 8 x 4 to 8192 x 4096, with an even "
                    "number of rows",
                    o.width, o.height));
  }
  return {};
}

/// The sky above a place with the sun at one angle.
class Sky {
 public:
  Sky(const AtmosphereOptions& o)
      : air_(o.turbidity, o.ground_albedo, o.altitude),
        eye_(air_.ground() + kEyeHeight),
        sun_angle_(std::acos(std::clamp<double>(o.to_sun.z, -1, 1))) {
    air_.prepare_scattered(sun_angle_);
  }

  Bands sun() const { return air_.beam(eye_, sun_angle_); }

  /// One per azimuth for views of the zenith cosine mu; `sky_light`: irradiance of level ground by
  /// the sky, per solar irradiance.
  std::vector<Parts> row(double mu, const Bands& sky_light) const {
    const AirRay ray = air_.march(eye_, mu, kSteps);
    const double sine = std::sqrt(1 - mu * mu);
    std::vector<Parts> row(kAzimuths);
    for (int i = 0; i < kAzimuths; ++i) {
      Parts& parts = row[i];
      const double to_sun = mu * std::cos(sun_angle_) +
                            sine * std::sin(sun_angle_) * std::cos(M_PI * i / (kAzimuths - 1));
      const auto sun_angle = [&](double t, double r) {
        return std::acos(std::clamp((eye_ * std::cos(sun_angle_) + t * to_sun) / r, -1.0, 1.0));
      };
      for (const AirStep& step : ray.steps) {
        const double angle = sun_angle(step.t, step.r);
        const Bands sun = air_.sunlight(step.r, angle, step.horizon);
        const Bands even = air_.scattered(step.r, angle);
        for (int b = 0; b < kBandCount; ++b) {
          parts.rayleigh[b] += step.rayleigh[b] * sun[b];
          parts.aerosol[b] += step.aerosol[b] * sun[b];
          parts.even[b] += (step.rayleigh[b] + step.aerosol[b]) * even[b];
        }
      }
      if (!ray.meets_ground) continue;
      const float cosine = static_cast<float>(std::max(0.0, std::cos(sun_angle_)));
      const Bands sun = this->sun();
      const float reflected = static_cast<float>(air_.ground_albedo() / M_PI);
      for (int b = 0; b < kBandCount; ++b) {
        parts.even[b] += ray.transmittance[b] * reflected * (cosine * sun[b] + sky_light[b]);
      }
    }
    return row;
  }

  /// Illuminance of level ground by the sky whose `rows` are views at `mu`, each for the zone of
  /// `weight` (of the cosine).
  Bands sky_light(const std::vector<std::vector<Parts>>& rows, const std::vector<double>& mu,
                  const std::vector<double>& weight) const {
    Bands sum{};
    for (size_t k = 0; k < rows.size(); ++k) {
      const double sine = std::sqrt(1 - mu[k] * mu[k]);
      for (int i = 0; i < kAzimuths; ++i) {
        const double cosine = mu[k] * std::cos(sun_angle_) +
                              sine * std::sin(sun_angle_) * std::cos(M_PI * i / (kAzimuths - 1));
        const double ends = i == 0 || i == kAzimuths - 1 ? 0.5 : 1;
        const float w = static_cast<float>(2 * M_PI * ends / (kAzimuths - 1) * weight[k] * mu[k]);
        const float rayleigh = w * static_cast<float>(rayleigh_phase(cosine));
        const float aerosol = w * static_cast<float>(single_aerosol_phase(cosine));
        const Parts& parts = rows[k][i];
        for (int b = 0; b < kBandCount; ++b) {
          sum[b] += rayleigh * parts.rayleigh[b] + aerosol * parts.aerosol[b] + w * parts.even[b];
        }
      }
    }
    return sum;
  }

 private:
  Air air_;
  double eye_, sun_angle_;
};

/// Between nodes of a row at `x` (Catmull-Rom; the row is a mirror at its ends), never below zero.
ColorParts between(const std::vector<ColorParts>& row, double x) {
  const int low = std::min(static_cast<int>(x), kAzimuths - 2);
  const float t = static_cast<float>(x - low);
  const float w[4] = {((2 - t) * t - 1) * t / 2, ((3 * t - 5) * t * t + 2) / 2,
                      ((4 - 3 * t) * t + 1) * t / 2, (t - 1) * t * t / 2};
  ColorParts out;
  for (int i = 0; i < 4; ++i) {
    int at = std::abs(low - 1 + i);
    if (at >= kAzimuths) at = 2 * (kAzimuths - 1) - at;
    out.rayleigh += row[at].rayleigh * w[i];
    out.aerosol += row[at].aerosol * w[i];
    out.even += row[at].even * w[i];
  }
  return out;
}

Vec3f at_least_zero(Vec3f c) { return {max(c.x, 0.0f), max(c.y, 0.0f), max(c.z, 0.0f)}; }

}  // namespace

Result<SkyLight> make_sky(const AtmosphereOptions& options) {
  GLOAM_TRY_STATUS(check(options));
  const Sky sky(options);
  SkyLight out;
  out.width = options.width;
  out.height = options.height;

  const int half = out.height / 2;
  std::vector<double> mu(out.height), zone(out.height);
  for (int row = 0; row < out.height; ++row) {
    mu[row] = std::cos(M_PI * (row + 0.5) / out.height);
    zone[row] = std::cos(M_PI * row / out.height) - std::cos(M_PI * (row + 1) / out.height);
  }
  // The ground is lit by the sky: the rows above the horizon first.
  std::vector<std::vector<Parts>> rows(out.height);
  parallel_for("sky", half, [&](int64_t row) { rows[row] = sky.row(mu[row], {}); });
  const Bands sky_light = sky.sky_light({rows.begin(), rows.begin() + half}, mu, zone);
  parallel_for("ground under the sky", half,
               [&](int64_t row) { rows[half + row] = sky.row(mu[half + row], sky_light); });

  const float night = static_cast<float>(kNight);
  const double sun_azimuth = std::atan2(options.to_sun.y, options.to_sun.x);
  out.texels.resize(static_cast<size_t>(out.width) * out.height);
  parallel_for("sky colours", out.height, [&](int64_t row) {
    std::vector<ColorParts> nodes(kAzimuths);
    for (int i = 0; i < kAzimuths; ++i) {
      const Parts& parts = rows[row][i];
      nodes[i] = {color_of_sunlight(parts.rayleigh), color_of_sunlight(parts.aerosol),
                  color_of_sunlight(parts.even)};
    }
    const double sine = std::sqrt(1 - mu[row] * mu[row]);
    for (int column = 0; column < out.width; ++column) {
      const double azimuth = M_PI * (1 - 2 * (column + 0.5) / out.width);
      const double away = std::abs(std::remainder(azimuth - sun_azimuth, 2 * M_PI));
      const double cosine = sine * std::hypot(options.to_sun.x, options.to_sun.y) * std::cos(away) +
                            mu[row] * options.to_sun.z;
      const ColorParts parts = between(nodes, away / M_PI * (kAzimuths - 1));
      const Vec3f light = parts.rayleigh * static_cast<float>(rayleigh_phase(cosine)) +
                          parts.aerosol * static_cast<float>(single_aerosol_phase(cosine)) +
                          parts.even;
      out.texels[static_cast<size_t>(row) * out.width + column] =
          at_least_zero(light) + Vec3f{night, night, night};
    }
  });
  out.sun_illuminance = color_of_sunlight(sky.sun());
  const float night_lux = static_cast<float>(M_PI * kNight);
  out.sky_illuminance = color_of_sunlight(sky_light) + Vec3f{night_lux, night_lux, night_lux};
  return out;
}

}  // namespace gloam
