// Exposures over several motion keys: blur, rolling shutters, moving cameras, against closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

constexpr float kTurn = 2 * kPi;

/// Keys of a scene, evenly in time; `place` moves the frame to the share 0 … 1 of the exposure.
template <class Place>
std::vector<PoseFrame> make_keys(const PoseFrame& start, int count, const Place& place) {
  std::vector<PoseFrame> keys(static_cast<size_t>(count), start);
  for (int k = 0; k < count; ++k) {
    keys[static_cast<size_t>(k)].time = 0.1 * k;
    place(&keys[static_cast<size_t>(k)], static_cast<float>(k) / static_cast<float>(count - 1));
  }
  return keys;
}
std::vector<const PoseFrame*> pointers(const std::vector<PoseFrame>& keys) {
  std::vector<const PoseFrame*> out;
  for (const PoseFrame& key : keys) out.push_back(&key);
  return out;
}

/// Orthographic, straight down, 10 px per metre: p = (x, y) appears at (10 x + 32, 32 - 10 y).
CameraView from_above() {
  CameraView view = SceneBuilder::camera({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 10}}, 64, 64);
  view.intrinsics.orthographic = true;
  view.intrinsics.fx = view.intrinsics.fy = 10;
  return view;
}

RenderSettings light_only(int spp) {
  RenderSettings settings;
  settings.spp = spp;
  settings.max_depth = 1;
  return settings;
}

float at(const Film& film, int x, int y) {
  return film.radiance[static_cast<size_t>(y * film.width + x)].x;
}

/// A lamp on body 1.
SceneBuilder moving_lamp(Vec3f half_size) {
  SceneBuilder b;
  b.add_body({});
  b.add(ShapeType::kBox, half_size, {}, b.add_emitter({1, 1, 1}), 1);
  return b;
}

// A bar 1 m wide goes 2 m to the right: light at x is the share of the time that the bar is there,
// a trapezoid that rises over 1 m and lasts 3 m in all.
TEST(Motion, BlurIsAsLongAsTheWay) {
  SceneBuilder b = moving_lamp({0.5f, 3, 0.1f});
  for (const int count : {2, 5, 17}) {
    const auto keys = make_keys(b.frame, count, [](PoseFrame* frame, float s) {
      SceneBuilder::set_body(frame, 1, translation({-1 + 2 * s, 0, 0}));
    });
    auto renderer = b.make();
    renderer->update(pointers(keys), keys[0]);
    Film film;
    renderer->render(from_above(), light_only(1024), &film);
    double total = 0;
    for (int x = 0; x < 64; ++x) {
      const double p = (x + 0.5 - 32) / 10;
      const double share = std::clamp(0.5 * std::min({1.5 - std::abs(p), 1.0, 2.0}), 0.0, 0.5);
      EXPECT_NEAR(at(film, x, 32), share, 0.03) << x;
      total += at(film, x, 32);
    }
    EXPECT_NEAR(total, 10, 0.05) << "the light of 1 m";
  }
}

// Half the exposure is half the way.
TEST(Motion, TheShutterOpensForAPartOfTheKeys) {
  SceneBuilder b = moving_lamp({0.5f, 3, 0.1f});
  const auto keys = make_keys(b.frame, 5, [](PoseFrame* frame, float s) {
    SceneBuilder::set_body(frame, 1, translation({-1 + 2 * s, 0, 0}));
  });
  auto renderer = b.make();
  renderer->update(pointers(keys), keys[0]);
  CameraView view = from_above();
  view.shutter = {.open = 0.25f, .length = 0.5f, .row = 0};
  Film film;
  renderer->render(view, light_only(1024), &film);
  // From x = -0.5 to 0.5: light at all from -1 to 1.
  EXPECT_EQ(at(film, 18, 32), 0);
  EXPECT_NEAR(at(film, 32, 32), 1, 0.06);
  EXPECT_NEAR(at(film, 26, 32), 0.45, 0.04);
  EXPECT_EQ(at(film, 45, 32), 0);
  EXPECT_EQ(film.part[32 * 64 + 23], 1u) << "exact channels: at -0.5 m when the shutter opens";
  EXPECT_EQ(film.part[32 * 64 + 37], 0u);
}

