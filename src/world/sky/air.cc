#include "world/sky/air.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "world/sky/air_profile.h"

namespace gloam {
namespace {

constexpr double kAngstrom = 1.3, kAerosolAlbedo = 0.95, kAsymmetry = 0.7;
constexpr double kOzoneMolecules = 300 * 2.687e20;  // 300 Dobson units [1/m²]

/// Fraction of the light scattered by aerosol that is taken as not scattered at all (Joseph,
/// Wiscombe and Weinman 1976, "The delta-Eddington approximation"): an even distribution over all
/// directions approximates a forward peak badly. Up to g² = 0.49; half of it errs least against
/// path tracing of this air.
constexpr double kPeak = 0.25;
constexpr int kRadii = 48, kCosines = 128;     // size of the sunlight table
constexpr int kHeights = 16, kAngles = 33;     // size of the scattered table
constexpr double kAngleReach = 0.2;            // [rad] on the earth, of a view from its ground
constexpr int kZeniths = 8, kAirAzimuths = 6;  // directions about a point: per hemisphere; half
constexpr int kScatterSteps = 24;

/// Nodes and weights over [0, 1]: Gauss-Legendre, 8 points.
constexpr double kNodes[kZeniths] = {0.01985507175, 0.1016667613, 0.2372337950, 0.4082826788,
                                     0.5917173212,  0.7627662050, 0.8983332387, 0.9801449282};
constexpr double kWeights[kZeniths] = {0.05061426815, 0.1111905172, 0.1568533229, 0.1813418917,
                                       0.1813418917,  0.1568533229, 0.1111905172, 0.05061426815};

double squared(double x) { return x * x; }

/// Distance from the radius r along the zenith cosine mu to the sphere of radius `outer` around it.
double exit_distance(double r, double mu, double outer) {
  return -r * mu + std::sqrt(std::max(0.0, squared(outer) - squared(r) * (1 - mu * mu)));
}

/// Cosine of the zenith angle of the horizon.
double horizon_cosine(double r, double ground) {
  return -std::sqrt(std::max(0.0, 1 - squared(ground / r)));
}

/// Columns of air along the ray of length d from the radius r with the zenith cosine mu [m].
Densities columns(double r, double mu, double d) {
  Densities sum;
  // Short steps where the ray is lowest: at the point nearest to the earth, or at its start.
  const double lowest = std::clamp(-r * mu, 0.0, d);
  for (const double end : {0.0, d}) {
    constexpr int kSteps = 40;
    const double span = end - lowest;
    for (int i = 0; i < kSteps; ++i) {
      const double t = lowest + span * squared((i + 0.5) / kSteps);
      const double dt = std::abs(span) * (2 * i + 1.0) / (kSteps * kSteps);
      const Densities at = densities(std::sqrt(r * r + t * t + 2 * r * t * mu));
      sum.molecules += at.molecules * dt;
      sum.aerosol += at.aerosol * dt;
      sum.ozone += at.ozone * dt;
    }
  }
  return sum;
}

/// Index in a table of n entries, and the weight of the next one.
struct AirPoint {
  int low;
  float share;
};
AirPoint place(double x, int n) {
  const double at = std::clamp(x, 0.0, 1.0) * (n - 1);
  const int low = std::min(static_cast<int>(at), n - 2);
  return {low, static_cast<float>(at - low)};
}
Bands bilinear(const std::vector<Bands>& table, int columns, AirPoint y, AirPoint x) {
  const Bands* row0 = table.data() + y.low * columns + x.low;
  const Bands* row1 = row0 + columns;
  Bands out;
  for (int b = 0; b < kBandCount; ++b) {
    const float low = row0[0][b] + x.share * (row0[1][b] - row0[0][b]);
    const float high = row1[0][b] + x.share * (row1[1][b] - row1[0][b]);
    out[b] = low + y.share * (high - low);
  }
  return out;
}

}  // namespace

double rayleigh_phase(double cosine) {
  // Depolarisation 0.0279 (Bucholtz 1995).
  constexpr double gamma = 0.0279 / (2 - 0.0279);
  return 3 / (16 * M_PI * (1 + 2 * gamma)) * (1 + 3 * gamma + (1 - gamma) * cosine * cosine);
}

double aerosol_phase(double cosine) {
  constexpr double g = kAsymmetry, g2 = g * g;
  const double s = 1 + g2 - 2 * g * cosine;
  return 3 / (8 * M_PI) * (1 - g2) / (2 + g2) * (1 + cosine * cosine) / (s * std::sqrt(s));
}

double single_aerosol_phase(double cosine) { return aerosol_phase(cosine) / (1 - kPeak); }

double visible_share_of_sun(double above) {
  constexpr double kRadius = 4.654e-3;
  const double x = std::clamp(above / kRadius, -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / M_PI;
}

Air::Air(double turbidity, double ground_albedo, double altitude)
    : ground_(kEarthRadius + altitude), albedo_(ground_albedo) {
  const double depth550 =
      (turbidity - 1) * rayleigh_cross_section(550) * kMolecules * kMoleculeColumn;
  for (int b = 0; b < kBandCount; ++b) {
    const double nm = kFirstBand + kBandWidth * b;
    const double aerosol = depth550 / kAerosolColumn * std::pow(nm / 550, -kAngstrom);
    rayleigh_[b] = static_cast<float>(rayleigh_cross_section(nm) * kMolecules);
    aerosol_[b] = static_cast<float>(aerosol * kAerosolAlbedo * (1 - kPeak));
    aerosol_extinction_[b] = static_cast<float>(aerosol * (1 - kAerosolAlbedo * kPeak));
    aerosol_peak_[b] = static_cast<float>(aerosol * kAerosolAlbedo * kPeak);
    ozone_[b] = static_cast<float>(ozone_cross_section(b) * kOzoneMolecules / kOzoneColumn);
  }
  fill_sunlight();
}

AirAt Air::at(double r) const {
  const Densities d = densities(r);
  AirAt air;
  for (int b = 0; b < kBandCount; ++b) {
    air.rayleigh[b] = rayleigh_[b] * static_cast<float>(d.molecules);
    air.aerosol[b] = aerosol_[b] * static_cast<float>(d.aerosol);
    air.extinction[b] = air.rayleigh[b] + aerosol_extinction_[b] * static_cast<float>(d.aerosol) +
                        ozone_[b] * static_cast<float>(d.ozone);
  }
  return air;
}

double Air::horizon(double r) const { return std::acos(horizon_cosine(r, ground_)); }

void Air::fill_sunlight() {
  // Rows by the distance to the horizon, columns by that to the top of the air (Bruneton and
  // Neyret 2008, "Precomputed atmospheric scattering").
  sunlight_.resize(kRadii * kCosines);
  const double to_top = std::sqrt(squared(kTopRadius) - squared(ground_));
  parallel_for("sunlight in air", kRadii, [&](int64_t row) {
    const double to_horizon = to_top * static_cast<double>(row) / (kRadii - 1);
    const double r = std::sqrt(squared(to_horizon) + squared(ground_));
    for (int column = 0; column < kCosines; ++column) {
      const double least = kTopRadius - r, most = to_horizon + to_top;
      const double d = least + (most - least) * column / (kCosines - 1);
      const double mu =
          d > 0
              ? std::clamp((squared(to_top) - squared(to_horizon) - d * d) / (2 * r * d), -1.0, 1.0)
              : 1.0;
      const Densities sum = columns(r, mu, d);
      Bands& out = sunlight_[static_cast<size_t>(row) * kCosines + column];
      for (int b = 0; b < kBandCount; ++b) {
        out[b] = static_cast<float>(
            std::exp(-(rayleigh_[b] * sum.molecules + aerosol_extinction_[b] * sum.aerosol +
                       ozone_[b] * sum.ozone)));
      }
    }
  });
}

Bands Air::sunlight(double r, double angle, double horizon) const {
  const double share = visible_share_of_sun(horizon - angle);
  if (share <= 0) return {};
  const double to_top2 = squared(kTopRadius) - squared(ground_);
  const double to_horizon = std::sqrt(std::max(0.0, squared(r) - squared(ground_)));
  const double mu = std::cos(std::min(angle, horizon));
  const double least = kTopRadius - r, most = to_horizon + std::sqrt(to_top2);
  Bands out =
      bilinear(sunlight_, kCosines, place(to_horizon / std::sqrt(to_top2), kRadii),
               place((exit_distance(r, mu, kTopRadius) - least) / (most - least), kCosines));
  for (float& x : out) x *= static_cast<float>(share);
  return out;
}

Bands Air::beam(double r, double angle) const {
  Bands out = sunlight(r, angle, horizon(r));
  const double mu = std::cos(std::min(angle, horizon(r)));
  const float column = static_cast<float>(columns(r, mu, exit_distance(r, mu, kTopRadius)).aerosol);
  for (int b = 0; b < kBandCount; ++b) out[b] *= std::exp(-aerosol_peak_[b] * column);
  return out;
}

AirRay Air::march(double r, double mu, int count) const {
  AirRay ray;
  ray.meets_ground = mu < horizon_cosine(r, ground_);
  if (ray.meets_ground) {
    ray.length = std::max(
        0.0, -r * mu - std::sqrt(std::max(0.0, squared(ground_) - squared(r) * (1 - mu * mu))));
  } else {
    ray.length = exit_distance(r, mu, kTopRadius);
  }
  ray.steps.resize(count);
  ray.transmittance.fill(1);
  for (int i = 0; i < count; ++i) {
    AirStep& step = ray.steps[i];
    step.t = ray.length * squared((i + 0.5) / count);
    step.r =
        std::clamp(std::sqrt(r * r + step.t * step.t + 2 * r * step.t * mu), ground_, kTopRadius);
    step.horizon = horizon(step.r);
    const float dt =
        static_cast<float>(ray.length * (2 * i + 1) / (static_cast<double>(count) * count));
    const AirAt air = at(step.r);
    for (int b = 0; b < kBandCount; ++b) {
      const float through = std::exp(-air.extinction[b] * dt);
      // Light that the piece scatters, attenuated on its way through the piece itself.
      const float inside = air.extinction[b] > 0
                               ? ray.transmittance[b] * (1 - through) / air.extinction[b]
                               : ray.transmittance[b] * dt;
      step.rayleigh[b] = air.rayleigh[b] * inside;
      step.aerosol[b] = air.aerosol[b] * inside;
      ray.transmittance[b] *= through;
    }
  }
  return ray;
}

Bands Air::scattered_at(double r, double angle, const std::vector<AirRay>& rays) const {
  // `once`: light that was scattered once or came from the sunlit ground. `again`: the fraction of
  // even light of one from all sides that comes here after another scattering.
  Bands once{}, again{};
  for (size_t k = 0; k < rays.size(); ++k) {
    const AirRay& ray = rays[k];
    const size_t node = k % kZeniths;
    const double mu = (k < kZeniths ? -1 : 1) * kNodes[node];
    const double sine = std::sqrt(1 - mu * mu);
    const float weight = static_cast<float>(0.5 * kWeights[node]);
    for (const AirStep& step : ray.steps) {
      for (int b = 0; b < kBandCount; ++b)
        again[b] += weight * (step.rayleigh[b] + step.aerosol[b]);
    }
    if (ray.meets_ground) {
      for (int b = 0; b < kBandCount; ++b) {
        again[b] += weight * ray.transmittance[b] * static_cast<float>(albedo_);
      }
    }
    for (int azimuth = 0; azimuth < kAirAzimuths; ++azimuth) {
      const double across =
          sine * std::sin(angle) * std::cos(M_PI * (azimuth + 0.5) / kAirAzimuths);
      const double to_sun = mu * std::cos(angle) + across;
      const float share = weight / kAirAzimuths;
      const float rayleigh = share * static_cast<float>(rayleigh_phase(to_sun));
      const float aerosol = share * static_cast<float>(aerosol_phase(to_sun));
      const auto sun_angle = [&](double t, double at) {
        return std::acos(std::clamp((r * std::cos(angle) + t * to_sun) / at, -1.0, 1.0));
      };
      for (const AirStep& step : ray.steps) {
        const Bands sun = sunlight(step.r, sun_angle(step.t, step.r), step.horizon);
        for (int b = 0; b < kBandCount; ++b) {
          once[b] += (step.rayleigh[b] * rayleigh + step.aerosol[b] * aerosol) * sun[b];
        }
      }
      if (!ray.meets_ground) continue;
      const double there = sun_angle(ray.length, ground_);
      const double cosine = std::max(0.0, std::cos(there));
      const Bands sun = sunlight(ground_, there, M_PI / 2);
      for (int b = 0; b < kBandCount; ++b) {
        once[b] +=
            share * ray.transmittance[b] * static_cast<float>(albedo_ / M_PI * cosine) * sun[b];
      }
    }
  }
  for (int b = 0; b < kBandCount; ++b) once[b] /= 1 - again[b];
  return once;
}

void Air::prepare_scattered(double angle) {
  first_angle_ = angle - kAngleReach;
  scattered_.resize(kHeights * kAngles);
  parallel_for("scattered light in air", kHeights, [&](int64_t row) {
    const double r =
        ground_ + (kTopRadius - ground_) * squared(static_cast<double>(row) / (kHeights - 1));
    std::vector<AirRay> rays;
    for (const int sign : {-1, 1}) {
      for (const double node : kNodes) rays.push_back(march(r, sign * node, kScatterSteps));
    }
    for (int i = 0; i < kAngles; ++i) {
      scattered_[static_cast<size_t>(row) * kAngles + i] =
          scattered_at(r, first_angle_ + 2 * kAngleReach * i / (kAngles - 1), rays);
    }
  });
}

Bands Air::scattered(double r, double angle) const {
  return bilinear(scattered_, kAngles,
                  place(std::sqrt(std::max(0.0, (r - ground_) / (kTopRadius - ground_))), kHeights),
                  place((angle - first_angle_) / (2 * kAngleReach), kAngles));
}

}  // namespace gloam
