// The sky against path tracing of the same air: all orders of scattering, with their directions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/rng.h"
#include "world/sky/air.h"
#include "world/sky/air_profile.h"
#include "world/sky/atmosphere.h"

namespace gloam {
namespace {

constexpr double kAlbedo = 0.2, kAsymmetry = 0.7, kAerosolAlbedo = 0.95;

struct Vec {
  double x, y, z;
  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
  friend double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};
double norm(Vec a) { return std::sqrt(dot(a, a)); }

Vec direction(double elevation, double azimuth) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}
/// At the angle of `cosine` from the unit vector n.
Vec around(Vec n, double cosine, double phi) {
  const Frame f =
      Frame::from_z({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const Vec3f d =
      f.to_world({static_cast<float>(sine * std::cos(phi)),
                  static_cast<float>(sine * std::sin(phi)), static_cast<float>(cosine)});
  const Vec out{d.x, d.y, d.z};
  return out * (1 / norm(out));
}

/// One band of the air at sea level [1/m].
struct Coefficients {
  double molecules, aerosol, ozone;
};
Coefficients coefficients(double turbidity, int band) {
  const double nm = kFirstBand + kBandWidth * band;
  const double depth = (turbidity - 1) * rayleigh_cross_section(550) * kMolecules * kMoleculeColumn;
  return {rayleigh_cross_section(nm) * kMolecules,
          depth / kAerosolColumn * std::pow(nm / 550, -1.3),
          ozone_cross_section(band) * 300 * 2.687e20 / kOzoneColumn};
}

class Tracer {
 public:
  Tracer(double turbidity, Vec sun)
      : air_(turbidity, kAlbedo, 0), turbidity_(turbidity), sun_(sun) {}

  /// Luminance [cd/m²] towards d from 2 m above the ground.
  double luminance_of(Vec d, int paths) const {
    Bands sum{};
    for (int i = 0; i < paths; ++i) {
      sum[i % kBandCount] += static_cast<float>(path(d, i % kBandCount, static_cast<uint64_t>(i)) *
                                                kBandCount / paths);
    }
    return luminance(color_of_sunlight(sum));
  }

 private:
  double path(Vec d, int band, uint64_t index) const {
    uint32_t k = 0;
    const auto draw = [&] {
      const Philox4 bits = philox4x32(77, index, k++);
      return uniform_double(bits.v[0], bits.v[1]);
    };
    const Coefficients c = coefficients(turbidity_, band);
    Vec p{0, 0, kEarthRadius + 2};
    double weight = 1, light = 0;
    for (int order = 0; order < 60 && weight > 1e-3; ++order) {
      const double along = dot(p, d), r2 = dot(p, p);
      const double low = along * along - r2 + kEarthRadius * kEarthRadius;
      const double to_ground = along < 0 && low > 0 ? -along - std::sqrt(low) : 1e30;
      const double to_top = -along + std::sqrt(along * along - r2 + kTopRadius * kTopRadius);
      // Delta tracking; nothing further on is denser than the lowest point ahead, ozone apart.
      double t = 0;
      Coefficients here{};
      bool hit = false;
      while (!hit && t < std::min(to_ground, to_top)) {
        const double r = norm(p + d * t), ahead = along + t;
        const double lowest =
            ahead < 0 ? std::max(kEarthRadius, std::sqrt(std::max(0.0, r * r - ahead * ahead))) : r;
        const Densities bound = densities(lowest);
        const double majorant = c.molecules * bound.molecules + c.aerosol * bound.aerosol + c.ozone;
        t -= std::log(1 - draw()) / majorant;
        if (t >= std::min(to_ground, to_top)) break;
        const Densities at = densities(norm(p + d * t));
        here = {c.molecules * at.molecules, kAerosolAlbedo * c.aerosol * at.aerosol,
                c.ozone * at.ozone};
        const double all = here.molecules + here.aerosol / kAerosolAlbedo + here.ozone;
        hit = draw() * majorant < all;
        if (hit) weight *= (here.molecules + here.aerosol) / all;
      }
      if (hit) {
        p = p + d * t;
        light += weight * scatter(p, d, here, band);
        const bool aerosol = draw() * (here.molecules + here.aerosol) < here.aerosol;
        double cosine = 2 * draw() - 1, density = 1 / (4 * M_PI);
        if (aerosol) {  // Henyey-Greenstein
          const double g = kAsymmetry, z = (1 - g * g) / (1 + g * cosine);
          cosine = (1 + g * g - z * z) / (2 * g);
          density *= (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
        }
        weight *= (aerosol ? aerosol_phase(cosine) : rayleigh_phase(cosine)) / density;
        d = around(d, cosine, 2 * M_PI * draw());
      } else if (to_ground < to_top) {
        p = p + d * to_ground;
        const Vec n = p * (1 / norm(p));
        p = n * (kEarthRadius + 0.01);
        const double cosine = dot(n, sun_);
        weight *= kAlbedo;
        if (cosine > 0) light += weight / M_PI * cosine * beam(p, band);
        d = around(n, std::sqrt(draw()), 2 * M_PI * draw());
      } else {
        break;
      }
    }
    return light;
  }
  double beam(Vec p, int band) const {
    const double r = norm(p);
    return air_.beam(r, std::acos(std::clamp(dot(p, sun_) / r, -1.0, 1.0)))[band];
  }
  double scatter(Vec p, Vec d, const Coefficients& here, int band) const {
    const double cosine = dot(d, sun_);
    return (here.molecules * rayleigh_phase(cosine) + here.aerosol * aerosol_phase(cosine)) /
           (here.molecules + here.aerosol) * beam(p, band);
  }

  Air air_;
  double turbidity_;
  Vec sun_;
};

TEST(AtmosphereReference, SkyIsThatOfPathTracing) {
  struct Case {
    double turbidity, sun, slack;  // elevation [degrees]; of the luminance's logarithm
  };
  struct View {
    double elevation, azimuth;  // [degrees], from the sun's azimuth
  };
  double worst = 0;
  for (const Case& c : {Case{1, 60, 0.1}, Case{1, 3, 0.1}, Case{2, 60, 0.12}, Case{2, 20, 0.12},
                        Case{2, 3, 0.18}, Case{5, 60, 0.28}, Case{5, 20, 0.33}}) {
    const Vec sun = direction(c.sun * kDegree, 0);
    AtmosphereOptions options;
    options.to_sun = {static_cast<float>(sun.x), 0, static_cast<float>(sun.z)};
    options.turbidity = c.turbidity;
    options.ground_albedo = kAlbedo;
    const Result<SkyLight> sky = make_sky(options);
    ASSERT_TRUE(sky.ok());
    const Tracer tracer(c.turbidity, sun);
    for (const View& v : {View{88, 0}, View{45, 90}, View{45, 180}, View{10, 0}, View{10, 180}}) {
      const int row = static_cast<int>((90 - v.elevation) / 180 * sky->height);
      const int column = static_cast<int>((0.5 - v.azimuth / 360 + 1) * sky->width) % sky->width;
      const Vec d = direction(M_PI / 2 - M_PI * (row + 0.5) / sky->height,
                              M_PI * (1 - 2 * (column + 0.5) / sky->width));
      const double reference = tracer.luminance_of(d, 8000);
      const double found = luminance(sky->texels[static_cast<size_t>(row) * sky->width + column]);
      const double gap = std::log(found / reference);
      worst = std::max(worst, std::abs(gap));
      EXPECT_NEAR(gap, 0, c.slack) << "turbidity " << c.turbidity << ", sun at " << c.sun
                                   << ", view at " << v.elevation << ", " << v.azimuth;
    }
  }
  RecordProperty("worst", std::to_string(worst));
}

}  // namespace
}  // namespace gloam
