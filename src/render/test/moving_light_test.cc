// Lamps that turn and skies that go on: pictures are functions of the instant, not of what was
// drawn before it.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/angle.h"
#include "base/parallel.h"
#include "render/test/probe.h"
#include "render/test/room_with_window.h"

namespace gloam {
namespace {

Film film_at(Renderer* renderer, PoseFrame frame, double time, const CameraView& view,
             const RenderSettings& settings) {
  frame.time = time;
  renderer->update(frame, frame, frame);
  Film film;
  renderer->render(view, settings, &film);
  return film;
}

double sum_of(const Film& film) {
  return std::accumulate(film.radiance.begin(), film.radiance.end(), 0.0,
                         [](double sum, Vec3f c) { return sum + luminance(c); });
}

LightDescription beam() {
  LightDescription spot;
  spot.type = PunctualLightType::kSpot;
  spot.intensity = {500, 500, 500};
  spot.cos_cutoff = std::cos(0.3f);
  spot.softness = 0.5f;
  spot.body = 0;
  // 1 m above the floor, along +X and down to it.
  spot.X_BL = rigid({0, 1, 0}, -kPi / 3, {0, 0, 1});
  return spot;
}

/// A floor with posts around a beacon of one turn per second.
SceneBuilder beacon() {
  SceneBuilder b;
  const int grey = b.add_diffuse({0.6f, 0.6f, 0.6f});
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, grey);
  for (int k = 0; k < 8; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k) / 8;
    const Vec3f p{2 * std::cos(angle), 2 * std::sin(angle), 1};
    b.add(ShapeType::kBox, {0.3f, 0.3f, 1}, translation(p), grey);
  }
  LightDescription light = beam();
  light.motion = 0;
  b.description.motions = {{.turns = 1}};
  b.description.lights = {light};
  return b;
}
CameraView over_beacon() {
  return SceneBuilder::camera(look_at({0, 0, 12}, {0, 0, 0}), 40, 40, 40);
}

/// The azimuth [rad] of the light's centre in a picture from above, whose +X is right, +Y up.
double azimuth_of(const Film& film) {
  double x = 0, y = 0;
  for (int i = 0; i < 1600; ++i) {
    const double light = luminance(film.radiance[static_cast<size_t>(i)]);
    x += light * (i % 40 - 19.5);
    y += light * (19.5 - i / 40);
  }
  return std::atan2(y, x);
}

TEST(MovingLight, ABeaconLightsWhereItPointsInEveryTier) {
  const SceneBuilder b = beacon();
  const auto renderer = b.make();
  for (const RenderTier tier : {RenderTier::kPath, RenderTier::kDirect, RenderTier::kInteractive}) {
    RenderSettings settings = settings_of(16, 2);
    settings.tier = tier;
    settings.variance = false;
    for (const double time : {0.0, 0.125, 0.5, 1000.75}) {
      const Film film = film_at(renderer.get(), b.frame, time, over_beacon(), settings);
      const double off = std::remainder(azimuth_of(film) - 2 * M_PI * time, 2 * M_PI);
      EXPECT_NEAR(off, 0, tier == RenderTier::kInteractive ? 0.2 : 0.06)
          << "tier " << static_cast<int>(tier) << " at " << time;
    }
  }
}

TEST(MovingLight, ATurnedLampIsALampThatWasPutSo) {
  const SceneBuilder b = beacon();
  SceneBuilder still = b;
  LightDescription& light = still.description.lights[0];
  light.X_BL = moved(b.description.motions[0], 0.3, light.X_BL);
  light.motion = -1;
  const auto settings = settings_of(4);
  const Film moving = film_at(b.make().get(), b.frame, 0.3, over_beacon(), settings);
  EXPECT_EQ(moving.radiance, still.render(over_beacon(), settings).radiance);
}

TEST(MovingLight, ALongExposureSeesTheWholeSweep) {
  const SceneBuilder b = beacon();
  std::vector<PoseFrame> keys(17, b.frame);
  std::vector<const PoseFrame*> frames;
  for (size_t k = 0; k < keys.size(); ++k) {
    keys[k].time = 0.25 * static_cast<double>(k) / 16;
    frames.push_back(&keys[k]);
  }
  const auto renderer = b.make();
  renderer->update(frames, keys[0]);
  CameraView view = over_beacon();
  view.shutter = {.open = 0, .length = 1, .row = 0};
  Film film;
  renderer->render(view, settings_of(512, 2), &film);
  EXPECT_NEAR(azimuth_of(film), M_PI / 4, 0.05);
  double sharp = 0;
  for (int k = 0; k < 64; ++k) {
    const double time = 0.25 * (k + 0.5) / 64;
    sharp += sum_of(film_at(renderer.get(), b.frame, time, over_beacon(), settings_of(16, 2))) / 64;
  }
  const double error = picture_mean(film).standard_error() / picture_mean(film).mean;
  EXPECT_NEAR(sum_of(film) / sharp, 1, 0.01 + 4 * error) << "the mean of the instants";
  EXPECT_LT(error, 0.01);
}