// Keys on a quarter circle: the lamp is seen on the polygon through the keys, and nowhere near the
// chord that two keys would make.
TEST(Motion, ManyKeysFollowACurve) {
  SceneBuilder b = moving_lamp({0.1f, 0.1f, 0.1f});
  const auto on_circle = [](PoseFrame* frame, float s) {
    const float a = 0.25f * kTurn * s;
    SceneBuilder::set_body(frame, 1, rigid({0, 0, 1}, a, {2 * std::cos(a), 2 * std::sin(a), 0}));
  };
  const auto keys = make_keys(b.frame, 17, on_circle);
  auto renderer = b.make();
  renderer->update(pointers(keys), keys[0]);
  Film film;
  renderer->render(from_above(), light_only(256), &film);
  const float c = 2 * std::cos(kTurn / 8);
  EXPECT_GT(at(film, static_cast<int>(32 + 10 * c), static_cast<int>(32 - 10 * c)), 0.03);
  EXPECT_EQ(at(film, 42, 22), 0) << "the chord's middle";
}

// An edge that moves by 2 m while 64 rows are read stands 20 px further in the last row than in the
// first, on one line.
TEST(Motion, RollingShuttersSlantEdges) {
  SceneBuilder b = moving_lamp({2, 4, 0.1f});
  const auto keys = make_keys(b.frame, 9, [](PoseFrame* frame, float s) {
    SceneBuilder::set_body(frame, 1, translation({-3 + 2 * s, 0, 0}));  // right edge: -1 … 1
  });
  auto renderer = b.make();
  renderer->update(pointers(keys), keys[0]);
  CameraView view = from_above();
  view.shutter = {.open = 0, .length = 0, .row = 1.0f / 64};
  Film film;
  renderer->render(view, light_only(256), &film);
  double worst = 0;
  for (int y = 0; y < 64; ++y) {
    double edge = 0;  // light from the lamp's left end to its right edge, from pixel 22 - 10 on
    for (int x = 12; x < 64; ++x) edge += at(film, x, y);
    worst = std::max(worst, std::abs(12 + edge - (22 + 20.0 * y / 64)));
    const int exact = static_cast<int>(std::floor(22 + 20.0 * y / 64 - 0.5));
    EXPECT_EQ(film.part[static_cast<size_t>(64 * y + exact - 1)], 1u);
    EXPECT_EQ(film.part[static_cast<size_t>(64 * y + exact + 2)], 0u);
  }
  EXPECT_LT(worst, 0.05) << "px";
}

// A camera that turns by 0.12 rad: a far lamp is drawn out evenly in angle, and a rolling shutter
// shifts it row by row.
TEST(Motion, CamerasTurnEvenly) {
  SceneBuilder b;
  b.add(ShapeType::kBox, {0.02f, 0.02f, 30}, translation({0, 100, 0}), b.add_emitter({1, 1, 1}));
  PoseFrame second = b.frame;
  second.time = 1;
  auto renderer = b.make();
  renderer->update(b.frame, second, b.frame);
  // Looks along +Y and turns about Z.
  const auto turned = [](float a) {
    return rigid({0, 0, 1}, a, {}) * Affine3f{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}};
  };
  CameraView view = SceneBuilder::camera(turned(0), 64, 64, 20);
  view.X_WC_keys = {turned(0), turned(0.12f)};
  view.shutter = {.open = 0, .length = 0, .row = 1.0f / 64};
  Film film;
  renderer->render(view, light_only(1024), &film);
  for (const int y : {4, 20, 33, 50, 60}) {
    double sum = 0, x_sum = 0;
    for (int x = 0; x < 64; ++x) {
      sum += at(film, x, y);
      x_sum += at(film, x, y) * (x + 0.5);
    }
    const double angle = 0.12 * y / 64;
    ASSERT_GT(sum, 0) << y;
    EXPECT_NEAR(x_sum / sum, 32 + view.intrinsics.fx * std::tan(angle), 0.1) << y;
  }
  // Poses between keys are rigid.
  CameraPose pose;
  CameraKey keys[2] = {{{0, 0, 0}, {1, 0, 0, 0}},
                       {{2, 0, 0}, {std::cos(0.6f), 0, std::sin(0.6f), 0}}};
  pose.keys = {keys, 2};
  const Affine3f half = camera_pose_at(pose, 0.5f);
  EXPECT_NEAR(length(half.x), 1, 1e-6);
  EXPECT_NEAR(dot(half.x, half.z), 0, 1e-6);
  EXPECT_NEAR(std::atan2(-half.x.z, half.x.x), 0.6, 1e-6);
  EXPECT_NEAR(half.p.x, 1, 1e-6);
}

