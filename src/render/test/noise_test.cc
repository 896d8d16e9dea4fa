// Noises: the statistics that their table promises, slopes, reach and what filtering leaves.

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "render/kernel/math/noise.h"

namespace gloam {
namespace {

struct Places {
  RandomStream stream{11, 3};
  uint32_t count = 0;
  Vec3f operator()(float reach) {
    const auto one = [&] {
      return reach * (2 * static_cast<float>(stream.uniform(0, count++)) - 1);
    };
    const float x = one(), y = one(), z = one();
    return {x, y, z};
  }
};

struct Moments {
  double mean = 0, variance = 0, least = 1e9, most = -1e9;
};
template <class Sample>
Moments moments(const Sample& sample, int count = 200000) {
  Places place;
  double sum = 0, squares = 0;
  Moments m;
  for (int i = 0; i < count; ++i) {
    const double x = sample(place(500));
    sum += x;
    squares += x * x;
    m.least = std::min(m.least, x);
    m.most = std::max(m.most, x);
  }
  m.mean = sum / count;
  m.variance = squares / count - m.mean * m.mean;
  return m;
}

TEST(Noise, HasTheStatedMeanVarianceAndRange) {
  const Moments gradient = moments([](Vec3f p) { return gradient_noise(p, 3).value; });
  EXPECT_NEAR(gradient.mean, 0, 0.01);
  EXPECT_NEAR(gradient.variance, 1, 0.01);
  EXPECT_LT(std::max(-gradient.least, gradient.most), 7.9);
  const Moments value = moments([](Vec3f p) { return value_noise(p, 3).value; });
  EXPECT_NEAR(value.mean, 0, 0.01);
  EXPECT_NEAR(value.variance, 1, 0.01);
  EXPECT_LT(std::max(-value.least, value.most), 2.5);
  const Moments sum = moments([](Vec3f p) { return fbm(p, 1, 5, 0.6f, 0, 3).field.value; });
  EXPECT_NEAR(sum.mean, 0, 0.01);
  EXPECT_NEAR(sum.variance, 1, 0.015);
  const Moments billow = moments([](Vec3f p) { return turbulence(p, 1, 4, 0.5f, 0, 3).value; });
  EXPECT_NEAR(billow.mean, 1, 0.01);
  EXPECT_GE(billow.least, 0);
  EXPECT_LT(billow.most, 9.9);
  const Moments crest = moments([](Vec3f p) { return ridged(p, 1, 4, 0.5f, 0, 3).value; });
  EXPECT_NEAR(crest.mean, 0.5, 0.01);
  EXPECT_LE(crest.most, 1);
  EXPECT_GT(crest.least, -4);
  const Moments f1 = moments([](Vec3f p) { return cellular_noise(p, 3).f1; });
  EXPECT_NEAR(f1.mean, 0.52, 0.005);
  EXPECT_NEAR(f1.variance, 0.03, 0.002);
  EXPECT_GE(f1.least, 0);
  EXPECT_LT(f1.most, 1.733);
}

TEST(Noise, GradientsAreThoseOfTheValues) {
  const auto check = [](const auto& noise, const char* name) {
    Places place;
    for (int i = 0; i < 2000; ++i) {
      const Vec3f p = place(8);
      const Vec3f g = noise(p).gradient;
      constexpr float h = 1.0f / 512;
      const Vec3f axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      for (int axis = 0; axis < 3; ++axis) {
        const float slope =
            (noise(p + axes[axis] * h).value - noise(p - axes[axis] * h).value) / (2 * h);
        ASSERT_NEAR(g[axis], slope, 0.01) << name << ", axis " << axis;
      }
    }
  };
  check([](Vec3f p) { return gradient_noise(p, 5); }, "gradient noise");
  check([](Vec3f p) { return value_noise(p, 5); }, "value noise");
  check([](Vec3f p) { return fbm(p, {0.5f, 0.5f, 0.1f}, 2, 0.5f, 0.2f, 5).field; }, "fbm");
  check([](Vec3f p) { return turbulence(p, 0.5f, 2, 0.5f, 1.0f, 5); }, "turbulence");
  check([](Vec3f p) { return soft_step(gradient_noise(p, 5) - 0.3f, 0.8f); }, "soft step");
}

TEST(Noise, CellsMeetWithoutSeams) {
  // Both sides of cell borders, near the origin and far out, where floats still hold 1/64.
  Places place;
  for (const float far : {0.0f, 100.0f, 65536.0f}) {
    for (int i = 0; i < 500; ++i) {
      Vec3f p = place(20);
      p.x = floorf(p.x) + far;
      Vec3f below = p;
      below.x = std::nextafter(p.x, -1e9f);
      EXPECT_NEAR(gradient_noise(p, 1).value, gradient_noise(below, 1).value, 0.15) << far;
      EXPECT_NEAR(value_noise(p, 1).value, value_noise(below, 1).value, 0.05) << far;
      EXPECT_NEAR(cellular_noise(p, 1).f1, cellular_noise(below, 1).f1, 0.01) << far;
    }
  }
}

TEST(Noise, DoesNotRepeatTenKilometresOut) {
  // Cells of 1 cm: values near the origin and 10 km away have nothing in common.
  Places place;
  double product = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f p = place(10);
    const Vec3f away = p + Vec3f{1e4f, -1e4f, 1e4f};
    product += gradient_noise(p * 100.0f, 1).value * gradient_noise(away * 100.0f, 1).value;
  }
  EXPECT_NEAR(product / 20000, 0, 0.03);
  for (const float x : {1e30f, -1e30f, std::nanf(""), INFINITY}) {
    EXPECT_TRUE(std::isfinite(gradient_noise({x, x, 0}, 1).value));
    EXPECT_TRUE(std::isfinite(cellular_noise({x, x, 0}, 1).f1));
  }
}

TEST(Noise, CellularFindsTheNearestPoints) {
  // Walking from a place to its nearest point ends on it, and no neighbour is nearer than F1.
  Places place;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f p = place(50);
    const CellularNoise c = cellular_noise(p, 9);
    EXPECT_LE(c.f1, c.f2);
    const CellularNoise there = cellular_noise(p - c.to_f1, 9);
    EXPECT_NEAR(there.f1, 0, 1e-4);
    EXPECT_EQ(there.id, c.id);
    EXPECT_NEAR(cellular_noise(p - c.to_f2, 9).f1, 0, 1e-4);
  }
}

