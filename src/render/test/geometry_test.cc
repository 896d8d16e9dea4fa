// Exact channels, shapes, instances, motion.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/parallel.h"
#include "base/rng.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

Vec3f random_direction(uint32_t i, uint32_t k) {
  const Philox4 d = philox4x32(5, k, i);
  return sample_sphere({uniform_float(d.v[0]), uniform_float(d.v[1])});
}

/// Signed distance to a shape in its own frame, in double precision.
double distance_to(ShapeType shape, Vec3f size, double x, double y, double z) {
  const double a = size.x, b = size.y, c = size.z;
  switch (shape) {
    case ShapeType::kSphere:
      return std::sqrt(x * x + y * y + z * z) - a;
    case ShapeType::kCapsule: {
      const double dz = z - std::clamp(z, -b, b);
      return std::sqrt(x * x + y * y + dz * dz) - a;
    }
    case ShapeType::kCylinder: {
      const double r = std::hypot(x, y) - a, h = std::abs(z) - b;
      return std::max(r, h);
    }
    case ShapeType::kEllipsoid: {
      const double k = std::sqrt(x * x / (a * a) + y * y / (b * b) + z * z / (c * c));
      const double g =
          std::sqrt(x * x / (a * a * a * a) + y * y / (b * b * b * b) + z * z / (c * c * c * c));
      return (k - 1) * k / g;  // first order
    }
    case ShapeType::kBox:
      return std::max({std::abs(x) - a, std::abs(y) - b, std::abs(z) - c});
    default:
      return z;
  }
}

TEST(Geometry, DepthOfEveryShapeIsExact) {
  const std::pair<ShapeType, Vec3f> cases[] = {
      {ShapeType::kBox, {0.3f, 0.5f, 0.2f}},       {ShapeType::kSphere, {0.5f, 0, 0}},
      {ShapeType::kEllipsoid, {0.5f, 0.2f, 0.3f}}, {ShapeType::kCapsule, {0.2f, 0.4f, 0}},
      {ShapeType::kCylinder, {0.3f, 0.3f, 0}},     {ShapeType::kPlane, {0, 0, 0}},
      {ShapeType::kPlane, {0.6f, 0.4f, 0}}};
  for (const bool on_body : {false, true}) {
    for (const auto& [shape, size] : cases) {
      SceneBuilder b;
      const Affine3f pose = rigid(normalize(Vec3f{1, 2, 3}), 0.6f, {2.5f, -1.5f, 0.75f});
      const int body = on_body ? b.add_body(pose) : 0;
      b.add(shape, size, on_body ? Affine3f{} : pose, b.add_diffuse({0.5f, 0.5f, 0.5f}), body);
      RenderSettings settings;
      settings.spp = 1;
      const Vec3f eye = pose.p + pose.z * 4.0f + pose.x * 1.5f;
      const CameraView view = SceneBuilder::camera(look_at(eye, pose.p), 96, 96, 30);
      const Film film = b.render(view, settings);
      int hits = 0;
      for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
          const size_t i = static_cast<size_t>(y) * 96 + x;
          // The hit, rebuilt in double precision from depth alone, must lie on the surface.
          const double cx = (x + 0.5 - 48) / view.intrinsics.fx,
                       cy = (48 - y - 0.5) / view.intrinsics.fy;
          if (std::isinf(film.depth[i])) continue;
          ++hits;
          const Affine3f& C = view.X_WC_open;
          double p[3], q[3] = {};
          for (int k = 0; k < 3; ++k) {
            p[k] = C.p[k] + film.depth[i] * (cx * C.x[k] + cy * C.y[k] - C.z[k]) - pose.p[k];
          }
          for (int k = 0; k < 3; ++k) {
            q[0] += p[k] * pose.x[k];
            q[1] += p[k] * pose.y[k];
            q[2] += p[k] * pose.z[k];
          }
          // At grazing angles the depth may be off by the distance over the cosine.
          const Vec3f d = normalize(C.x * float(cx) + C.y * float(cy) - C.z);
          const double cosine = std::abs(dot(film.center_normal[i], d));
          EXPECT_LT(std::abs(distance_to(shape, size, q[0], q[1], q[2])),
                    1e-5 * film.depth[i] * std::max(cosine, 0.02) + 1e-6)
              << "shape " << int(shape) << " at " << x << ", " << y;
          EXPECT_NEAR(film.distance[i], film.depth[i] * std::sqrt(1 + cx * cx + cy * cy), 1e-4);
          EXPECT_EQ(film.part[i], 1u);
          EXPECT_NEAR(length(film.center_normal[i]), 1, 1e-5);
        }
      }
      EXPECT_GT(hits, 200) << "shape " << int(shape);
    }
  }
}

