#include "sensors/thermal/thermal_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/text.h"
#include "geometry/lens.h"
#include "sensors/signal/draw.h"
#include "sensors/thermal/thermal_band.h"

namespace gloam {
namespace {

constexpr double kRoomTemperature = 293.15;  // [K]
constexpr double kReference = 300;           // reference of NETD [K]
constexpr int kBand = static_cast<int>(MediumBand::k8to14um);

bool fits(const TemperatureOptions& o, const LabelRow& label) {
  return fits_pattern(o.body, label.body) && fits_pattern(o.material, label.material);
}

double sent_by(const TemperatureOptions& o) {
  return o.emissivity * thermal_radiance(o.temperature) +
         (1 - o.emissivity) * thermal_radiance(o.ambient);
}

/// Part of `radiance` [W/(m² sr)] that passes the media, and the radiance that they add.
double through_media(const MediaView& media, Vec3f origin, Vec3f direction, double distance,
                     double radiance) {
  static const double room = thermal_radiance(kRoomTemperature);
  double passed = 1, sent = 0;
  each_step(media, origin, direction, distance, [&](Vec3f p, double from, double to) {
    double extinction = 0, source = 0;  // [1/m], [W/(m² sr m)]
    for (uint32_t i = 0; i < media.volumes.size; ++i) {
      const VolumeView& v = media.volumes[i];
      const Vec3f p_G = transform_point(v.X_GW, p);
      if (!media::is_inside(v, p_G)) continue;
      const double k = double{v.mass_extinction[kBand]} * double{media::density_at(v, p_G)};
      const double albedo = double{v.albedo[kBand]};
      extinction += k;
      // Scattering brings in the light of the surroundings.
      source += k * (1 - albedo) * thermal_radiance(double{media::temperature_at(v, p_G)}) +
                k * albedo * room;
    }
    if (extinction <= 0) return;
    const double kept = std::exp(-extinction * (to - from));
    sent += passed * source / extinction * (1 - kept);
    passed *= kept;
  });
  return radiance * passed + sent;
}

}  // namespace

Result<ThermalCamera> ThermalCamera::make(const ThermalOptions& options,
                                          const std::vector<TemperatureOptions>& temperatures,
                                          const RenderDescription& description, uint64_t seed) {
  ThermalCamera camera(options, seed ^ options.seed);
  LabelRow sky;
  sky.body = "sky";
  std::vector<const LabelRow*> labels = {&sky};
  for (const InstanceDescription& instance : description.instances)
    labels.push_back(&instance.label);
  camera.radiance_.assign(labels.size(),
                          sent_by({.temperature = kRoomTemperature, .ambient = kRoomTemperature}));
  for (const TemperatureOptions& o : temperatures) {
    bool found = false;
    for (size_t part = 0; part < labels.size(); ++part) {
      if (!fits(o, *labels[part])) continue;
      // The sky is what it is called by its own name alone.
      if (part == 0 && o.body != "sky") continue;
      camera.radiance_[part] = sent_by(o);
      found = true;
    }
    if (!found)
      return Error{ErrorKind::kInput,
                   fmt::format("a [[temperature]] matches nothing: body '{}', material '{}'",
                               o.body, o.material),
                   o.loc, "use full names; * matches any text"};
  }
  return camera;
}

std::vector<float> ThermalCamera::see(const Film& film, const CameraView& view, int64_t frame,
                                      const MediaView& media) const {
  const PixelRays rays(view.intrinsics);
  const double per_kelvin = thermal_radiance(kReference + 0.5) - thermal_radiance(kReference - 0.5);
  const RandomStream noise{seed_, stream_id("thermal.noise")},
      pattern{seed_, stream_id("thermal.pattern")};
  std::vector<float> out(film.depth.size());
  parallel_for_range("thermal", film.height, 4, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < film.width; ++x) {
        const size_t i =
            static_cast<size_t>(y) * static_cast<size_t>(film.width) + static_cast<size_t>(x);
        double radiance = radiance_[film.part[i]];
        if (const auto ray_C = !media.volumes.empty() ? rays.at(x + 0.5, y + 0.5) : std::nullopt) {
          radiance = through_media(media, transform_point(view.X_WC_open, to_vec3f(ray_C->p_C)),
                                   transform_vector(view.X_WC_open, to_vec3f(ray_C->d_C)),
                                   double{film.distance[i]}, radiance);
        }
        const auto key = static_cast<uint32_t>(i);
        if (options_.netd > 0)
          radiance +=
              options_.netd * per_kelvin * draw_normal(noise, static_cast<uint64_t>(frame), key);
        if (options_.fixed_pattern > 0)
          radiance += options_.fixed_pattern * per_kelvin * draw_normal(pattern, 0, key);
        double t = apparent_temperature(radiance);
        if (options_.step > 0) t = options_.step * std::round(t / options_.step);
        out[i] = static_cast<float>(std::clamp(t, options_.min, options_.max));
      }
    }
  });
  return out;
}

}  // namespace gloam