/// A lit ball that swings over a floor moves its glow and itself.
TEST(MovingLight, AHangingBallIsDrawnWhereItHangs) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0.6f, 0.6f, 0.6f}));
  const int ball = b.add(ShapeType::kSphere, {0.2f, 0, 0}, translation({0, 0, 2}),
                         b.add_emitter({1000, 1000, 1000}));
  b.description.instances[static_cast<size_t>(ball)].is_static = false;
  b.description.instances[static_cast<size_t>(ball)].motion = 0;
  b.description.motions = {
      {.axis = {0, 1, 0}, .pivot = {0, 0, 4}, .swing = kPi / 6, .swing_rate = 0.25}};
  const auto renderer = b.make();
  RenderSettings settings = settings_of(4);
  settings.exact_channels = true;
  for (const double time : {0.0, 1.0}) {
    const Film film = film_at(renderer.get(), b.frame, time, over_beacon(), settings);
    // About +Y a thing below the pivot goes towards -X.
    const double x = time > 0 ? -1 : 0, z = time > 0 ? 4 - std::sqrt(3.0) : 2;
    double column = 0;
    int count = 0;
    for (int i = 0; i < 1600; ++i) {
      if (film.part[static_cast<size_t>(i)] != static_cast<uint32_t>(ball) + 1) continue;
      column += i % 40 - 19.5, ++count;
    }
    ASSERT_GT(count, 0);
    EXPECT_NEAR(column / count, x / (12 - z) * 0.5 * 40 / std::tan(20 * kDegree), 0.5) << time;
  }
}

TEST(MovingLight, OutOfABlackoutComesNoLight) {
  SceneBuilder b = room_with_window({"lamp", 40000, 0, 200}, true);
  const double forever = std::numeric_limits<double>::infinity();
  b.description.schedules = {{{PowerCut{5, forever}}}};
  for (MaterialDescription& material : b.description.materials) material.schedule = 0;
  b.description.sky.schedule = 0;
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 2.2f}, {-1, 1, 0.4f}), 32, 32, 50);
  const auto settings = settings_of(4);
  const auto renderer = b.make();
  EXPECT_EQ(sum_of(film_at(renderer.get(), b.frame, 5, view, settings)), 0);
  const Film after = film_at(renderer.get(), b.frame, 4.9, view, settings);
  EXPECT_GT(sum_of(after), 0);
  // The guide is the same whether a dark picture or a lit one comes first.
  EXPECT_EQ(after.radiance, film_at(b.make().get(), b.frame, 4.9, view, settings).radiance);
}

/// A room with a window under the sky of a day in Munich, from 19:00 on, an hour a second.
SceneBuilder room_of_a_day() {
  SceneBuilder b = room_with_window({"sky", 0, 0, 0}, true);
  b.add(ShapeType::kPlane, {0, 0, 1}, translation({0, 0, -0.2f}),
        b.add_diffuse({0.2f, 0.2f, 0.2f}));
  DayCycle day{{2026, 6, 21, 19, 0, 0, 2}, {48.14, 11.58}, 3600};
  day.air.width = 64, day.air.height = 32;
  AtmosphereOptions air = day.air;
  air.to_sun = to_sun_at(day, 0);
  SkyLight sky = make_sky(air).value();
  b.description.sky.environment = {"start", sky.width, sky.height, std::move(sky.texels)};
  b.description.sky.day = day;
  LightDescription sun;
  sun.type = PunctualLightType::kDirectional;
  sun.radius = static_cast<float>(std::sin(kSunAngularRadius));
  sun.intensity = sky.sun_illuminance;
  sun.body = 0;
  sun.of_sky = true;
  b.description.lights = {sun};
  return b;
}
CameraView outside() { return SceneBuilder::camera(look_at({9, 7, 4}, {0, 0, 1}), 32, 24, 50); }

