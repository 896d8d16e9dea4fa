#pragma once
// A room that light comes into through a hole.

#include "render/test/scene_builder.h"

namespace gloam {

struct RoomLight {
  const char* name;
  float lamp;  ///< luminance of a sphere of 0.1 m inside [cd/m²]
  float sun;   ///< [lx], most of it blocked
  float sky;   ///< [cd/m²]
};

/// A closed white room, 4 m x 4 m x 3 m, with a square hole of 1 m in the wall at +x; a sky and a
/// sun outside and a lamp inside, where they give light.
inline SceneBuilder room_with_window(const RoomLight& light, bool is_guided) {
  SceneBuilder b;
  const int white = b.add_diffuse({0.7f, 0.7f, 0.7f});
  const auto wall = [&](Vec3f size, Vec3f p) {
    b.add(ShapeType::kBox, size, translation(p), white);
  };
  wall({2, 2, 0.1f}, {0, 0, -0.1f});
  wall({2, 2, 0.1f}, {0, 0, 3.1f});
  wall({0.1f, 2, 1.7f}, {-2.1f, 0, 1.5f});
  wall({2.2f, 0.1f, 1.7f}, {0, -2.1f, 1.5f});
  wall({2.2f, 0.1f, 1.7f}, {0, 2.1f, 1.5f});
  wall({0.1f, 2, 0.5f}, {2.1f, 0, 0.5f});
  wall({0.1f, 2, 0.5f}, {2.1f, 0, 2.5f});
  wall({0.1f, 0.75f, 0.5f}, {2.1f, -1.25f, 1.5f});
  wall({0.1f, 0.75f, 0.5f}, {2.1f, 1.25f, 1.5f});
  if (light.lamp > 0) {
    b.add(ShapeType::kSphere, {0.1f, 0.1f, 0.1f}, translation({-1, 0.5f, 2.5f}),
          b.add_emitter({light.lamp, light.lamp, light.lamp}));
  }
  if (light.sun > 0) {
    LightDescription sun;
    sun.type = PunctualLightType::kDirectional;
    sun.intensity = {light.sun, light.sun, light.sun};
    sun.radius = 0.01f;
    sun.is_static = is_guided;
    b.add_light(sun, {0, 0, 5}, {-0.8f, 0, -0.6f});
  }
  b.description.sky.ambient = {light.sky, light.sky, light.sky};
  if (!is_guided) {  // nothing static casts light or shadow: no guide
    for (InstanceDescription& instance : b.description.instances) instance.is_static = false;
  }
  return b;
}

}  // namespace gloam