TEST(Geometry, SilhouettesAreComplete) {
  // Rays aimed at points inside a shape hit it; rays past its bounding sphere do not.
  const std::pair<ShapeType, Vec3f> cases[] = {{ShapeType::kBox, {0.3f, 0.5f, 0.2f}},
                                               {ShapeType::kSphere, {0.5f, 0, 0}},
                                               {ShapeType::kEllipsoid, {0.5f, 0.2f, 0.3f}},
                                               {ShapeType::kCapsule, {0.2f, 0.4f, 0}},
                                               {ShapeType::kCylinder, {0.3f, 0.3f, 0}}};
  for (const auto& [shape, size] : cases) {
    SceneBuilder b;
    b.add(shape, size, translation({1, 2, 3}), b.add_diffuse({1, 1, 1}));
    const Probe probe(b);
    for (uint32_t i = 0; i < 20000; ++i) {
      const Vec3f inside = random_direction(i, 0) * 0.19f, eye = random_direction(i, 1) * 3.0f;
      RayHit hit;
      const Ray at = make_ray(Vec3f{1, 2, 3} + eye, inside - eye);
      EXPECT_TRUE(probe.tracer.trace(at, false, &hit));
      EXPECT_TRUE(probe.tracer.trace(at, true, &hit));
      const Vec3f aside = normalize(cross(eye, random_direction(i, 2))) * 0.75f;
      EXPECT_FALSE(probe.tracer.trace(make_ray(Vec3f{1, 2, 3} + eye, aside - eye), true, &hit));
      // From the inside there is always a way to the surface.
      EXPECT_TRUE(probe.tracer.trace(make_ray(Vec3f{1, 2, 3} + inside, eye), false, &hit));
    }
  }
}

TEST(Geometry, MeshesAreWatertight) {
  for (const bool on_body : {false, true}) {
    SceneBuilder b;
    const Affine3f pose = rigid(normalize(Vec3f{3, 1, 2}), 1.1f, {10, 20, 5});
    const int body = on_body ? b.add_body(pose) : 0;
    b.add(ShapeType::kMesh, {}, on_body ? Affine3f{} : pose, b.add_diffuse({1, 1, 1}), body,
          b.add_mesh(make_ball(16)));
    const Probe probe(b);
    const TriangleMesh ball = make_ball(16);
    for (uint32_t i = 0; i < 200000; ++i) {
      // Half of the rays aim exactly at vertices and edges, where cracks would be.
      Vec3f target = random_direction(i, 0);
      if (i % 2 == 0) {
        const size_t t = 3 * ((i / 2) % ball.triangle_count());
        const Vec3f a = ball.positions[ball.indices[t]], c = ball.positions[ball.indices[t + 1]];
        target = transform_vector(pose, lerp(a, c, static_cast<float>(i % 11) / 10.0f));
      }
      RayHit hit;
      ASSERT_TRUE(probe.tracer.trace(make_ray(pose.p, target), false, &hit));
      ASSERT_TRUE(probe.tracer.trace(make_ray(pose.p, target), true, &hit));
    }
  }
}

void expect_same_but_for_rounding(const Film& baked, const Film& moved) {
  int differing = 0;
  for (size_t i = 0; i < baked.depth.size(); ++i) {
    if (baked.part[i] != moved.part[i]) {
      ++differing;  // silhouettes: rounding may fall on either side
      continue;
    }
    if (baked.part[i] == 0) continue;
    EXPECT_NEAR(baked.depth[i], moved.depth[i], 2e-5 * baked.depth[i]);
    EXPECT_LT(length(baked.center_normal[i] - moved.center_normal[i]), 2e-2);
  }
  EXPECT_LE(differing, 3);
  const Mean a = picture_mean(baked), c = picture_mean(moved);
  EXPECT_NEAR(a.mean, c.mean, 4 * std::hypot(a.standard_error(), c.standard_error()));
}

