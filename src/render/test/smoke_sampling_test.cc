// Light in smoke by few samples: what guides rays there changes noise and never the mean.

#include <gtest/gtest.h>

#include "render/test/flame.h"
#include "render/test/probe.h"
#include "render/test/room_with_window.h"

namespace gloam {
namespace {

/// A room with a window, full of even smoke; `lamps` in the next room, behind the wall at +y, of
/// which nothing is seen.
SceneBuilder smoky_room(int lamps, bool is_guided) {
  SceneBuilder b = room_with_window({"lamp_sun_and_sky", 4000, 20000, 200}, is_guided);
  const int glow = b.add_emitter({4000, 4000, 4000});
  for (int i = 0; i < lamps; ++i) {
    const Vec3f p{-1.8f + 0.1f * static_cast<float>(i), 3, 1.5f};
    b.add(ShapeType::kSphere, {0.1f, 0.1f, 0.1f}, translation(p), glow);
    if (!is_guided) b.description.instances.back().is_static = false;
  }
  MediaBuilder smoke;
  smoke.add_box({4, 4, 3}, {0, 0, 1.5f}, 1,
                smoke.add_medium({0.7f, 0.8f, 0.9f}, {0.6f, 0.6f, 0.6f}, {0.6f, 0.6f, 0.6f}));
  b.description.media = smoke.media;
  b.description.volumes = smoke.volumes;
  return b;
}

/// Root of the mean over the pixels of their relative variances by one sample.
double noise_of(const Film& film, int spp) {
  const double dark = 0.1 * picture_mean(film).mean;
  double sum = 0;
  for (size_t i = 0; i < film.radiance.size(); ++i) {
    sum += film.variance[i].x / (film.radiance[i].x * film.radiance[i].x + dark * dark);
  }
  return std::sqrt(sum * spp / static_cast<double>(film.radiance.size()));
}

struct SmokeCase {
  const char* name;
  int lamps, depth;
  double most;  ///< noise with the guide, as a fraction of that without
};
class SmokeTest : public testing::TestWithParam<SmokeCase> {};

TEST_P(SmokeTest, TheGuideChangesTheNoiseAndNotTheMean) {
  const SmokeCase& c = GetParam();
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 1.2f}, {-1, 1, 1}), 24, 24, 60);
  const int spp = 256;
  const Film guided = smoky_room(c.lamps, true).render(view, settings_of(spp, c.depth));
  const Film plain = smoky_room(c.lamps, false).render(view, settings_of(spp, c.depth));
  const Mean mean = picture_mean(guided), truth = picture_mean(plain);
  const double error = std::hypot(mean.standard_error(), truth.standard_error());
  EXPECT_NEAR(mean.mean, truth.mean, 4 * error);
  EXPECT_LT(error, 0.05 * truth.mean) << "too noisy to compare";
  const double ratio = noise_of(guided, spp) / noise_of(plain, spp);
  RecordProperty("noise_ratio", std::to_string(ratio));
  std::printf("%s: noise by one sample %.2f with the guide, %.2f without\n", c.name,
              noise_of(guided, spp), noise_of(plain, spp));
  EXPECT_LT(ratio, c.most);
}

INSTANTIATE_TEST_SUITE_P(Rooms, SmokeTest,
                         testing::Values(SmokeCase{"few_lights_once", 2, 2, 0.8},
                                         SmokeCase{"few_lights", 2, 5, 0.8},
                                         SmokeCase{"thirty_lights_once", 30, 2, 0.7},
                                         SmokeCase{"thirty_lights", 30, 5, 0.8},
                                         SmokeCase{"by_a_tree", 60, 5, 0.95}),
                         [](const auto& info) { return std::string(info.param.name); });

// By chance a ray meets a thin flame now and then, and then all of its light at once.
TEST(Smoke, RaysGatherTheLightOfFlamesVoxelByVoxel) {
  // In a thick one it is the place of the collision that tells how hot it is there.
  for (const auto& [extinction, most] : {std::pair{0.2f, 0.6}, {2.0f, 0.8}, {40.0f, 1.5}}) {
    SceneBuilder b;
    add_flame(&b, {}, extinction);
    const Probe probe(b);
    const MediaView& media = probe.view.media;
    const Ray ray = make_ray({-2, 0.03f, 0.35f}, {1, 0.01f, 0.02f});
    const RaySums truth = integrate_ray(media, ray, 4);
    Mean seen;
    for (uint32_t i = 0; i < 20000; ++i) {
      Sampler sampler = independent(i, 9);
      seen.add(
          static_cast<double>(sample_distance(media, ray, 4, {}, {1, 1, 1}, &sampler).emission.y));
    }
    const double noise = seen.standard_error() * std::sqrt(20000.0) / seen.mean;
    std::printf("extinction %.1f: noise by one sample %.2f\n", static_cast<double>(extinction),
                noise);
    EXPECT_NEAR(seen.mean, truth.emission[1], 4 * seen.standard_error() + 2e-3 * truth.emission[1]);
    EXPECT_LT(noise, most) << "extinction " << extinction;
  }
}

}  // namespace
}  // namespace gloam
