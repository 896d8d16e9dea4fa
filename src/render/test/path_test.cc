// The path stage: furnaces, estimators that must agree, leaks, transparency, depth of paths.

#include <gtest/gtest.h>

#include "render/test/probe.h"

namespace gloam {
namespace {

/// Mean luminance of an object that fills the view, under a sky of luminance 1.
Mean furnace(ShapeType shape, const MaterialDescription& material, int depth) {
  SceneBuilder b;
  Image8 face{1, 1, 3, ColorSpace::kLinear, {255, 255, 255}};
  b.description.textures.push_back({"sky", std::vector<Image8>(6, face)});
  b.description.sky.texture = 0;
  b.description.sky.scale = 1;
  const int m = b.add_material(material);
  if (shape == ShapeType::kMesh) {
    b.add(shape, {}, {}, m, 0, b.add_mesh(make_ball(24)));
  } else {
    b.add(shape, {1, 1, 1}, {}, m);
  }
  const CameraView view = SceneBuilder::camera(look_at({4, 3, 2}, {0, 0, 0}), 24, 24, 14);
  return picture_mean(b.render(view, settings_of(256, depth)));
}

TEST(Path, WhiteFurnaceReturnsAllLight) {
  for (const ShapeType shape : {ShapeType::kSphere, ShapeType::kBox}) {
    for (const float metallic : {0.0f, 1.0f}) {
      for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
        for (const float layer : {0.0f, 1.0f}) {
          MaterialDescription m;
          m.base_color = {1, 1, 1};
          m.metallic = metallic;
          m.roughness = roughness;
          m.specular_weight = layer;
          const Mean mean = furnace(shape, m, 8);
          EXPECT_NEAR(mean.mean, 1, 4 * mean.standard_error() + 5e-3)
              << "metallic " << metallic << " roughness " << roughness << " layer " << layer;
        }
      }
    }
  }
}

TEST(Path, GreyFurnaceStaysBelowOne) {
  MaterialDescription m;
  m.base_color = {0.5f, 0.5f, 0.5f};
  m.specular_weight = 0;
  const Mean diffuse = furnace(ShapeType::kSphere, m, 8);
  EXPECT_NEAR(diffuse.mean, 0.5, 4 * diffuse.standard_error() + 1e-3);
  m.specular_weight = 1;
  for (const float roughness : {0.2f, 0.8f}) {
    m.roughness = roughness;
    const Mean coated = furnace(ShapeType::kSphere, m, 8);
    EXPECT_GT(coated.mean, 0.5);
    EXPECT_LT(coated.mean, 0.62);
  }
}

TEST(Path, SmoothNormalsOfCoarseMeshesDoNotGainEnergy) {
  MaterialDescription m;
  m.base_color = {1, 1, 1};
  for (const float roughness : {0.2f, 0.9f}) {
    m.roughness = roughness;
    const Mean mean = furnace(ShapeType::kMesh, m, 8);
    EXPECT_LT(mean.mean, 1 + 4 * mean.standard_error() + 1e-3);
    EXPECT_GT(mean.mean, 0.9);
  }
}

TEST(Path, ClosedWhiteRoomFollowsTheGeometricSeries) {
  // Inside a Lambertian box of albedo a whose walls also emit L: sum of a^k L over k < max_depth.
  SceneBuilder b;
  MaterialDescription m;
  m.base_color = {0.6f, 0.6f, 0.6f};
  m.specular_weight = 0;
  m.emission = {10, 10, 10};
  // Six planes that face inwards: solids shine outwards only.
  const int wall = b.add_material(m);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const Vec3f z =
          Vec3f{axis == 0 ? 1.0f : 0, axis == 1 ? 1.0f : 0, axis == 2 ? 1.0f : 0} * side;
      const Frame f = Frame::from_z(-z);
      b.add(ShapeType::kPlane, {1, 1, 0}, {f.x, f.y, f.z, z}, wall);
    }
  }
  const CameraView view = SceneBuilder::camera(look_at({0.3f, 0.2f, 0.1f}, {1, 0.3f, -0.2f}), 8, 8);
  for (const int depth : {1, 2, 3, 5}) {
    double expected = 0;
    for (int k = 0; k < depth; ++k) expected += 10 * std::pow(0.6, k);
    const Mean mean = picture_mean(b.render(view, settings_of(512, depth)));
    EXPECT_NEAR(mean.mean, expected, 4 * mean.standard_error() + 1e-4) << "depth " << depth;
  }
  // Russian roulette changes the noise, not the mean.
  RenderSettings roulette = settings_of(2048, 30);
  roulette.roulette_depth = 2;
  const Mean mean = picture_mean(b.render(view, roulette));
  EXPECT_NEAR(mean.mean, 10 / 0.4 * (1 - std::pow(0.6, 30)), 4 * mean.standard_error());
}