TEST(Geometry, InstancesEqualBakedGeometry) {
  const auto build = [](bool on_body) {
    SceneBuilder b;
    const Affine3f pose = rigid(normalize(Vec3f{0, 1, 2}), 0.9f, {0.5f, -0.25f, 0.75f});
    const int body = on_body ? b.add_body(pose) : 0;
    const Affine3f X_BG = on_body ? Affine3f{} : pose;
    MaterialDescription m;
    m.roughness = 0.3f;
    const int material = b.add_material(m);
    b.add(ShapeType::kMesh, {}, X_BG, material, body, b.add_mesh(make_ball(20, 0.1f)));
    b.add(ShapeType::kBox, {0.2f, 0.3f, 0.4f}, X_BG * translation({1.2f, 0, 0}), material, body);
    b.add(ShapeType::kCapsule, {0.2f, 0.3f, 0}, X_BG * translation({-1.2f, 0, 0}), material, body);
    b.add(ShapeType::kPlane, {}, translation({0, 0, -1}), material);
    LightDescription light;
    light.intensity = {100, 100, 100};
    b.add_light(light, {2, -2, 4});
    return b;
  };
  const CameraView view = SceneBuilder::camera(look_at({3, -4, 2}, {0.5f, 0, 0.5f}), 64, 64, 40);
  RenderSettings settings;
  settings.spp = 64;
  settings.variance = true;
  const Film baked = build(false).render(view, settings),
             moved = build(true).render(view, settings);
  expect_same_but_for_rounding(baked, moved);
}

// Copies of one mesh that stand still: baked while they are few, instances when they are many.
TEST(Geometry, ManyCopiesOfAMeshEqualAsManyMeshes) {
  const auto build = [](bool shared) {
    SceneBuilder b;
    MaterialDescription m;
    m.roughness = 0.3f;
    const int material = b.add_material(m);
    const TriangleMesh ball = make_ball(60, 0.1f);
    EXPECT_GT(35 * ball.indices.size() / 3, 1u << 18) << "too few to be instances";
    int mesh = -1;
    for (int i = 0; i < 36; ++i) {
      if (mesh < 0 || !shared) mesh = b.add_mesh(ball);
      const float x = static_cast<float>(i % 6) * 2.2f, y = static_cast<float>(i / 6) * 2.2f;
      const Affine3f turn =
          rigid(normalize(Vec3f{0, 1, 2}), 0.3f * static_cast<float>(i), {x, y, 0});
      b.add(ShapeType::kMesh, {}, turn, material, 0, mesh);
    }
    b.add(ShapeType::kPlane, {}, translation({0, 0, -1}), material);
    LightDescription light;
    light.intensity = {400, 400, 400};
    b.add_light(light, {5, 3, 9});
    return b;
  };
  const CameraView view = SceneBuilder::camera(look_at({-3, -4, 6}, {5, 5, 0}), 64, 64, 60);
  RenderSettings settings;
  settings.spp = 16;
  settings.variance = true;
  expect_same_but_for_rounding(build(false).render(view, settings),
                               build(true).render(view, settings));
}

TEST(Geometry, PicturesAreTheSameWithAnyNumberOfThreads) {
  SceneBuilder b;
  MaterialDescription m;
  m.roughness = 0.3f;
  const int material = b.add_material(m);
  b.add(ShapeType::kPlane, {}, {}, material);
  b.add(ShapeType::kMesh, {}, translation({0, 0, 1}), material, b.add_body({}),
        b.add_mesh(make_ball(40, 0.1f)));
  LightDescription light;
  light.intensity = {100, 100, 100};
  light.radius = 0.2f;
  b.add_light(light, {2, -2, 4});
  const CameraView view = SceneBuilder::camera(look_at({3, -4, 2}, {0, 0, 0.5f}), 100, 70, 40);
  RenderSettings settings;
  settings.variance = true;
  std::vector<Film> films;
  for (const int threads : {1, 2, 4, 4}) {
    set_thread_count(threads);
    films.push_back(b.render(view, settings));
  }
  set_thread_count(0);
  for (const Film& film : films) {
    EXPECT_TRUE(film.radiance == films[0].radiance);
    EXPECT_TRUE(film.variance == films[0].variance);
    EXPECT_TRUE(film.normal == films[0].normal);
    EXPECT_TRUE(film.depth == films[0].depth);
    EXPECT_TRUE(film.part == films[0].part);
  }
  settings.seed = 2;
  EXPECT_FALSE(b.render(view, settings).radiance == films[0].radiance);
  settings.seed = 1;
  settings.frame = 1;
  EXPECT_FALSE(b.render(view, settings).radiance == films[0].radiance);
}

