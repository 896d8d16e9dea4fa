// Drops and flakes drawn over a picture.

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/test/scene_builder.h"

namespace gloam {
namespace {

constexpr int kWidth = 240, kHeight = 180;

/// One class of particles before an even sky.
SceneBuilder strewn(float diameter, float number, float fall_speed, float sky = 100) {
  SceneBuilder b;
  b.description.sky.ambient = {0, 0, 0};
  b.description.weather.shelter = std::make_shared<const ShelterMap>();
  ParticleSet set;
  set.classes = {{diameter, number, fall_speed}};
  set.seed = 7;
  b.description.weather.particles = {set};
  b.description.sky.ambient = Vec3f{sky, sky, sky};
  return b;
}

/// Over all that is seen.
std::shared_ptr<const ShelterMap> roof_at(float height) {
  auto roof = std::make_shared<ShelterMap>();
  roof->low = {-100, -100};
  roof->cell = 50;
  roof->nx = roof->ny = 4;
  roof->height.assign(16, height);
  return roof;
}

struct Drawn {
  std::vector<Vec3f> before, after;
};

/// `exposure` [s], at `time` [s].
Drawn draw_strewn(const SceneBuilder& b, double exposure, double time, float background,
                  const Affine3f& X_WC) {
  auto renderer = make_cpu_renderer(b.description);
  PoseFrame open = b.frame, close = b.frame;
  open.time = time, close.time = time + exposure;
  const PoseFrame* const keys[] = {&open, &close};
  renderer.value()->update(std::span(keys, exposure > 0 ? 2 : 1), open);
  CameraView view = SceneBuilder::camera(X_WC, kWidth, kHeight, 40);
  view.shutter = {.open = 0, .length = exposure > 0 ? 1.0f : 0.0f, .row = 0};
  RenderSettings settings = settings_of(0);
  Film film;
  renderer.value()->render(view, settings, &film);
  Drawn out;
  out.before.assign(film.pixel_count(), Vec3f{background, background, background});
  out.after = out.before;
  renderer.value()->draw_particles(view, film, &out.after);
  return out;
}

double mean_change(const Drawn& d) {
  double sum = 0;
  for (size_t i = 0; i < d.after.size(); ++i)
    sum += static_cast<double>(d.after[i].y - d.before[i].y) / static_cast<double>(d.after.size());
  return sum;
}
double deviation(const Drawn& d) {
  double sum = 0;
  const double mean = mean_change(d);
  for (size_t i = 0; i < d.after.size(); ++i) {
    const double x = static_cast<double>(d.after[i].y - d.before[i].y) - mean;
    sum += x * x / static_cast<double>(d.after.size());
  }
  return std::sqrt(sum);
}

const Affine3f kLevel = look_at({0, 0, 2}, {10, 0, 2});

TEST(Particles, DifferFromTheMediumThatTheyAreButNotInTheMean) {
  // Before black, drops are as bright as half the sky around them: what is drawn is what they
  // differ by, of which the mean over pictures is nothing.
  const SceneBuilder b = strewn(2e-3f, 400, 6);
  double mean = 0, spread = 0;
  constexpr int kPictures = 24;
  for (int i = 0; i < kPictures; ++i) {
    const Drawn d = draw_strewn(b, 0.01, 0.37 * i, 20, kLevel);
    mean += mean_change(d) / kPictures;
    spread += deviation(d) / kPictures;
  }
  EXPECT_GT(spread, 0.2) << "nothing is drawn";
  // Drops bring the light of the picture and of the sky: 60 in the mean instead of 20. They cover
  // n pi/4 D² per metre.
  const double covered = 400 * M_PI / 4 * 4e-6 * 4.1;  // of the four metres that are drawn
  EXPECT_LT(std::fabs(mean), 0.1 * covered * 40) << "the mean is the medium's";
}

TEST(Particles, AStreakIsAsLongAsTheWayInTheExposure) {
  // One drop class so sparse that single streaks stand apart; the longest is the nearest's.
  const SceneBuilder b = strewn(4e-3f, 4, 8);
  const Drawn still = draw_strewn(b, 0, 3, 20, kLevel),
              moving = draw_strewn(b, 0.02, 3, 20, kLevel);
  const auto longest_run = [](const Drawn& d) {
    int best = 0;
    for (int x = 0; x < kWidth; ++x) {
      int run = 0;
      for (int y = 0; y < kHeight; ++y) {
        const size_t i = static_cast<size_t>(y) * kWidth + static_cast<size_t>(x);
        run = d.after[i].y > d.before[i].y + 0.05f ? run + 1 : 0;
        best = std::max(best, run);
      }
    }
    return best;
  };
  // 16 cm in 20 ms; focal length 247 px: 10 px at 4 m, more nearer.
  EXPECT_GE(longest_run(moving), 10);
  EXPECT_LE(longest_run(still), 8) << "without an exposure time a drop is a dot";
}

TEST(Particles, AreHiddenByWhatIsNearer) {
  SceneBuilder b = strewn(3e-3f, 300, 6);
  b.add(ShapeType::kBox, {0.01f, 50, 50}, translation({0.09f, 0, 0}), b.add_diffuse({0, 0, 0}));
  const Drawn d = draw_strewn(b, 0.01, 1, 20, kLevel);
  EXPECT_EQ(deviation(d), 0) << "drops are seen through a wall";
}

TEST(Particles, DoNotFallUnderARoof) {
  SceneBuilder b = strewn(3e-3f, 300, 6);
  b.description.weather.shelter = roof_at(5);
  EXPECT_EQ(deviation(draw_strewn(b, 0.01, 1, 20, kLevel)), 0);
  EXPECT_GT(deviation(draw_strewn(b, 0.01, 1, 20, look_at({0, 0, 7}, {10, 0, 7}))), 0);
}

TEST(Particles, AreTheSameForAnyNumberOfThreadsAndOthersAtAnotherTime) {
  const SceneBuilder b = strewn(2e-3f, 400, 6);
  const auto bits = [](const Drawn& d) {
    return std::string(reinterpret_cast<const char*>(d.after.data()),
                       d.after.size() * sizeof(Vec3f));
  };
  set_thread_count(1);
  const std::string one = bits(draw_strewn(b, 0.01, 2, 20, kLevel));
  set_thread_count(4);
  const std::string four = bits(draw_strewn(b, 0.01, 2, 20, kLevel));
  set_thread_count(0);
  EXPECT_TRUE(one == four) << "the picture depends on the number of threads";
  EXPECT_FALSE(one == bits(draw_strewn(b, 0.01, 2.5, 20, kLevel))) << "the rain stands still";
}

// The ground before a camera that looks down at it, where no drop in the air is near enough.
SceneBuilder splashing() {
  SceneBuilder b = strewn(3e-3f, 300, 8);
  b.add(ShapeType::kBox, {50, 50, 0.01f}, translation({0, 0, -0.01f}), b.add_diffuse({0, 0, 0}));
  return b;
}

TEST(Particles, SplashOnTheGroundButNotUnderARoof) {
  const Affine3f X_WC = look_at({0, 0, 0.4f}, {0.6f, 0, 0});
  SceneBuilder b = splashing();
  const Drawn open = draw_strewn(b, 0.01, 2, 0, X_WC);
  set_thread_count(1);
  const Drawn again = draw_strewn(b, 0.01, 2, 0, X_WC);
  set_thread_count(0);
  EXPECT_TRUE(open.after == again.after) << "by the number of threads";
  b.description.weather.particles[0].classes[0].fall_speed = 1;  // too slow to splash
  const auto lit = [](const Drawn& d) {
    int count = 0;
    for (const Vec3f light : d.after) count += light.y > 0.5f;
    return count;
  };
  const int slow = lit(draw_strewn(b, 0.01, 2, 0, X_WC));
  EXPECT_GT(lit(open), slow + 200) << "no splashes are seen";
  b = splashing();
  b.description.weather.shelter = roof_at(3);
  EXPECT_EQ(lit(draw_strewn(b, 0.01, 2, 0, X_WC)), 0);
}

// A roof's edge at x = 3 m, 2.5 m up, seen from beside it. No rain is near enough to be drawn.
TEST(Particles, DripFromEdges) {
  SceneBuilder b = strewn(3e-4f, 1e-3f, 1);
  b.add(ShapeType::kBox, {50, 50, 0.01f}, translation({0, 0, -0.01f}), b.add_diffuse({0, 0, 0}));
  b.add(ShapeType::kBox, {1, 1, 0.05f}, translation({4, 0, 2.45f}), b.add_diffuse({0, 0, 0}));
  const Affine3f X_WC = look_at({2.9f, -3, 1.5f}, {2.9f, 0, 1.5f});
  const auto lit = [](const Drawn& d, int from, int to) {
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = from; x < to; ++x)
        count += d.after[static_cast<size_t>(y * kWidth + x)].y > 0.5f;
    return count;
  };
  EXPECT_EQ(lit(draw_strewn(b, 0.005, 2, 0, X_WC), 0, kWidth), 0);
  for (int i = -8; i < 8; ++i)
    b.description.weather.drips.push_back(
        {{3.03f, 0.1f * static_cast<float>(i) + 0.05f, 2.5f}, {-1, 0}, 0.1f, 1e-6f});
  const Drawn drips = draw_strewn(b, 0.005, 2, 0, X_WC);
  // The edge is ten centimetres to the right of the middle, 5 to 10 px.
  EXPECT_GT(lit(drips, kWidth / 2 + 3, kWidth / 2 + 14), 100);
  EXPECT_LT(lit(drips, 0, kWidth / 2 - 10), 40) << "splashes alone";
  set_thread_count(1);
  EXPECT_TRUE(drips.after == draw_strewn(b, 0.005, 2, 0, X_WC).after) << "by the number of threads";
  set_thread_count(0);
  EXPECT_FALSE(drips.after == draw_strewn(b, 0.005, 2.1, 0, X_WC).after) << "they hang in the air";
}

}  // namespace
}  // namespace gloam
