// Noise that no denoiser mends is told from noise that one does.
#include "sensors/camera/sample_noise.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace gloam {
namespace {

/// A picture of even light whose samples find it with the probability `chance`, and then all of it.
Film film_of_chance(int spp, double chance) {
  Film film;
  film.width = 60;
  film.height = 44;
  const RandomStream random{3, stream_id("sample_noise_test")};
  uint64_t row = 0;
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    double sum = 0, squares = 0;
    for (int k = 0; k < spp; ++k) {
      const bool found = static_cast<double>(uniform_float(random.draw(row++, 0).v[0])) < chance;
      const double light = found ? 5 / chance : 0;
      sum += light;
      squares += light * light;
    }
    const double mean = sum / spp, variance = (squares / spp - mean * mean) / (spp - 1);
    film.radiance.push_back(Vec3f{1, 1, 1} * static_cast<float>(mean));
    film.variance.push_back(Vec3f{1, 1, 1} * static_cast<float>(variance));
  }
  return film;
}

TEST(SampleNoise, ErrorIsThatOfTheSamples) {
  for (const int spp : {4, 64}) {
    for (const double chance : {0.05, 0.5}) {
      const double expected = std::sqrt((1 / chance - 1) / spp);
      EXPECT_NEAR(pixel_error(film_of_chance(spp, chance)) / expected, 1, 0.15)
          << spp << " samples, " << chance;
    }
  }
}

TEST(SampleNoise, AsksForAsManySamplesAsMendIt) {
  EXPECT_GE(samples_needed(film_of_chance(4, 0.0005), 4), 32) << "most blocks are black";
  const int needed = samples_needed(film_of_chance(4, 0.01), 4);
  EXPECT_GT(needed, 4);
  EXPECT_EQ(samples_needed(film_of_chance(needed, 0.01), needed), needed) << "what was advised";
  EXPECT_EQ(samples_needed(film_of_chance(4, 0.5), 4), 4) << "light that most samples find";
}

TEST(SampleNoise, IsUnknownWithoutVariances) {
  Film film = film_of_chance(4, 0.01);
  film.variance.clear();
  EXPECT_EQ(samples_needed(film, 4), 4);
}

}  // namespace
}  // namespace gloam