TEST(Noise, FilteringLeavesWhatAveragingLeaves) {
  // Best factor between the noise and its mean over a square patch, against noise_left().
  for (const float width : {0.25f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f}) {
    Places place;
    double product = 0, squares = 0;
    for (int i = 0; i < 1500; ++i) {
      const Vec3f p = place(500);
      double mean = 0;
      for (int k = 0; k < 144; ++k) {
        const Vec3f at = p + Vec3f{width * ((k % 12 + 0.5f) / 12 - 0.5f),
                                   width * ((k / 12 + 0.5f) / 12 - 0.5f), 0};
        mean += filtered_noise(at, {1, 1, 1}, 0, 3).field.value / 144;
      }
      const double here = filtered_noise(p, {1, 1, 1}, 0, 3).field.value;
      product += mean * here;
      squares += here * here;
    }
    EXPECT_NEAR(noise_left(width), product / squares, 0.1) << width;
  }
  EXPECT_EQ(noise_left(0), 1);
  EXPECT_EQ(fbm({1, 2, 3}, 1, 4, 0.5f, 3, 1).field.value, 0);
  EXPECT_NEAR(fbm({1, 2, 3}, 1, 4, 0.5f, 3, 1).lost, 1, 1e-6);
}

TEST(Noise, SoftStepsKeepTheirMeanWhenTheirNoiseIsFiltered) {
  // The share of places above a threshold does not change with the footprint.
  for (const float threshold : {-1.0f, 0.3f, 1.5f}) {
    const auto share = [&](float footprint) {
      return moments([&](Vec3f p) {
               const Noise n = fbm(p, 1, 4, 0.6f, footprint, 3);
               return soft_step(n.field.value - threshold, sqrtf(0.01f + n.lost));
             })
          .mean;
    };
    const double sharp = share(0);
    for (const float footprint : {0.3f, 1.0f, 3.0f}) {
      EXPECT_NEAR(share(footprint), sharp, 0.012) << threshold << ", " << footprint;
    }
  }
  EXPECT_EQ(soft_step(-4.0f, 1), 0);
  EXPECT_EQ(soft_step(4.0f, 1), 1);
  for (float x = -3; x <= 3; x += 0.125f) {
    EXPECT_NEAR(soft_step(x, 1), 0.5 * std::erfc(-x / std::sqrt(2.0)), 0.011);
  }
}

}  // namespace
}  // namespace gloam
