#pragma once
// Scenes with noise of several kinds, for the tests and the bench of adaptive sampling.

#include "render/test/scene_builder.h"

namespace gloam {

struct NoiseScene {
  const char* name;
  SceneBuilder builder;
  CameraView view;
  float floor;  ///< error_floor that suits its light [cd/m²]
};

inline SceneBuilder closed_room(int wall) {
  SceneBuilder b;
  const auto box = [&](Vec3f half, Vec3f p) { b.add(ShapeType::kBox, half, translation(p), wall); };
  box({2, 2, 0.1f}, {0, 0, -0.1f});
  box({2, 2, 0.1f}, {0, 0, 2.9f});
  box({0.1f, 2, 1.5f}, {-2.1f, 0, 1.4f});
  box({0.1f, 2, 1.5f}, {2.1f, 0, 1.4f});
  box({2, 0.1f, 1.5f}, {0, 2.1f, 1.4f});
  box({2, 0.1f, 1.5f}, {0, -2.1f, 1.4f});
  return b;
}

/// A room under a panel, with a shiny ball and a table that shades it.
inline NoiseScene room_scene(int width, int height) {
  SceneBuilder b = closed_room(0);
  b.add_diffuse({0.7f, 0.68f, 0.62f});
  MaterialDescription steel;
  steel.base_color = {0.6f, 0.6f, 0.62f};
  steel.roughness = 0.25f;
  steel.metallic = 1;
  b.add(ShapeType::kSphere, {0.35f, 0, 0}, translation({0.3f, 0.5f, 0.35f}), b.add_material(steel));
  const int wood = b.add_diffuse({0.42f, 0.26f, 0.13f});
  b.add(ShapeType::kBox, {0.7f, 0.5f, 0.02f}, translation({-0.7f, 0.3f, 0.75f}), wood);
  b.add(ShapeType::kBox, {0.4f, 0.4f, 0.01f}, translation({0, 0, 2.75f}),
        b.add_emitter({800, 760, 700}));
  return {
      "room", b,
      SceneBuilder::camera(look_at({-1.2f, -1.8f, 1.4f}, {0.1f, 0.6f, 0.5f}), width, height, 60),
      2};
}

/// A glass ball under a small luminous ball: its caustic on the floor is found by chance alone.
inline NoiseScene caustic_scene(int width, int height) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 0}, {}, b.add_diffuse({0.6f, 0.6f, 0.6f}));
  MaterialDescription glass;
  glass.base_color = {1, 1, 1};
  glass.roughness = 0;
  glass.transmission_weight = 1;
  b.add(ShapeType::kSphere, {0.4f, 0, 0}, translation({0, 0, 0.45f}), b.add_material(glass));
  b.add(ShapeType::kSphere, {0.25f, 0, 0}, translation({0.8f, 0.8f, 2.2f}),
        b.add_emitter({3000, 3000, 3000}));
  b.description.sky.ambient = {4, 4, 4};
  return {"caustic", b,
          SceneBuilder::camera(look_at({-1.4f, -2.0f, 1.3f}, {0, 0, 0.3f}), width, height, 45), 2};
}

/// A dark room with a lamp behind a screen: most of the picture is indirect light.
inline NoiseScene lamp_scene(int width, int height) {
  SceneBuilder b = closed_room(0);
  b.add_diffuse({0.6f, 0.6f, 0.6f});
  const int dark = b.add_diffuse({0.1f, 0.1f, 0.1f});
  b.add(ShapeType::kBox, {0.02f, 1.2f, 1}, translation({0.6f, 0.8f, 1}), dark);
  b.add(ShapeType::kSphere, {0.06f, 0, 0}, translation({1.3f, 1.3f, 0.8f}),
        b.add_emitter({20000, 18000, 14000}));
  return {
      "lamp", b,
      SceneBuilder::camera(look_at({-1.7f, -1.7f, 1.5f}, {0.6f, 0.8f, 0.8f}), width, height, 60),
      1};
}

/// A sunny yard, whose light has no noise, and in it a shed that is lit through its door.
inline NoiseScene yard_scene(int width, int height) {
  SceneBuilder b;
  const int stone = b.add_diffuse({0.5f, 0.5f, 0.5f});
  b.add(ShapeType::kPlane, {0, 0, 0}, {}, stone);
  const auto box = [&](Vec3f half, Vec3f p) {
    b.add(ShapeType::kBox, half, translation(p), stone);
  };
  box({0.05f, 0.5f, 0.5f}, {-0.5f, 1, 0.5f});
  box({0.05f, 0.5f, 0.5f}, {0.5f, 1, 0.5f});
  box({0.55f, 0.05f, 0.5f}, {0, 1.5f, 0.5f});
  box({0.55f, 0.55f, 0.05f}, {0, 1, 1.05f});
  LightDescription sun;
  sun.type = PunctualLightType::kDirectional;
  sun.intensity = {100, 96, 90};
  b.add_light(sun, {0, 0, 5}, {0.6f, 0.5f, -0.7f});
  return {"yard", b,
          SceneBuilder::camera(look_at({0, -2.5f, 1.4f}, {0, 0.6f, 0.4f}), width, height, 55), 1};
}

inline std::vector<NoiseScene> noise_scenes(int width, int height) {
  return {room_scene(width, height), caustic_scene(width, height), lamp_scene(width, height),
          yard_scene(width, height)};
}

}  // namespace gloam