TEST(MovingSky, PicturesAreTheSameInAnyOrderAndByAnyThreads) {
  const SceneBuilder b = room_of_a_day();
  const CameraView inside =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 2.2f}, {-1, 1, 0.4f}), 32, 32, 50);
  const auto settings = settings_of(4);
  const auto one = b.make();
  std::vector<Film> films;
  for (const double time : {14.5, 1.0, 3.2, 0.0, 1.0})
    films.push_back(film_at(one.get(), b.frame, time, inside, settings));
  EXPECT_EQ(films[1].radiance, films[4].radiance);
  set_thread_count(1);
  EXPECT_EQ(films[0].radiance, film_at(b.make().get(), b.frame, 14.5, inside, settings).radiance);
  set_thread_count(0);
  EXPECT_EQ(films[3].radiance, film_at(b.make().get(), b.frame, 0, inside, settings).radiance);
}

TEST(MovingSky, EveryHourIsThatOfASkyThatStandsStill) {
  const SceneBuilder b = room_of_a_day();
  const auto moving = b.make();
  for (const double time : {0.0, 1.55, 2.7, 14.0}) {
    SceneBuilder still = b;
    AtmosphereOptions air = b.description.sky.day->air;
    air.to_sun = to_sun_at(*b.description.sky.day, time);
    SkyLight sky = make_sky(air).value();
    still.description.sky.environment.texels = std::move(sky.texels);
    still.description.sky.day.reset();
    LightDescription& sun = still.description.lights[0];
    sun.intensity = sky.sun_illuminance;
    const Frame frame = Frame::from_z(air.to_sun);
    sun.X_BL = {frame.x, frame.y, frame.z, {}};
    const Film now = film_at(moving.get(), b.frame, time, outside(), settings_of(64));
    const Film then = still.render(outside(), settings_of(64));
    const double error =
        std::hypot(picture_mean(now).standard_error(), picture_mean(then).standard_error());
    EXPECT_NEAR(sum_of(now) / sum_of(then), 1, 0.02 + 4 * error / picture_mean(then).mean)
        << "after " << time << " h";
  }
}

// Through sunset, twilight and night to sunrise: no jumps and no numbers that are none.
TEST(MovingSky, TheGroundDarkensSmoothly) {
  const SceneBuilder b = room_of_a_day();
  const auto renderer = b.make();
  const auto lux = [&](double hour) {
    PoseFrame frame = b.frame;
    frame.time = hour;
    renderer->update(frame, frame, frame);
    return static_cast<double>(renderer->illuminance({20, 0, 0.5f}, {0, 0, 1}));
  };
  double before = lux(1.9);  // the sun is 3 degrees high
  for (double hour = 1.9 + 1.0 / 60; hour < 3.6; hour += 1.0 / 60) {
    const double now = lux(hour);
    ASSERT_TRUE(std::isfinite(now));
    EXPECT_LT(now, 1.06 * before) << hour;
    EXPECT_GT(now, 0.78 * before) << hour;
    before = now;
  }
  EXPECT_LT(lux(5.5), 0.1) << "half past midnight";
  EXPECT_GT(lux(5.5), 1e-4) << "stars and airglow";
  EXPECT_GT(lux(18), 5e4) << "the next day";
}

/// Fast pictures of one history at `count` instants `step` [s] apart from `start` on: the largest
/// difference of one's light, from the fourth on, to that of a picture without a history.
double worst_lag(const SceneBuilder& b, const CameraView& view, double start, double step,
                 int count) {
  const auto renderer = b.make();
  const auto history = renderer->make_history();
  RenderSettings settings;
  settings.tier = RenderTier::kInteractive;
  settings.max_depth = 8;
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double time = start + step * i;
    settings.history = history.get();
    const double followed = sum_of(film_at(renderer.get(), b.frame, time, view, settings));
    settings.history = nullptr;
    const double fresh = sum_of(film_at(renderer.get(), b.frame, time, view, settings));
    ++settings.frame;
    if (i >= 3) worst = std::max(worst, std::abs(followed / fresh - 1));
  }
  return worst;
}

// A minute in each picture: light falls by 3 % from one to the next.
TEST(MovingSky, TheInteractiveTierFollowsTheHour) {
  EXPECT_LT(worst_lag(room_of_a_day(), outside(), 1.5, 1.0 / 60, 30), 0.12);
}

TEST(MovingLight, TheInteractiveTierFollowsABeacon) {
  SceneBuilder b = room_with_window({"lamp", 40, 0, 0}, true);
  LightDescription light = beam();
  light.motion = 0;
  b.description.motions = {{.turns = 1}};
  b.description.lights = {light};
  b.description.extent = 5;
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 2.2f}, {-1, 1, 0.4f}), 64, 64, 50);
  EXPECT_LT(worst_lag(b, view, 0, 1.0 / 30, 30), 0.45);
}

}  // namespace
}  // namespace gloam
