// The guide to what static geometry lets through may change noise alone.

#include <gtest/gtest.h>

#include "render/test/probe.h"
#include "render/test/room_with_window.h"

namespace gloam {
namespace {

/// Root mean square over the pixels of their relative standard error; what is darker than a tenth
/// of the mean counts less.
double relative_noise(const Film& film) {
  const double dark = 0.1 * picture_mean(film).mean;
  double sum = 0;
  for (size_t i = 0; i < film.radiance.size(); ++i) {
    sum += film.variance[i].x / (film.radiance[i].x * film.radiance[i].x + dark * dark);
  }
  return std::sqrt(sum / static_cast<double>(film.radiance.size()));
}

struct GuideCase {
  RoomLight light;
  int max_depth;
  double most;  ///< noise with the guide, as a share of that without
};

class GuideTest : public testing::TestWithParam<GuideCase> {};

TEST_P(GuideTest, ChangesTheNoiseAndNotTheMean) {
  RenderSettings settings;
  settings.spp = 128;
  settings.variance = true;
  settings.max_depth = GetParam().max_depth;
  // Sees floor and two walls, but neither the window nor the lamp.
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 2.2f}, {-1, 1, 0.4f}), 32, 32, 50);
  const Film guided = room_with_window(GetParam().light, true).render(view, settings);
  const Film plain = room_with_window(GetParam().light, false).render(view, settings);
  const Mean mean = picture_mean(guided), truth = picture_mean(plain);
  const double error = std::hypot(mean.standard_error(), truth.standard_error());
  EXPECT_NEAR(mean.mean, truth.mean, 4 * error);
  EXPECT_LT(error, 0.03 * truth.mean) << "too noisy to compare";
  EXPECT_LT(relative_noise(guided) / relative_noise(plain), GetParam().most);
}

// Deep paths are noisy for reasons that no choice of light mends, so direct light gains more.
INSTANTIATE_TEST_SUITE_P(
    Rooms, GuideTest,
    testing::Values(GuideCase{{"sun_lamp_and_sky", 40000, 2000, 200}, 5, 0.75},
                    GuideCase{{"direct_sun_lamp_and_sky", 40000, 2000, 200}, 2, 0.4},
                    GuideCase{{"sun_and_lamp", 40000, 2000, 0}, 5, 0.75},
                    GuideCase{{"sun_and_weak_lamp", 2000, 2000, 0}, 5, 0.78},
                    GuideCase{{"direct_sun_and_weak_lamp", 2000, 2000, 0}, 2, 0.4},
                    GuideCase{{"sun_and_glow", 200, 2000, 0}, 5, 1.02},
                    GuideCase{{"direct_sun_and_glow", 200, 2000, 0}, 2, 0.6},
                    GuideCase{{"sun", 0, 2000, 0}, 5, 0.8},
                    GuideCase{{"lamp", 40000, 0, 0}, 5, 1.02},
                    GuideCase{{"lamp_and_sky", 40000, 0, 200}, 5, 1.02},
                    GuideCase{{"sky", 0, 0, 200}, 5, 0.7}),
    [](const auto& info) { return std::string(info.param.light.name); });

TEST(Guide, IsTheSameWhateverWasOffAtTheFirstPicture) {
  SceneBuilder b = room_with_window({"lamp_and_sky", 4000, 0, 200}, true);
  for (MaterialDescription& m : b.description.materials) {
    if (luminance(m.emission) > 0) m.schedule = 0;
  }
  b.description.schedules.push_back({{OnOff{1.0, 0.25, 0}}});
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 2.2f}, {-1, 1, 0.4f}), 16, 16, 50);
  RenderSettings settings;
  settings.spp = 4;
  const auto picture_after = [&](std::initializer_list<double> times) {
    const auto renderer = b.make();
    Film film;
    for (const double time : times) {
      PoseFrame frame = b.frame;
      frame.time = time;
      renderer->update(frame, frame, frame);
      renderer->render(view, settings, &film);
    }
    return film.radiance;
  };
  const auto alone = picture_after({0.1}), later = picture_after({0.6, 0.1});
  EXPECT_EQ(alone, later);
  EXPECT_NE(alone, picture_after({0.6})) << "the lamp's schedule has no effect";
}

}  // namespace
}  // namespace gloam
