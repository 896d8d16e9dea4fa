// Lamps that flicker while the shutter is open: every row sees them in its own time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/test/scene_builder.h"

namespace gloam {
namespace {

constexpr int kSide = 64;           // [px]
constexpr double kWindow = 0.04;    // between the keys [s]
constexpr double kReadout = 0.025;  // from the first row to the end [s]

/// Straight down at 10 px per metre; `place` moves a key to its share 0 … 1 of the window.
template <class Place>
Film film_of(const SceneBuilder& b, double exposure, double readout, RenderSettings settings,
             const Place& place) {
  std::vector<PoseFrame> keys(3, b.frame);
  for (int k = 0; k < 3; ++k) {
    keys[static_cast<size_t>(k)].time = 1 + 0.5 * k * kWindow;
    place(&keys[static_cast<size_t>(k)], 0.5f * static_cast<float>(k));
  }
  const PoseFrame* const frames[] = {&keys[0], &keys[1], &keys[2]};
  const auto renderer = b.make();
  renderer->update(frames, keys[0]);
  CameraView view =
      SceneBuilder::camera({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 10}}, kSide, kSide);
  view.intrinsics.orthographic = true;
  view.intrinsics.fx = view.intrinsics.fy = 10;
  view.shutter = {.open = 0,
                  .length = static_cast<float>(exposure / kWindow),
                  .row = static_cast<float>(readout / kWindow / kSide)};
  Film film;
  renderer->render(view, settings, &film);
  return film;
}
/// Means of the rows' red light.
std::vector<double> rows_of(const SceneBuilder& b, double exposure, double readout,
                            const RenderSettings& settings) {
  const Film film = film_of(b, exposure, readout, settings, [](PoseFrame*, float) {});
  std::vector<double> rows(kSide, 0);
  for (size_t i = 0; i < film.radiance.size(); ++i)
    rows[i / kSide] += static_cast<double>(film.radiance[i].x) / kSide;
  return rows;
}

/// A panel that fills the picture and gives off 100 cd/m² by its schedule.
SceneBuilder panel(const LightSchedule& schedule) {
  SceneBuilder b;
  const int lamp = b.add_emitter({100, 100, 100});
  b.description.materials.back().schedule = 0;
  b.description.schedules.push_back(schedule);
  b.add(ShapeType::kBox, {5, 5, 0.1f}, {}, lamp);
  return b;
}

/// Mean of 1 - depth cos(4 pi f t) from t = a to b.
double ripple(double depth, double f, double a, double b) {
  const double w = 4 * M_PI * f;
  return 1 - depth * (std::sin(w * b) - std::sin(w * a)) / (w * (b - a));
}

// Bands as far apart as the lamp's period over the rows' delay: 10 ms of 25 ms are 25.6 rows.
TEST(Flicker, ARollingShutterShowsBandsOfTheMainsRipple) {
  const SceneBuilder b = panel({{MainsRipple{50, 0.6}}});
  const double exposure = 0.002;
  const auto rows = rows_of(b, exposure, kReadout, settings_of(64, 1));
  for (int y = 0; y < kSide; ++y) {
    const double open = 1 + kReadout * y / kSide;
    EXPECT_NEAR(rows[static_cast<size_t>(y)], 100 * ripple(0.6, 50, open, open + exposure), 1)
        << "row " << y;
  }
  EXPECT_GT(*std::max_element(rows.begin(), rows.end()), 150) << "this test is about bands";
}

TEST(Flicker, AnExposureOfWholePeriodsAveragesThemAway) {
  const SceneBuilder b = panel({{MainsRipple{50, 0.6}}});
  for (const double row : rows_of(b, 0.01, kReadout, settings_of(64, 1)))
    EXPECT_NEAR(row, 100, 1.5);
}

// On for a quarter of 8 ms: edges, and light from a lamp that rays cannot hit.
TEST(Flicker, LampsLightEachRowForItsShareOfTheirOnTime) {
  SceneBuilder b;
  b.add(ShapeType::kBox, {5, 5, 0.1f}, translation({0, 0, -0.1f}),
        b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LightDescription sun;
  sun.type = PunctualLightType::kDirectional;
  sun.intensity = {100 * kPi, 100 * kPi, 100 * kPi};
  sun.schedule = 0;
  b.add_light(sun, {0, 0, 5});
  b.description.schedules.push_back({{OnOff{0.008, 0.25, 0}}});
  const double exposure = 0.003;
  for (const RenderTier tier : {RenderTier::kPath, RenderTier::kDirect}) {
    RenderSettings settings = settings_of(64, 2);
    settings.tier = tier;
    const auto rows = rows_of(b, exposure, kReadout, settings);
    for (int y = 0; y < kSide; ++y) {
      const double open = kReadout * y / kSide;  // 1 s is 125 periods
      double on = 0;
      for (int k = 0; k < 5; ++k)
        on +=
            std::max(0.0, std::min(open + exposure, 0.008 * k + 0.002) - std::max(open, 0.008 * k));
      EXPECT_NEAR(rows[static_cast<size_t>(y)], 50 * on / exposure, 1.5)
          << "row " << y << ", tier " << static_cast<int>(tier);
    }
  }
}

// A lamp of 1 m passes at 100 m/s and is on for the first 8 of 40 ms: it is seen where it was then.
TEST(Flicker, WhatMovesUnderAStrobeIsSeenWhereItWasLit) {
  SceneBuilder b;
  b.add_body({});
  const int lamp = b.add_emitter({100, 100, 100});
  b.description.materials.back().schedule = 0;
  b.description.schedules.push_back({{OnOff{0.08, 0.1, 0.5}}});  // 1 s is 12.5 periods
  b.add(ShapeType::kBox, {0.5f, 5, 0.1f}, {}, lamp, 1);
  const Film film = film_of(b, kWindow, 0, settings_of(256, 1), [](PoseFrame* frame, float s) {
    SceneBuilder::set_body(frame, 1, translation({-2 + 4 * s, 0, 0}));
  });
  double light = 0;
  for (int x = 0; x < kSide; ++x) {
    const double here = film.radiance[static_cast<size_t>(32 * kSide + x)].x;
    light += here;
    // It goes from -2.5 … -1.5 m to -1.7 … -0.7 m meanwhile.
    if (x < 6 || x > 26) {
      EXPECT_EQ(here, 0) << x;
    }
  }
  EXPECT_NEAR(light, 100 * 10 * 0.2, 10) << "the light of 1 m for a fifth of the time";
}

// A still scene under a shutter of all the window has the exact mean, without noise.
TEST(Flicker, WithoutMotionOneShutterForAllRowsSeesTheMean) {
  const auto rows = rows_of(panel({{OnOff{0.04, 0.25, 0}}}), kWindow, 0, settings_of(1, 1));
  for (const double row : rows) EXPECT_NEAR(row, 25, 1e-3);
}

}  // namespace
}  // namespace gloam