TEST(Geometry, SampleRangesMayBeAveraged) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LightDescription light;
  light.intensity = {100, 100, 100};
  light.radius = 0.8f;
  b.add_light(light, {0, 0, 1.5f});
  b.add(ShapeType::kBox, {0.3f, 0.3f, 0.02f}, translation({0, 0, 0.5f}), b.add_diffuse({1, 1, 1}));
  const CameraView view = SceneBuilder::camera(look_at({2, -2, 2}, {0, 0, 0}), 32, 32, 40);
  RenderSettings settings;
  settings.variance = true;
  settings.spp = 8;
  Mean halves;
  for (const int first : {0, 8}) {
    settings.first_sample = first;
    halves.add(picture_mean(b.render(view, settings)).mean);
  }
  settings.first_sample = 0;
  settings.spp = 256;
  const Mean reference = picture_mean(b.render(view, settings));
  EXPECT_NEAR(halves.mean, reference.mean, 0.02 * reference.mean);
  EXPECT_GT(halves.standard_error(), 0) << "the two ranges are the same samples";
}

TEST(Geometry, MotionBlurIsTheMeanOverTheShutter) {
  // A white emitter of 0.2 m crosses the view by 1 m while the shutter is open.
  SceneBuilder b;
  const int body = b.add_body(translation({-0.5f, 0, 0}));
  b.add(ShapeType::kBox, {0.1f, 0.5f, 0.5f}, {}, b.add_emitter({100, 100, 100}), body);
  PoseFrame close = b.frame;
  SceneBuilder::set_body(&close, body, translation({0.5f, 0, 0}));
  auto renderer = b.make();
  renderer->update(b.frame, close, b.frame);
  const CameraView view = SceneBuilder::camera(look_at({0, -20, 0}, {0, 0, 0}), 64, 16, 1.0);
  RenderSettings settings;
  settings.spp = 512;
  settings.variance = true;
  Film film;
  renderer->render(view, settings, &film);
  // 64 x 16 px at fovy 1 degree: the view is 1.4 m wide. Total light = length / width of view,
  // times the height's share; in the middle the emitter is there 20 % of the time.
  const size_t middle = 8 * 64 + 32;
  EXPECT_NEAR(film.radiance[middle].x, 100 * 0.2, 4 * std::sqrt(film.variance[middle].x) + 0.3);
  EXPECT_EQ(film.part[8 * 64 + 64 * (0.7 - 0.5) / 1.4], 1u) << "exact channels are of shutter open";
}

