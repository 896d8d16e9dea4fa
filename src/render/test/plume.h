#pragma once
// Procedural volumes for tests: a column of smoke that billows and has a hot core.

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/kernel/math/sampler.h"
#include "world/media/medium_description.h"

namespace gloam {

/// Value noise in [0, 1): trilinear with smoothed weights between hashed lattice points.
inline float plume_noise(Vec3f p, uint32_t seed) {
  const Vec3f base{std::floor(p.x), std::floor(p.y), std::floor(p.z)}, f = p - base;
  const auto smooth = [](float t) { return t * t * (3 - 2 * t); };
  const auto corner = [&](int dx, int dy, int dz) {
    const auto part = [](float x, int d) {
      return static_cast<uint32_t>(static_cast<int32_t>(x) + d);
    };
    uint32_t h = mix_bits(seed + part(base.x, dx) * 0x9E3779B9u);
    h = mix_bits(h + part(base.y, dy) * 0x85EBCA6Bu);
    h = mix_bits(h + part(base.z, dz) * 0xC2B2AE35u);
    return static_cast<float>(h >> 8) * 0x1p-24f;
  };
  const float u = smooth(f.x), v = smooth(f.y), w = smooth(f.z);
  const auto plane = [&](int dz) {
    return lerp(lerp(corner(0, 0, dz), corner(1, 0, dz), u),
                lerp(corner(0, 1, dz), corner(1, 1, dz), u), v);
  };
  return lerp(plane(0), plane(1), w);
}

/// Sum of octaves, each of twice the frequency and half the amplitude, in [0, 1).
inline float fractal_noise(Vec3f p, int octaves, uint32_t seed) {
  float sum = 0, amplitude = 0.5f;
  for (int i = 0; i < octaves; ++i, amplitude *= 0.5f) {
    sum += amplitude * plume_noise(p, seed + static_cast<uint32_t>(i));
    p = p * 2.03f + Vec3f{17.1f, 5.3f, 9.7f};
  }
  return sum / (1 - 2 * amplitude);
}

/// A plume that rises along z from the middle of the bottom of its box (1 x 1 x 2 units of `size`)
/// and widens: densities up to about `density` [kg/m³], `hot` [K] at the foot of the core and 293 K
/// around it.
inline VolumeDescription make_plume(int n, float density, float hot, uint32_t seed = 1) {
  VolumeDescription volume;
  volume.name = "plume";
  volume.nx = volume.ny = n;
  volume.nz = 2 * n;
  volume.size = {1, 1, 2};
  std::vector<float> densities(static_cast<size_t>(n) * n * 2 * n), temperatures(densities.size());
  parallel_for("plume", volume.nz, [&](int64_t k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const float inv = 1.0f / static_cast<float>(n);
        const float h = (static_cast<float>(k) + 0.5f) * inv * 0.5f;  // 0..1 upwards
        const Vec3f p{(static_cast<float>(i) + 0.5f) * inv - 0.5f,
                      (static_cast<float>(j) + 0.5f) * inv - 0.5f, 2 * h};
        const Vec3f q = p * 4.0f - Vec3f{0, 0, 3 * h};
        const float sway_x = 0.25f * h * (plume_noise({0.3f, 7.7f, 5 * h}, seed + 91) - 0.5f);
        const float sway_y = 0.25f * h * (plume_noise({4.9f, 2.2f, 5 * h}, seed + 92) - 0.5f);
        const float ripple = fractal_noise(q, 5, seed) - 0.5f;
        const float radius = 0.07f + 0.3f * h;
        const float x = p.x - sway_x, y = p.y - sway_y;
        const float inside = 1 - std::sqrt(x * x + y * y) / radius + (1.2f + 3 * h) * ripple;
        const float top = clamp((0.96f - h) * 8, 0.0f, 1.0f);
        const float amount = clamp(inside, 0.0f, 1.0f) * top;
        const size_t at = (static_cast<size_t>(k) * n + j) * n + i;
        densities[at] = density * amount * amount * (1.3f - h);
        const float heat = clamp(1.4f * inside, 0.0f, 1.0f) * clamp(1.15f - 1.6f * h, 0.0f, 1.0f);
        temperatures[at] = 293 + (hot - 293) * heat;
      }
    }
  });
  volume.density = std::make_shared<const std::vector<float>>(std::move(densities));
  volume.temperature = std::make_shared<const std::vector<float>>(std::move(temperatures));
  return volume;
}

}  // namespace gloam