/// Direct light at first hits by one technique alone, without weights.
Mean one_technique(const Probe& probe, const CameraView& view, bool by_light, int draws) {
  Mean mean;
  CameraView32 camera;
  camera.fx = camera.fy = static_cast<float>(view.intrinsics.fx);
  camera.cx = static_cast<float>(view.intrinsics.cx);
  camera.cy = static_cast<float>(view.intrinsics.cy);
  camera.pose = {view.X_WC_open, view.X_WC_open, {}};
  for (uint32_t i = 0; i < static_cast<uint32_t>(draws); ++i) {
    Sampler sampler = draw(i, 77);
    RayCone cone;
    const Vec2f pixel = sampler.next_2d();
    const Ray ray = camera_ray(camera, pixel.x * view.intrinsics.width,
                               pixel.y * view.intrinsics.height, 0, &cone);
    RayHit hit;
    double value = 0;
    if (probe.tracer.trace(ray, false, &hit)) {
      const Surface s = make_surface(probe.view, ray, hit, cone);
      value = s.emission.x;
      Frame frame;
      const LayeredBsdf bsdf = surface_bsdf(probe.view, s, -ray.d, &frame);
      const Vec3f wo = frame.to_local(-ray.d);
      const float pick = sampler.next_1d();
      const Vec2f u = sampler.next_2d();
      if (by_light) {
        LightSampler light_sampler;
        light_sampler.prepare(probe.view, s.p, s.geometric);
        const LightSample light = light_sampler.sample(probe.view, s.p, u, 0);
        if (light.pdf > 0 && dot(light.wi, s.geometric) > 0) {
          float pdf = 0;
          const Vec3f f = eval_bsdf(bsdf, wo, frame.to_local(light.wi), &pdf);
          Ray shadow = make_ray(leave_surface(s.p, s.geometric, light.wi, hit.t), light.wi);
          shadow.tmax = light.distance * 0.9999f;
          if (!probe.tracer.trace(shadow, true, &hit)) value += f.x * light.radiance.x / light.pdf;
        }
      } else {
        const BsdfSample sample = sample_bsdf(bsdf, wo, pick, u);
        const Vec3f wi = frame.to_world(sample.wi);
        if (sample.pdf > 0 && dot(wi, s.geometric) > 0) {
          const Ray next = make_ray(leave_surface(s.p, s.geometric, wi, hit.t), wi);
          if (probe.tracer.trace(next, false, &hit)) {
            const Surface e = make_surface(probe.view, next, hit, cone);
            value += sample.weight.x * e.emission.x;
          }
        }
      }
    }
    mean.add(value);
  }
  return mean;
}

TEST(Path, NextEventBsdfAndBothTogetherAgree) {
  SceneBuilder b;
  MaterialDescription glossy;
  glossy.base_color = {0.7f, 0.7f, 0.7f};
  glossy.roughness = 0.35f;
  b.add(ShapeType::kBox, {3, 3, 0.1f}, translation({0, 0, -0.1f}), b.add_material(glossy));
  b.add(ShapeType::kSphere, {0.4f, 0, 0}, translation({0.2f, 0.6f, 0.4f}),
        b.add_diffuse({0.5f, 0.5f, 0.5f}));
  b.add(ShapeType::kBox, {0.6f, 0.02f, 0.4f}, rigid({1, 0, 0}, 0.4f, {0, 1.8f, 1.2f}),
        b.add_emitter({100, 100, 100}));
  b.add(ShapeType::kSphere, {0.3f, 0, 0}, translation({-1.0f, 0.5f, 0.9f}),
        b.add_emitter({60, 60, 60}));
  const CameraView view = SceneBuilder::camera(look_at({0, -3, 1.5f}, {0, 0.3f, 0.3f}), 32, 32, 40);
  const Probe probe(b);
  const Mean light = one_technique(probe, view, true, 1000000);
  const Mean bsdf = one_technique(probe, view, false, 1000000);
  RenderSettings settings = settings_of(1024, 2);
  Mean both = picture_mean(b.render(view, settings));
  const auto agree = [](const Mean& x, const Mean& y, double slack) {
    EXPECT_NEAR(x.mean, y.mean, 4 * std::hypot(x.standard_error(), y.standard_error()) + slack);
  };
  agree(light, bsdf, 0);
  // The renderer's pixel filter reaches beyond the picture's edge: a little slack for that.
  agree(light, both, 0.004 * both.mean);
  // And the weights do what they are for.
  EXPECT_LT(both.standard_error() * std::sqrt(1024.0), light.standard_error() * 1000);
}