TEST(Geometry, MotionVectorsMatchProjectedPoints) {
  SceneBuilder b;
  const int body = b.add_body(translation({0.2f, 0, 0.5f}));
  const int material = b.add_diffuse({0.5f, 0.5f, 0.5f});
  b.add(ShapeType::kSphere, {0.5f, 0, 0}, {}, material, body);
  b.add(ShapeType::kPlane, {}, {}, material);
  PoseFrame previous = b.frame;
  SceneBuilder::set_body(&previous, body, rigid({0, 0, 1}, 0.3f, {0, 0.1f, 0.45f}));
  auto renderer = b.make();
  renderer->update(b.frame, b.frame, previous);
  CameraView view = SceneBuilder::camera(look_at({0, -4, 1.5f}, {0, 0, 0.4f}), 64, 64, 40);
  view.X_WC_previous = look_at({0.1f, -4.1f, 1.5f}, {0, 0, 0.4f});
  RenderSettings settings;
  settings.spp = 1;
  Film film;
  renderer->render(view, settings, &film);
  const auto project_to = [&](const Affine3f& X_WC, Vec3f p) {
    const Vec3f c = transform_point(inverse(X_WC), p);
    return Vec2f{static_cast<float>(view.intrinsics.cx - view.intrinsics.fx * c.x / c.z),
                 static_cast<float>(view.intrinsics.cy + view.intrinsics.fy * c.y / c.z)};
  };
  int on_sphere = 0, on_plane = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const size_t i = static_cast<size_t>(y) * 64 + x;
      if (film.part[i] == 0) continue;
      const Affine3f& C = view.X_WC_open;
      const float cx = static_cast<float>((x + 0.5 - 32) / view.intrinsics.fx),
                  cy = static_cast<float>((32 - y - 0.5) / view.intrinsics.fy);
      const Vec3f p = C.p + (C.x * cx + C.y * cy - C.z) * film.depth[i];
      Vec3f before = p;
      if (film.part[i] == 1) {
        const Vec3f p_B = p - Vec3f{0.2f, 0, 0.5f};
        before = transform_point(rigid({0, 0, 1}, 0.3f, {0, 0.1f, 0.45f}), p_B);
        ++on_sphere;
      } else {
        ++on_plane;
      }
      const Vec2f expected = Vec2f{x + 0.5f, y + 0.5f} - project_to(view.X_WC_previous, before);
      EXPECT_NEAR(film.motion[i].x, expected.x, 5e-3);
      EXPECT_NEAR(film.motion[i].y, expected.y, 5e-3);
    }
  }
  EXPECT_GT(on_sphere, 100);
  EXPECT_GT(on_plane, 100);
}

TEST(Geometry, DeformablesFollowTheirVertices) {
  SceneBuilder b;
  DeformableDescription cloth;
  cloth.rest = make_ball(8);
  b.description.deformables.push_back(cloth);
  b.add(ShapeType::kDeformable, {}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}), 0, 0);
  b.description.instances[0].is_static = false;
  const auto place = [&](PoseFrame* frame, float x, float scale) {
    frame->vertices.clear();
    for (const Vec3f& p : cloth.rest.positions) {
      for (const float v : {p.x * scale + x, p.y * scale, p.z * scale})
        frame->vertices.push_back(v);
    }
  };
  place(&b.frame, 0, 1);
  auto renderer = b.make();
  const CameraView view = SceneBuilder::camera(look_at({2, -8, 0}, {2, 0, 0}), 33, 33, 30);
  RenderSettings settings;
  settings.spp = 16;
  Film film;
  const size_t middle = 16 * 33 + 16;
  renderer->render(view, settings, &film);
  EXPECT_EQ(film.part[middle], 0u);
  PoseFrame moved = b.frame;
  place(&moved, 2, 1.5f);
  renderer->update(moved, moved, b.frame);
  renderer->render(view, settings, &film);
  EXPECT_EQ(film.part[middle], 1u);
  EXPECT_NEAR(film.depth[middle], 6.5, 0.03);
  EXPECT_NEAR(film.motion[middle].x, 2 * view.intrinsics.fx / 6.5, 1.5);
  renderer->update(b.frame, moved, b.frame);  // blurred
  renderer->render(view, settings, &film);
  EXPECT_EQ(film.part[middle], 0u) << "exact channels are of shutter open";
  place(&moved, 0, 1);
  renderer->update(moved, moved, moved);  // and back to one key
  renderer->render(view, settings, &film);
  EXPECT_EQ(film.part[middle], 0u);
}