// Optical flow and scene flow of a body that turns and moves: the way between the previous frame
// and the instant of the pixel's row.
TEST(Motion, FlowIsThatOfThePointThatIsSeen) {
  SceneBuilder b;
  b.add_body({});
  b.add(ShapeType::kBox, {1.5f, 1.5f, 0.2f}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}), 1);
  const auto place = [](PoseFrame* frame, float s) {
    SceneBuilder::set_body(frame, 1, translation({0.5f * s, 0.2f * s, 0}));
  };
  const auto keys = make_keys(b.frame, 3, place);
  PoseFrame previous = b.frame;
  SceneBuilder::set_body(&previous, 1, rigid({0, 0, 1}, -0.1f, {-0.4f, 0, 0.05f}));
  auto renderer = b.make();
  renderer->update(pointers(keys), previous);
  CameraView view = from_above();
  view.shutter = {.open = 0, .length = 0, .row = 1.0f / 64};
  Film film;
  renderer->render(view, light_only(1), &film);
  int seen = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const size_t i = static_cast<size_t>(64 * y + x);
      if (film.part[i] != 1) continue;
      ++seen;
      const float s = static_cast<float>(y) / 64;
      const Vec3f p{(x + 0.5f - 32) / 10, (32 - y - 0.5f) / 10, 0.2f};
      const Vec3f p_B = p - Vec3f{0.5f * s, 0.2f * s, 0};
      const Vec3f way = p - transform_point(rigid({0, 0, 1}, -0.1f, {-0.4f, 0, 0.05f}), p_B);
      EXPECT_NEAR(film.scene_flow[i].x, way.x, 1e-5);
      EXPECT_NEAR(film.scene_flow[i].y, way.y, 1e-5);
      EXPECT_NEAR(film.scene_flow[i].z, way.z, 1e-5);
      EXPECT_NEAR(film.motion[i].x, 10 * way.x, 1e-3);
      EXPECT_NEAR(film.motion[i].y, -10 * way.y, 1e-3);
    }
  }
  EXPECT_GT(seen, 600);
}

// A cloth whose vertices move through three keys: right, then back.
TEST(Motion, DeformablesMoveThroughTheirKeys) {
  SceneBuilder b;
  DeformableDescription cloth;
  cloth.rest = make_box({0.5f, 3, 0.1f});
  b.description.deformables.push_back(cloth);
  b.add(ShapeType::kDeformable, {}, {}, b.add_emitter({1, 1, 1}), 0, 0);
  b.description.instances[0].is_static = false;
  const auto place = [&](PoseFrame* frame, float s) {
    frame->vertices.clear();
    const float shift = 2 * std::min(s, 1 - s);  // 0, 1, 0
    for (const Vec3f& p : cloth.rest.positions)
      for (const float v : {p.x + shift, p.y, p.z}) frame->vertices.push_back(v);
  };
  const auto keys = make_keys(b.frame, 3, place);
  b.frame = keys[0];
  auto renderer = b.make();
  renderer->update(pointers(keys), keys[0]);
  Film film;
  renderer->render(from_above(), light_only(1024), &film);
  EXPECT_NEAR(at(film, 24, 32), 0, 0.02);
  EXPECT_NEAR(at(film, 29, 32), 0.25, 0.05);
  EXPECT_NEAR(at(film, 36, 32), 0.95, 0.05);
  EXPECT_NEAR(at(film, 39, 32), 0.75, 0.05);
  EXPECT_NEAR(at(film, 44, 32), 0.25, 0.05);
}

// A lamp that moves while the shutter is open lights as the mean over its places does; also one of
// so many that a tree picks them, and a spot whose light never meets all of the floor.
TEST(Motion, LampsMoveThroughTheirKeys) {
  for (const bool spot : {false, true}) {
    for (const int others : {0, 20}) {
      SceneBuilder b;
      b.add(ShapeType::kPlane, {}, {}, b.add_diffuse({0.8f, 0.8f, 0.8f}));
      LightDescription lamp;
      lamp.intensity = {10, 10, 10};
      lamp.radius = 0.1f;
      if (spot) {
        lamp.type = PunctualLightType::kSpot;
        lamp.cos_cutoff = std::cos(0.6f);
      }
      b.add_light(lamp, {-1, 0, 1});
      lamp.intensity = {0.1f, 0.1f, 0.1f};
      for (int i = 0; i < others; ++i) b.add_light(lamp, {0.3f * static_cast<float>(i) - 3, 2, 1});
      const auto place = [](PoseFrame* frame, float s) { frame->light_p[0] = -1 + 2 * s; };
      const auto keys = make_keys(b.frame, 5, place);
      RenderSettings settings;
      settings.spp = 1024;
      settings.max_depth = 2;
      const CameraView view = SceneBuilder::camera(look_at({0, -4, 4}, {}), 12, 12, 50);
      auto renderer = b.make();
      renderer->update(pointers(keys), keys[0]);
      Film moving, still;
      renderer->render(view, settings, &moving);
      constexpr int kPlaces = 16;
      std::vector<double> mean(144);
      settings.spp = 128;
      for (int k = 0; k < kPlaces; ++k) {
        PoseFrame frame = b.frame;
        place(&frame, (static_cast<float>(k) + 0.5f) / kPlaces);
        renderer->update(frame, frame, frame);
        renderer->render(view, settings, &still);
        for (size_t i = 0; i < mean.size(); ++i) mean[i] += still.radiance[i].x / kPlaces;
      }
      double all = 0, all_moving = 0;
      for (size_t i = 0; i < mean.size(); ++i) {
        EXPECT_NEAR(moving.radiance[i].x, mean[i], 0.12 * mean[i] + 0.01) << spot << others << i;
        all += mean[i];
        all_moving += moving.radiance[i].x;
      }
      EXPECT_NEAR(all_moving, all, 0.01 * all);
    }
  }
}