TEST(Path, LampsCloseToASurfaceLoseNothing) {
  // The ceiling right beside a panel that hangs 5 mm under it, metres from the origin, against a
  // path tracer without next event estimation.
  SceneBuilder b;
  const Affine3f X = translation({4, -3, 2});
  b.add(ShapeType::kBox, {2, 2, 0.1f}, X * translation({0, 0, 0.1f}),
        b.add_diffuse({0.8f, 0.8f, 0.8f}));
  b.add(ShapeType::kBox, {0.02f, 0.02f, 0.005f}, X * translation({0, 0, -0.01f}),
        b.add_emitter({1000, 1000, 1000}));
  const CameraView view =
      SceneBuilder::camera(X * look_at({0.25f, 0, -0.1f}, {0.06f, 0, 0}), 24, 24, 8);
  const Probe probe(b);
  Mean brute;
  CameraView32 camera;
  camera.fx = camera.fy = static_cast<float>(view.intrinsics.fx);
  camera.cx = camera.cy = 12;
  camera.pose = {view.X_WC_open, view.X_WC_open, {}};
  for (uint32_t i = 0; i < 1000000; ++i) {
    Sampler sampler = draw(i, 3);
    RayCone cone;
    const Vec2f offset = sample_pixel_filter(sampler.next_2d());
    const float x = static_cast<float>(i % 24), y = static_cast<float>(i / 24 % 24);
    Ray ray = camera_ray(camera, x + 0.5f + offset.x, y + 0.5f + offset.y, 0, &cone);
    double value = 0, throughput = 1;
    for (int depth = 0; depth < 2; ++depth) {
      RayHit hit;
      if (!probe.tracer.trace(ray, false, &hit)) break;
      const Surface s = make_surface(probe.view, ray, hit, cone);
      value += throughput * s.emission.x;
      throughput *= s.base_color.x;
      const Vec3f wi =
          Frame::from_z(s.normal).to_world(sample_cosine_hemisphere(sampler.next_2d()));
      ray = make_ray(leave_surface(s.p, s.geometric, wi, hit.t), wi);
    }
    brute.add(value);
  }
  const Mean path = picture_mean(b.render(view, settings_of(256, 2)));
  EXPECT_NEAR(path.mean, brute.mean,
              4 * std::hypot(path.standard_error(), brute.standard_error()) + 0.003 * brute.mean);
}

TEST(Path, NoLightLeaksIntoAClosedBox) {
  for (const bool moving : {false, true}) {
    SceneBuilder b;
    const int white = b.add_diffuse({1, 1, 1});
    const int body = moving ? b.add_body(rigid(normalize(Vec3f{1, 2, 3}), 0.8f, {7, -4, 2})) : 0;
    const Affine3f X_WB = moving ? rigid(normalize(Vec3f{1, 2, 3}), 0.8f, {7, -4, 2}) : Affine3f{};
    // Six abutting slabs; their inner edges coincide exactly.
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0f, 1.0f}) {
        Vec3f half{1, 1, 1}, p{};
        (axis == 0 ? half.x : axis == 1 ? half.y : half.z) = 0.02f;
        (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = side * 1.02f;
        b.add(ShapeType::kBox, half, translation(p), white, body);
      }
    }
    // Edges of 0.04 x 0.04 close the gaps between the slabs.
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 4; ++k) {
        const float s = (k & 1) != 0 ? 1.02f : -1.02f, t = (k & 2) != 0 ? 1.02f : -1.02f;
        const Vec3f p = axis == 0 ? Vec3f{0, s, t} : axis == 1 ? Vec3f{s, 0, t} : Vec3f{s, t, 0};
        Vec3f half{0.02f, 0.02f, 0.02f};
        (axis == 0 ? half.x : axis == 1 ? half.y : half.z) = 1.04f;
        b.add(ShapeType::kBox, half, translation(p), white, body);
      }
    }
    LightDescription sun;
    sun.intensity = {1e6f, 1e6f, 1e6f};
    sun.radius = 0.5f;
    for (const Vec3f p : {Vec3f{5, 4, 6}, Vec3f{-5, -4, -6}, Vec3f{0, -6, 0}}) {
      b.add_light(sun, transform_point(X_WB, p));
    }
    b.description.sky.ambient = {1000, 1000, 1000};
    CameraView view = SceneBuilder::camera(X_WB * look_at({0, 0, 0}, {1, 1, 0.9f}), 96, 96, 100);
    const Film film = b.render(view, settings_of(16, 6));
    for (const Vec3f& c : film.radiance) ASSERT_EQ(c.x, 0) << "moving " << moving;
  }
}

