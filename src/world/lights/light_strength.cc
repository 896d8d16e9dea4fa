#include "world/lights/light_strength.h"

#include <algorithm>
#include <cmath>

#include "world/lights/black_body.h"

namespace gloam {
namespace {

/// Share of a spot's intensity at an angle from its axis: smooth over the outer part of its cone.
double spot_share(const LightDescription& light, double angle) {
  if (light.type != PunctualLightType::kSpot) return 1;
  const double cutoff = std::acos(std::clamp<double>(light.cos_cutoff, -1, 1));
  const double inner = cutoff * (1 - light.softness);
  if (angle >= cutoff) return 0;
  if (angle <= inner) return 1;
  const double x = (cutoff - angle) / (cutoff - inner);
  return x * x * (3 - 2 * x);
}

/// Mean over all directions around the axis, at an angle from it, of the profile's share.
double profile_share(const IesProfile& profile, double angle) {
  const int columns = std::max(profile.columns, 1);
  const double sine = std::sin(angle);
  double sum = 0;
  for (int j = 0; j < columns; ++j) {
    const double around = 2 * M_PI * j / columns;
    sum += profile.intensity({static_cast<float>(sine * std::cos(around)),
                              static_cast<float>(sine * std::sin(around)),
                              static_cast<float>(-std::cos(angle))});
  }
  return sum / columns / profile.most;
}

}  // namespace

Vec3f light_color(const LightOptions& light) {
  if (light.temperature) {
    const Vec3f glow = black_body_luminance(*light.temperature);
    return glow / luminance(glow);
  }
  if (!light.color) return {1, 1, 1};
  const Vec3f color{static_cast<float>(light.color->x), static_cast<float>(light.color->y),
                    static_cast<float>(light.color->z)};
  return color / luminance(color);
}

double solid_angle(const LightDescription& light, const IesProfile* profile) {
  // The grid of the profile's own flux is exact; a cone cuts through it.
  if (light.type == PunctualLightType::kPoint)
    return profile != nullptr ? profile->flux / profile->most : 4 * M_PI;
  const double cutoff = std::acos(std::clamp<double>(light.cos_cutoff, -1, 1));
  constexpr int kRings = 2048;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double angle = cutoff * (i + 0.5) / kRings;
    const double ring = std::cos(cutoff * i / kRings) - std::cos(cutoff * (i + 1) / kRings);
    sum += ring * spot_share(light, angle) *
           (profile != nullptr ? profile_share(*profile, angle) : 1.0);
  }
  return 2 * M_PI * sum;
}

double candela(const LightOptions& options, const LightDescription& light,
               const IesProfile* profile) {
  if (options.intensity) return *options.intensity;
  if (options.luminance) return *options.luminance * M_PI * *options.radius * *options.radius;
  if (!options.flux) return profile->most;
  const double spread = solid_angle(light, profile);
  return spread > 0 ? *options.flux / spread : 0;
}

double area_luminance(const LightOptions& options, double area) {
  if (options.luminance) return *options.luminance;
  if (options.flux) return *options.flux / (M_PI * area);
  // Along the axis a flat lamp shows all of its area, a sphere a quarter of it.
  return *options.intensity / (options.type == LightType::kSphere ? area / 4 : area);
}

}  // namespace gloam