// A defocused point is a disk of the diameter 2 R f |1 / focus - 1 / z| px (thin lens), evenly lit.
TEST(Motion, CirclesOfConfusionHaveTheThinLensesSize) {
  SceneBuilder b;
  const float z = 4, focus = 1.5f, radius = 0.05f, size = 0.004f;
  b.add(ShapeType::kSphere, {size, 0, 0}, translation({0, 0, -z}),
        b.add_emitter({1000, 1000, 1000}));
  CameraView view = SceneBuilder::camera({}, 64, 64, 20);
  view.aperture = {radius, focus};
  const RenderSettings settings = light_only(4096);
  const Film film = b.render(view, settings);
  const double f = view.intrinsics.fx;
  const double disk = radius * f * std::abs(1 / focus - 1 / z);  // its radius [px]
  double sum = 0, squares = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double r2 = std::pow(x + 0.5 - 32, 2) + std::pow(y + 0.5 - 32, 2);
      sum += at(film, x, y);
      squares += at(film, x, y) * r2;
    }
  }
  // The mean square radius of an even disk is half of its radius squared; that of the pixel and its
  // filter, and of the sphere itself, adds to it.
  const double filter = 2 * 0.42 * 0.42 * 0.97;
  EXPECT_NEAR(std::sqrt(2 * (squares / sum - filter)), disk, 0.02 * disk);
  // All of the light arrives: what a sharp sphere would bring.
  const double sharp = 1000 * kPi * std::pow(size / z * f, 2);
  EXPECT_NEAR(sum, sharp, 0.03 * sharp);
  EXPECT_EQ(film.part[32 * 64 + 40], 0u) << "exact channels are sharp";
}

TEST(Motion, WhatIsInFocusIsSharp) {
  SceneBuilder b;
  b.add(ShapeType::kBox, {1, 1, 0.001f}, translation({-1, 0, -2}), b.add_emitter({1, 1, 1}));
  CameraView view = SceneBuilder::camera({}, 64, 64, 20);
  const Film sharp = b.render(view, light_only(64));
  view.aperture = {0.05f, 2};
  const Film film = b.render(view, light_only(64));
  for (int x = 0; x < 64; ++x) EXPECT_NEAR(at(film, x, 32), at(sharp, x, 32), 0.08) << x;
}

TEST(Motion, PicturesDoNotDependOnTheNumberOfThreads) {
  SceneBuilder b = moving_lamp({0.5f, 3, 0.1f});
  b.add(ShapeType::kPlane, {}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  const auto keys = make_keys(b.frame, 7, [](PoseFrame* frame, float s) {
    SceneBuilder::set_body(frame, 1, rigid({0, 0, 1}, s, {s, 0, 1}));
  });
  CameraView view = SceneBuilder::camera(look_at({0, -5, 4}, {}), 48, 48);
  view.X_WC_keys = std::vector<Affine3f>(7, view.X_WC_open);
  view.X_WC_keys[3].p.z += 0.1f;
  view.intrinsics.lens = LensModel::kEquidistant;
  view.intrinsics.fx = view.intrinsics.fy = 25;
  view.shutter = {.open = 0, .length = 0.3f, .row = 0.7f / 48};
  view.aperture = {0.02f, 4};
  RenderSettings settings;
  settings.spp = 8;
  Film films[2];
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    auto renderer = b.make();
    renderer->update(pointers(keys), keys[0]);
    renderer->render(view, settings, &films[threads / 3]);
  }
  set_thread_count(0);
  EXPECT_EQ(films[0].radiance, films[1].radiance);
  EXPECT_EQ(films[0].depth, films[1].depth);
}

}  // namespace
}  // namespace gloam