TEST(Geometry, OrthographicCamera) {
  SceneBuilder b;
  b.add(ShapeType::kSphere, {0.5f, 0, 0}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  CameraView view = SceneBuilder::camera(look_at({0, -10, 0}, {0, 0, 0}), 40, 40);
  view.intrinsics.orthographic = true;
  view.intrinsics.fx = view.intrinsics.fy = 20;  // 2 m wide
  RenderSettings settings;
  settings.spp = 1;
  const Film film = b.render(view, settings);
  int hits = 0;
  for (const uint32_t part : film.part) hits += part != 0 ? 1 : 0;
  EXPECT_NEAR(hits, M_PI * 100, 12);
  EXPECT_NEAR(film.depth[20 * 40 + 20], 9.5, 2e-3);
}

TEST(Geometry, TinyAndDegenerateTrianglesLeaveNoTraceInThePicture) {
  SceneBuilder b;
  MaterialDescription m;
  m.roughness = 0.3f;
  const int material = b.add_material(m);
  TriangleMesh mesh = make_ball(12);
  for (Vec3f& p : mesh.positions) p = p * 1e-9f;  // its normals underflow when squared
  mesh.positions.insert(
      mesh.positions.end(),
      {{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}, {-1, -1, 0.2f}, {1, -1, 0.2f}, {0, 1, 0.2f}});
  mesh.normals.resize(mesh.positions.size(), Vec3f{0, 0, 0});  // and some normals are missing
  const auto n = static_cast<uint32_t>(mesh.positions.size()) - 6;
  mesh.indices.insert(mesh.indices.end(), {n, n + 1, n + 2, n, n, n, n + 3, n + 4, n + 5});
  mesh.uvs.clear();
  b.add(ShapeType::kMesh, {}, {}, material, 0, b.add_mesh(mesh));
  LightDescription light;
  light.intensity = {10, 10, 10};
  light.radius = 0.1f;
  b.add_light(light, {0.5f, -0.5f, 2});
  b.description.sky.ambient = {1, 1, 1};
  RenderSettings settings;
  settings.spp = 16;
  const Film near =
      b.render(SceneBuilder::camera(look_at({0, -2e-9f, 3e-9f}, {}), 16, 16), settings);
  const Film far = b.render(SceneBuilder::camera(look_at({0, -1, 3}, {}), 16, 16), settings);
  for (const Film* film : {&near, &far}) {
    for (const Vec3f& c : film->radiance) {
      EXPECT_TRUE(std::isfinite(c.x) && c.x >= 0);
    }
    for (const Vec3f& c : film->center_normal) EXPECT_TRUE(std::isfinite(c.x));
  }
  EXPECT_EQ(far.part[8 * 16 + 8], 1u);
}

TEST(Geometry, BrokenDescriptionsAreRefusedWithTheirCause) {
  const auto refusal = [](const std::function<void(SceneBuilder*)>& spoil) {
    SceneBuilder b;
    b.add(ShapeType::kBox, {1, 1, 1}, {}, b.add_diffuse({1, 1, 1}));
    b.add_mesh(make_ball(4));
    spoil(&b);
    auto renderer = make_cpu_renderer(b.description);
    return renderer.ok() ? std::string() : renderer.error().message;
  };
  EXPECT_EQ(refusal([](SceneBuilder*) {}), "");
  EXPECT_NE(
      refusal([](SceneBuilder* b) { b->description.instances[0].material = 7; }).find("material 7"),
      std::string::npos);
  EXPECT_NE(
      refusal([](SceneBuilder* b) { b->add(ShapeType::kMesh, {}, {}, 0, 0, 3); }).find("mesh 3"),
      std::string::npos);
  EXPECT_NE(refusal([](SceneBuilder* b) { b->description.instances[0].size.y = 0; }).find("size"),
            std::string::npos);
  EXPECT_NE(
      refusal([](SceneBuilder* b) { b->description.meshes[0].indices[4] = 999; }).find("vertex"),
      std::string::npos);
  EXPECT_NE(refusal([](SceneBuilder* b) {
              b->description.meshes[0].positions[0].x = NAN;
            }).find("finite"),
            std::string::npos);
  EXPECT_NE(refusal([](SceneBuilder* b) {
              b->description.meshes[0].uvs[0].x = INFINITY;
            }).find("texture coordinate"),
            std::string::npos);
  EXPECT_NE(refusal([](SceneBuilder* b) { b->description.sky.texture = 2; }).find("sky"),
            std::string::npos);
  EXPECT_NE(refusal([](SceneBuilder* b) {
              b->add_texture({4, 4, 3, ColorSpace::kSrgb, {1, 2, 3}});
            }).find("texels"),
            std::string::npos);
}

}  // namespace
}  // namespace gloam
