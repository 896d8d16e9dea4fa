#pragma once
// A furnished room with a four-legged body of dense meshes: the work of bench/path_rate.cc.

#include "render/test/scene_builder.h"

namespace gloam {

struct RoomOptions {
  int robot_triangles = 418000;
  bool textured = true;
  bool plain = false;   ///< Lambert only, one area light: what every path tracer has alike
  bool meshes = false;  ///< furniture and walls as triangle meshes, not as MuJoCo's boxes
};

inline int room_material(SceneBuilder* b, const RoomOptions& options, Vec3f color, float roughness,
                         float metallic = 0) {
  if (options.plain) return b->add_diffuse(color);
  MaterialDescription m;
  m.base_color = color;
  m.roughness = roughness;
  m.metallic = metallic;
  return b->add_material(m);
}

/// 6 x 5 x 2.8 m, table, shelf, sofa, 20 boxes, a robot of 13 mesh instances in the middle.
inline SceneBuilder make_room(const RoomOptions& options) {
  SceneBuilder b;
  const int white = room_material(&b, options, {0.75f, 0.74f, 0.70f}, 0.7f);
  const int red = room_material(&b, options, {0.60f, 0.10f, 0.08f}, 0.6f);
  const int green = room_material(&b, options, {0.12f, 0.40f, 0.12f}, 0.6f);
  const int wood = room_material(&b, options, {0.42f, 0.26f, 0.13f}, 0.35f);
  const int dark = room_material(&b, options, {0.08f, 0.08f, 0.09f}, 0.4f);
  const int steel = room_material(&b, options, {0.60f, 0.60f, 0.62f}, 0.25f, 1.0f);
  const int blue = room_material(&b, options, {0.10f, 0.20f, 0.50f}, 0.5f);
  int floor = wood;
  if (options.textured && !options.plain) {
    MaterialDescription m;
    m.base_color = {0.8f, 0.8f, 0.8f};
    m.roughness = 0.3f;
    m.mapping = TextureMapping::kUv;
    m.texture_uniform = true;
    m.texture_repeat = {2, 2};
    m.textures.base_color = b.add_texture(make_checker(256, 2, 90, 200));
    floor = b.add_material(m);
  }
  const auto box = [&b, &options](Vec3f half, Vec3f p, int material, float yaw = 0) {
    const Affine3f X = rigid({0, 0, 1}, yaw, p);
    if (options.meshes) {
      b.add(ShapeType::kMesh, {}, X, material, 0, b.add_mesh(make_box(half)));
    } else {
      b.add(ShapeType::kBox, half, X, material);
    }
  };
  box({3.1f, 2.6f, 0.05f}, {0, 0, -0.05f}, floor);
  box({3.1f, 2.6f, 0.05f}, {0, 0, 2.85f}, white);
  box({0.05f, 2.6f, 1.4f}, {-3.05f, 0, 1.4f}, red);
  box({0.05f, 2.6f, 1.4f}, {3.05f, 0, 1.4f}, green);
  box({3.1f, 0.05f, 1.4f}, {0, 2.55f, 1.4f}, white);
  box({3.1f, 0.05f, 1.4f}, {0, -2.55f, 1.4f}, white);
  // Table, shelf, sofa.
  box({0.7f, 0.4f, 0.02f}, {-1.6f, 1.5f, 0.72f}, wood, 0.1f);
  for (int i = 0; i < 4; ++i) {
    box({0.03f, 0.03f, 0.35f},
        {-1.6f + ((i & 1) != 0 ? 0.6f : -0.6f), 1.5f + ((i & 2) != 0 ? 0.3f : -0.3f), 0.35f}, wood);
  }
  for (int i = 0; i < 5; ++i) box({0.5f, 0.15f, 0.012f}, {1.8f, 2.3f, 0.3f + 0.4f * i}, wood);
  box({0.012f, 0.15f, 1.0f}, {1.3f, 2.3f, 1.0f}, wood);
  box({0.012f, 0.15f, 1.0f}, {2.3f, 2.3f, 1.0f}, wood);
  box({0.4f, 0.9f, 0.2f}, {2.4f, -0.6f, 0.2f}, blue);
  box({0.12f, 0.9f, 0.4f}, {2.75f, -0.6f, 0.6f}, blue);
  for (int i = 0; i < 20; ++i) {
    const float a = 2.399963f * static_cast<float>(i), r = 0.9f + 0.075f * static_cast<float>(i);
    const float s = 0.05f + 0.012f * static_cast<float>(i % 5);
    const int materials[] = {red, green, blue, steel, white};
    box({s, s, s}, {r * std::cos(a), 0.9f * r * std::sin(a), s}, materials[i % 5], a);
  }
  const float radii[] = {0.15f, 0.12f};
  b.add(ShapeType::kSphere, {0.18f, 0, 0}, translation({-0.9f, -0.9f, 0.18f}), steel);
  b.add(ShapeType::kCylinder, {radii[1], 0.3f, 0}, translation({0.9f, 1.0f, 0.3f}), white);
  b.add(ShapeType::kCapsule, {radii[1], 0.2f, 0}, rigid({1, 0, 0}, 1.57f, {-2, -1.5f, 0.12f}), red);
  // Robot: trunk and four legs of three links, instances of four meshes, each a moving body.
  const int rings = static_cast<int>(std::sqrt(options.robot_triangles / 13.0 / 4.0));
  int mesh[4];
  for (int i = 0; i < 4; ++i) mesh[i] = b.add_mesh(make_ball(rings, 0.15f, 4 + 3 * i));
  const auto link = [&](int m, Vec3f half, Vec3f p, float pitch, int material) {
    const int body = b.add_body(rigid({0, 1, 0}, pitch, p));
    TriangleMesh& shape = b.description.meshes[static_cast<size_t>(mesh[m])];
    if (std::fabs(length(shape.positions[0]) - 1) < 0.3f) {  // scale each mesh once
      for (Vec3f& v : shape.positions) v = v * half;
      for (Vec3f& n : shape.normals) {
        n = normalize(Vec3f{n.x / half.x, n.y / half.y, n.z / half.z});
      }
    }
    b.add(ShapeType::kMesh, {}, {}, material, body, mesh[m]);
  };
  link(0, {0.27f, 0.12f, 0.08f}, {0, 0, 0.34f}, 0, dark);
  for (int leg = 0; leg < 4; ++leg) {
    const float x = (leg & 1) != 0 ? 0.19f : -0.19f, y = (leg & 2) != 0 ? 0.13f : -0.13f;
    link(1, {0.05f, 0.04f, 0.05f}, {x, y, 0.33f}, 0, steel);
    link(2, {0.035f, 0.03f, 0.12f}, {x - 0.06f, y * 1.1f, 0.24f}, 0.6f, dark);
    link(3, {0.022f, 0.022f, 0.11f}, {x - 0.06f, y * 1.1f, 0.10f}, -0.7f, steel);
  }
  if (options.plain) {
    b.add(ShapeType::kBox, {0.4f, 0.4f, 0.01f}, translation({0.3f, -0.2f, 2.7f}),
          b.add_emitter({12000, 11500, 10500}));
  } else {
    LightDescription lamp;
    lamp.intensity = {620, 590, 540};
    lamp.radius = 0.08f;
    b.add_light(lamp, {0.5f, -0.4f, 2.4f});
    b.add(ShapeType::kBox, {0.5f, 0.02f, 0.4f}, translation({-0.6f, 2.49f, 1.5f}),
          b.add_emitter({900, 1000, 1150}));  // a window
  }
  b.description.extent = 4;
  return b;
}

inline CameraView room_camera(int width, int height) {
  return SceneBuilder::camera(look_at({-2.3f, -2.1f, 1.35f}, {0.2f, 0.2f, 0.45f}), width, height,
                              52);
}

}  // namespace gloam
