#pragma once
// A flame for tests.

#include "render/test/media_probe.h"

namespace gloam {

inline constexpr float kHot = 1900;  // [K]

/// An egg of soot in a box of 20 x 20 x 40 voxels, hottest in the middle and gone at its rim.
inline VolumeDescription make_flame(Vec3f size, Vec3f foot) {
  VolumeDescription flame;
  flame.name = "flame";
  flame.nx = flame.ny = 20;
  flame.nz = 40;
  flame.size = size;
  flame.X_WV = rigid({0, 0, 1}, 0.5f, foot + Vec3f{0, 0, 0.5f * size.z});
  std::vector<float> densities, temperatures;
  for (int i = 0; i < flame.nx * flame.ny * flame.nz; ++i) {
    const int x = i % 20, y = i / 20 % 20, z = i / 400;
    const Vec3f q = Vec3f{static_cast<float>(x) - 9.5f, static_cast<float>(y) - 9.5f,
                          0.5f * (static_cast<float>(z) - 19.5f)} *
                    0.1f;
    const float inside = max(1 - dot(q, q), 0.0f);
    densities.push_back(inside);
    temperatures.push_back(kHot * (0.8f + 0.2f * inside));
  }
  flame.density = grid_of(std::move(densities));
  flame.temperature = grid_of(std::move(temperatures));
  return flame;
}

/// Adds a flame 0.8 m high to the scene, in fog if that has an extinction.
inline void add_flame(SceneBuilder* b, Vec3f foot, float extinction, Vec3f fog = {}) {
  MediaBuilder media;
  media.add(make_flame({0.4f, 0.4f, 0.8f}, foot),
            media.add_medium(Vec3f{1, 1.3f, 1.7f} * extinction, {0.3f, 0.3f, 0.3f},
                             {0.5f, 0.5f, 0.5f}, 1e-3f));
  if (max_component(fog) > 0) {
    media.add_box({4, 4, 2}, {0, 0, 1}, 1, media.add_medium(fog, {0.9f, 0.9f, 0.9f}));
  }
  b->description.media = media.media;
  b->description.volumes = media.volumes;
}

}  // namespace gloam