TEST(Path, OpacityIsTransmission) {
  // Three sheets of opacity 0.3 over a white emitter: 0.7³ of its luminance, in both tiers; and a
  // shadow through them is as grey.
  SceneBuilder b;
  MaterialDescription sheet;
  sheet.base_color = {0, 0, 0};
  sheet.specular_weight = 0;
  sheet.opacity = 0.3f;
  const int m = b.add_material(sheet);
  for (int i = 0; i < 3; ++i) {
    b.add(ShapeType::kPlane, {2, 2, 0}, translation({0, 0, 1 + 0.1f * i}), m);
  }
  b.add(ShapeType::kPlane, {}, {}, b.add_emitter({50, 50, 50}));
  const CameraView view = SceneBuilder::camera(look_at({0.1f, 0, 3}, {0, 0, 0}), 16, 16, 5);
  const Mean path = picture_mean(b.render(view, settings_of(256)));
  EXPECT_NEAR(path.mean, 50 * 0.343, 4 * path.standard_error() + 1e-3);
  RenderSettings direct = settings_of(1);
  direct.tier = RenderTier::kDirect;
  EXPECT_NEAR(picture_mean(b.render(view, direct)).mean, 50 * 0.343, 0.01);

  SceneBuilder s;
  const int sheet_s = s.add_material(sheet);
  for (int i = 0; i < 3; ++i) {
    s.add(ShapeType::kBox, {1, 1, 0.01f}, translation({0, 0, 1 + 0.1f * i}), sheet_s);
  }
  s.add(ShapeType::kPlane, {}, {}, s.add_diffuse({0.5f, 0.5f, 0.5f}));
  LightDescription light;
  light.intensity = {100, 100, 100};
  s.add_light(light, {0, 0, 2});
  const CameraView side = SceneBuilder::camera(look_at({6, 0, 0.8f}, {0, 0, 0}), 4, 4, 0.02);
  const double expected = 0.5 / M_PI * 25 * std::pow(0.7, 6);  // each box has two faces
  const Mean shadow = picture_mean(s.render(side, settings_of(64, 2)));
  EXPECT_NEAR(shadow.mean, expected, 1e-3 * expected);
}

TEST(Path, InvisibleGeomsAreNotThere) {
  SceneBuilder b;
  MaterialDescription ghost;
  ghost.opacity = 0;
  b.add(ShapeType::kBox, {1, 1, 1}, {}, b.add_material(ghost));
  const CameraView view = SceneBuilder::camera(look_at({5, 0, 0}, {0, 0, 0}), 4, 4);
  const Film film = b.render(view, settings_of(1));
  EXPECT_EQ(film.part[5], 0u);
  EXPECT_TRUE(std::isinf(film.depth[5]));
}

TEST(Path, DirectTierEqualsPathTierOfOneReflection) {
  SceneBuilder b;
  MaterialDescription m;
  m.roughness = 0.5f;
  b.add(ShapeType::kPlane, {}, {}, b.add_material(m));
  b.add(ShapeType::kSphere, {0.5f, 0, 0}, translation({0, 0, 0.5f}),
        b.add_diffuse({0.6f, 0.3f, 0.1f}));
  LightDescription light;
  light.intensity = {100, 100, 100};
  b.add_light(light, {1, -1, 2});
  light.type = PunctualLightType::kDirectional;
  light.intensity = {20, 20, 20};
  b.add_light(light, {0, 0, 3}, normalize(Vec3f{1, 1, -2}));
  const CameraView view = SceneBuilder::camera(look_at({3, -3, 2}, {0, 0, 0.4f}), 32, 32, 30);
  RenderSettings path = settings_of(256, 2), direct = settings_of(256, 2);
  direct.tier = RenderTier::kDirect;
  const Mean a = picture_mean(b.render(view, path)), c = picture_mean(b.render(view, direct));
  EXPECT_NEAR(a.mean, c.mean, 4 * std::hypot(a.standard_error(), c.standard_error()));
}

}  // namespace
}  // namespace gloam
