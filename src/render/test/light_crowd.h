#pragma once
// Crowds of lights, for tests of the tree over them.

#include <vector>

#include "render/scene/light_tree_table.h"
#include "render/test/direction_check.h"

namespace gloam {

struct Crowd {
  const char* name;
  size_t count;
  float extent;  ///< half [m]
  float radius;  ///< of the lamps [m]
  bool spots, suns;
  bool shines_all_around;
};

inline std::vector<Crowd> all_crowds() {
  return {{"points", 400, 20, 0, false, false, true},
          {"spheres", 400, 20, 0.3f, false, false, true},
          {"spots", 400, 20, 0, true, false, false},
          {"spots_and_suns", 300, 5, 0.1f, true, true, false},
          {"huge", 300, 1e7f, 1e4f, true, true, false},
          {"tiny", 300, 1e-3f, 1e-5f, true, false, false},
          {"seventeen", 17, 3, 0.05f, false, false, true}};
}

/// Strengths over four decades, in clusters; every fourth a spot, every tenth a sun, where asked.
inline std::vector<LightView> make_crowd(const Crowd& crowd) {
  std::vector<LightView> lights(crowd.count);
  for (size_t i = 0; i < crowd.count; ++i) {
    const auto k = static_cast<uint32_t>(i);
    const auto share = [&](uint32_t of) { return random_2d(k, of).x; };
    LightView& light = lights[i];
    const Vec3f at{share(11) - 0.5f, share(12) - 0.5f, share(13) - 0.5f};
    const Vec3f place{random_2d(k % 9, 14).x - 0.5f, random_2d(k % 9, 15).x - 0.5f, 0};
    light.p = (at * (i % 2 == 0 ? 0.1f : 1.0f) + place) * crowd.extent;
    light.direction = sample_sphere(random_2d(k, 16));
    light.strength = std::pow(10.0f, 4 * share(17) - 2);
    light.intensity = Vec3f{1, 1, 1} * light.strength;
    light.radius = crowd.radius * (0.2f + share(18));
    if (crowd.spots && i % 4 != 0) {
      light.kind = LightKind::kSpot;
      light.cutoff = 0.1f + 2.5f * share(19);
      light.inner = light.cutoff * share(20);
      light.cos_cutoff = std::cos(light.cutoff);
      light.cos_inner = std::cos(light.inner);
      light.spread = light.inner;
      light.falloff = light.cutoff - light.inner;
    }
    if (crowd.suns && i % 10 == 3) {
      light.kind = LightKind::kDirectional;
      light.radius = 0.2f * share(21);
      light.spread = std::asin(light.radius);
    } else {
      light.reach = light.radius;
      light.half = Vec3f{1, 1, 1} * light.radius;
    }
    light.is_delta = light.radius <= 0;
  }
  return lights;
}

}  // namespace gloam
