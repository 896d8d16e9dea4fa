#pragma once
// Media for tests, and quadratures to hold them against.

#include <functional>

#include "base/check.h"
#include "render/kernel/media/medium_march.h"
#include "render/scene/volume_store.h"
#include "render/test/plume.h"
#include "render/test/probe.h"

namespace gloam {

struct MediaBuilder {
  std::vector<MediumDescription> media;
  std::vector<VolumeDescription> volumes;

  /// Values of red, green and blue; the other bands get those of red times 2, 3 and 4 (extinction).
  int add_medium(Vec3f extinction, Vec3f albedo, Vec3f g = {}, float emission = 0) {
    MediumDescription m;
    m.name = "medium";
    for (int i = 0; i < 3; ++i) {
      m.mass_extinction[i] = extinction[i];
      m.mass_extinction[i + 3] = extinction.x * static_cast<float>(i + 2);
      m.albedo[i] = albedo[i];
      m.albedo[i + 3] = albedo.x;
      m.g[i] = g[i];
      m.g[i + 3] = g.x;
    }
    m.emission = emission;
    media.push_back(m);
    return static_cast<int>(media.size()) - 1;
  }

  VolumeDescription& add(VolumeDescription volume, int medium) {
    volume.medium = medium;
    volumes.push_back(std::move(volume));
    return volumes.back();
  }
  VolumeDescription& add_box(Vec3f size, Vec3f center, float density, int medium) {
    VolumeDescription v;
    v.name = "box";
    v.size = size;
    v.X_WV.p = center;
    v.even_density = density;
    return add(v, medium);
  }

  VolumeStore build() const {
    auto store = VolumeStore::make(media, volumes);
    GLOAM_CHECK(store.ok(), "the test's media are refused");
    return std::move(*store);
  }
};

inline VolumeGrid grid_of(std::vector<float> values) {
  return std::make_shared<const std::vector<float>>(std::move(values));
}

/// A grid of noise between 0 and `density`, with empty stretches.
inline VolumeDescription make_noise_volume(int nx, int ny, int nz, float density, uint32_t seed) {
  VolumeDescription v;
  v.name = "noise";
  v.nx = nx;
  v.ny = ny;
  v.nz = nz;
  std::vector<float> values;
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        const Vec3f p{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        values.push_back(density * max(0.0f, 2 * fractal_noise(p * 0.15f, 4, seed) - 0.6f));
      }
    }
  }
  v.density = grid_of(std::move(values));
  return v;
}

/// Independent samplers, as statistical tests assume.
inline Sampler independent(uint32_t i, uint64_t stream = 0) {
  return Sampler::make((stream << 32) + i + 1, 7, 0, 0, 0, 0);
}

inline MediumEvent sample_distance(const MediaView& media, const Ray& ray, float tmax, Bands bands,
                                   Vec3f throughput, Sampler* sampler) {
  const Vec2f u = sampler->next_2d();
  return sample_distance(media, ray, tmax, bands, throughput, u, WalkRandom(sampler->next_2d()));
}
inline Vec3f transmittance(const MediaView& media, const Ray& ray, float tmax, Bands bands,
                           Sampler* sampler) {
  return transmittance(media, ray, tmax, bands, WalkRandom(sampler->next_2d()));
}

struct RaySums {
  double transmittance[3] = {1, 1, 1};
  double scattered[3] = {}, emission[3] = {};  ///< integrals of T sigma_s and T sigma_a L
};

/// Midpoint rule in small steps over what medium_at() says.
inline RaySums integrate_ray(const MediaView& media, const Ray& ray, float tmax, Bands bands = {},
                             int steps = 40000) {
  RaySums sums;
  const double dt = static_cast<double>(tmax) / steps;
  for (int i = 0; i < steps; ++i) {
    const MediumPoint m =
        medium_at(media, ray.o + ray.d * static_cast<float>((i + 0.5) * dt), bands);
    for (int c = 0; c < 3; ++c) {
      const double half = std::exp(-0.5 * m.extinction[c] * dt);
      sums.scattered[c] += sums.transmittance[c] * half * m.scattering[c] * dt;
      sums.emission[c] += sums.transmittance[c] * half * m.emission[c] * dt;
      sums.transmittance[c] *= half * half;
    }
  }
  return sums;
}

}  // namespace gloam
