#pragma once
// Scenes that the card and the CPU render alike.

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "render/test/media_probe.h"

namespace gloam {

inline constexpr int kWidth = 192, kHeight = 128;

struct Case {
  const char* name;
  SceneBuilder scene;
  PoseFrame close;  ///< of the shutter
  CameraView view;
  bool moves = false;
};

inline LightDescription lamp(Vec3f intensity, float radius) {
  LightDescription light;
  light.intensity = intensity;
  light.radius = radius;
  return light;
}

/// Every shape on a floor between walls, under two lamps.
inline SceneBuilder all_shapes(const std::function<int(SceneBuilder*, int)>& material) {
  SceneBuilder b;
  const int white = b.add_diffuse({0.7f, 0.7f, 0.7f});
  b.add(ShapeType::kBox, {4, 4, 0.1f}, translation({0, 0, -0.1f}), white);
  b.add(ShapeType::kBox, {0.1f, 4, 2}, translation({3, 0, 2}), material(&b, 0));
  b.add(ShapeType::kPlane, {0, 0, 1}, translation({0, 0, -0.5f}), white);
  const ShapeType shapes[] = {ShapeType::kBox,     ShapeType::kSphere,   ShapeType::kEllipsoid,
                              ShapeType::kCapsule, ShapeType::kCylinder, ShapeType::kPlane,
                              ShapeType::kMesh};
  const int ball = b.add_mesh(make_ball(60, 0.2f));
  for (int i = 0; i < 21; ++i) {
    const float a = 0.9f * static_cast<float>(i), r = 0.4f + 0.1f * static_cast<float>(i);
    const Vec3f p{r * std::cos(a), r * std::sin(a), 0.5f + 0.05f * static_cast<float>(i % 5)};
    const ShapeType shape = shapes[i % 7];
    const Affine3f X = rigid(normalize(Vec3f{1, 0.3f * static_cast<float>(i % 4), 0.5f}), a, p);
    const int body = i % 2 == 0 ? 0 : b.add_body(X);
    const bool mesh = shape == ShapeType::kMesh;
    if (mesh && b.description.instances.size() < 12) {
      for (Vec3f& v : b.description.meshes[static_cast<size_t>(ball)].positions) v = v * 0.25f;
    }
    b.add(shape, {0.2f, 0.15f, 0.12f}, body == 0 ? X : Affine3f{}, material(&b, i), body,
          mesh ? ball : -1);
  }
  b.add_light(lamp({60, 55, 50}, 0.1f), {-1, -1, 3});
  b.add_light(lamp({20, 25, 40}, 0), {1, 2, 2.5f});
  b.description.extent = 4;
  return b;
}

inline CameraView usual_view() {
  return SceneBuilder::camera(look_at({-3.2f, -2.4f, 1.9f}, {0, 0, 0.5f}), kWidth, kHeight, 50);
}

inline int plain_material(SceneBuilder* b, int i) {
  MaterialDescription m;
  m.base_color = {0.3f + 0.1f * static_cast<float>(i % 5), 0.5f,
                  0.8f - 0.1f * static_cast<float>(i % 7)};
  m.roughness = 0.2f + 0.1f * static_cast<float>(i % 6);
  m.metallic = i % 3 == 0 ? 1.0f : 0.0f;
  return b->add_material(m);
}

inline int rich_material(SceneBuilder* b, int i) {
  MaterialDescription m;
  m.base_color = {0.8f, 0.6f, 0.4f};
  m.roughness = 0.3f;
  if (i % 4 == 0) {
    m.mapping = TextureMapping::kUv;
    m.textures.base_color = b->add_texture(make_checker(64, 4, 60, 220));
  }
  if (i % 4 == 1) {
    m.transmission_weight = 1;
    m.roughness = 0.1f;
  }
  if (i % 4 == 2) {
    m.coat_weight = 0.8f;
    m.fuzz_weight = 0.3f;
  }
  if (i % 4 == 3) m.opacity = 0.6f;
  return b->add_material(m);
}

inline std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"plain", all_shapes(plain_material), {}, usual_view()});
  all.push_back({"plain, moving", all_shapes(plain_material), {}, usual_view(), true});
  all.push_back(
      {"layers, textures, glass, transparency", all_shapes(rich_material), {}, usual_view()});
  Case glow{"emitters and an even sky", all_shapes(plain_material), {}, usual_view()};
  glow.scene.add(ShapeType::kBox, {0.5f, 0.5f, 0.02f}, translation({0, 0, 3}),
                 glow.scene.add_emitter({90, 80, 70}));
  glow.scene.add(ShapeType::kSphere, {0.15f, 0, 0}, translation({-1, 1, 1.5f}),
                 glow.scene.add_emitter({400, 300, 100}));
  glow.scene.description.sky.ambient = {2, 2.5f, 3};
  all.push_back(glow);
  Case crowd{"many lights", all_shapes(plain_material), {}, usual_view()};
  for (int i = 0; i < 40; ++i) {
    crowd.scene.add_light(lamp({3, 3, 3}, i % 2 == 0 ? 0.05f : 0.0f),
                          {-2 + 0.1f * static_cast<float>(i), 2 - 0.1f * static_cast<float>(i), 2});
  }
  all.push_back(crowd);
  Case smoke{"smoke over layers", all_shapes(rich_material), {}, usual_view()};
  MediaBuilder media;
  media.add_box({3, 3, 2}, {0, 0, 1}, 0.4f, media.add_medium({1, 1.2f, 1.5f}, {0.8f, 0.7f, 0.6f}));
  smoke.scene.description.media = media.media;
  smoke.scene.description.volumes = media.volumes;
  all.push_back(smoke);
  // Rays of paths and of shadows go on through panes, in fog; a sky is sampled beside the lamps.
  Case panes{"panes in fog under a sky", smoke.scene, {}, usual_view()};
  MaterialDescription pane;
  pane.transmission_weight = 1;
  pane.thin_walled = true;
  pane.roughness = 0;
  pane.transmission_color = {0.9f, 0.7f, 0.6f};
  const int sheet = panes.scene.add_material(pane);
  for (int i = 0; i < 4; ++i) {
    const float along = 0.5f * static_cast<float>(i);
    panes.scene.add(ShapeType::kBox, {1.5f, 0.01f, 1},
                    rigid({0, 0, 1}, along, {along - 1, -0.6f - along, 1}), sheet);
  }
  panes.scene.add(ShapeType::kSphere, {0.15f, 0, 0}, translation({-1, 1, 1.5f}),
                  panes.scene.add_emitter({400, 300, 100}));
  panes.scene.description.sky.environment = {
      "even", 2, 2, {{3, 3, 4}, {4, 3, 3}, {1, 2, 1}, {2, 1, 1}}};
  all.push_back(panes);
  Case lens{"a wide lens' rolling shutter", all_shapes(plain_material), {}, usual_view(), true};
  lens.view.intrinsics.lens = LensModel::kEquidistant;
  lens.view.shutter = {0.1f, 0.5f, 0.4f / kHeight};
  all.push_back(lens);
  Case soft{"an aperture", all_shapes(rich_material), {}, usual_view()};
  soft.view.aperture = {0.05f, 3};
  all.push_back(soft);
  for (const bool moves : {false, true}) {
    Case clip{"a clipped view", all_shapes(rich_material), {}, usual_view(), moves};
    clip.view.near = 2.6f;
    clip.view.culls_backs = true;
    std::vector<uint8_t> hidden(clip.scene.description.instances.size());
    for (size_t i = 5; i < hidden.size(); i += 3) hidden[i] = 1;
    clip.view.hidden = std::make_shared<const std::vector<uint8_t>>(hidden);
    all.push_back(clip);
  }
  for (Case& c : all) {
    c.close = c.scene.frame;
    if (!c.moves) continue;
    for (size_t body = 1; 3 * body < c.close.body_p.size(); ++body) {
      c.close.body_p[3 * body] += 0.08;
      c.close.body_p[3 * body + 2] += 0.05;
    }
    c.view.X_WC_keys = {c.view.X_WC_open, c.view.X_WC_open};
    c.view.X_WC_keys.back().p += Vec3f{0.02f, 0, 0};
  }
  return all;
}

class OnCard : public testing::Test {
 protected:
  void SetUp() override {
    const auto name = cuda_device_name();
    if (!name.ok()) GTEST_SKIP() << name.error().to_string();
    std::printf("on %s\n", name->c_str());
  }
};

inline std::unique_ptr<Renderer> on_card(const Case& c) {
  auto renderer = make_cuda_renderer(c.scene.description);
  GLOAM_CHECK(renderer.ok(), "the test's scene is refused");
  (*renderer)->update(c.scene.frame, c.close, c.scene.frame);
  return std::move(*renderer);
}
inline std::unique_ptr<Renderer> on_cpu(const Case& c) {
  auto renderer = make_cpu_renderer(c.scene.description, RayTracer::kOwn);
  GLOAM_CHECK(renderer.ok(), "the test's scene is refused");
  (*renderer)->update(c.scene.frame, c.close, c.scene.frame);
  return std::move(*renderer);
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace gloam
