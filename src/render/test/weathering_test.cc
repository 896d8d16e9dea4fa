// Water, dust and snow on materials.

#include <gtest/gtest.h>

#include <cstring>

#include "base/rng.h"
#include "render/kernel/surface/weathering.h"

namespace gloam {
namespace {

constexpr Vec3f kUp{0, 0, 1}, kDown{0, 0, -1}, kAside{1, 0, 0};

WeatheredMaterial concrete() { return {{0.35f, 0.34f, 0.33f}, 0, 0.85f, 0, 1.5f, 0.1f, 0, 1}; }

/// Mean of `value(p)` over places of a 400 m square.
template <class Value>
double mean(const Value& value) {
  const RandomStream stream{5, 1};
  double sum = 0;
  for (uint32_t i = 0; i < 4000; ++i) {
    sum += value(Vec3f{400 * static_cast<float>(stream.uniform(i, 0)),
                       400 * static_cast<float>(stream.uniform(i, 1)), 0});
  }
  return sum / 4000;
}

TEST(Weathering, NoneLeavesTheMaterialAsItIs) {
  const WeatheredMaterial m = concrete();
  const Vec3f p{1, 2, 3};
  for (const WeatheredMaterial& same :
       {apply_wetness(m, {}, p, kUp, 0, 0), apply_dust(m, {}, p, kUp, 0),
        apply_snow(m, {}, p, kUp, 0).material, apply_snow(m, {0.8f, 1}, p, kDown, 0).material}) {
    EXPECT_EQ(memcmp(&m, &same, sizeof m), 0);
  }
}

TEST(Weathering, RingsOfRainHaveTheSlopeOfTheirHeightsAndNoMean) {
  double sum = 0, most = 0;
  const RandomStream stream{9, 2};
  for (uint32_t i = 0; i < 4000; ++i) {
    const Vec3f p{static_cast<float>(stream.uniform(i, 0)),
                  static_cast<float>(stream.uniform(i, 1)), 0};
    const auto height = [&](Vec3f at) { return rain_rings(at, 3.1f, 2000, 0).value; };
    const Field at = rain_rings(p, 3.1f, 2000, 0);
    constexpr float kStep = 2e-4f;
    const float dx =
        (height(p + Vec3f{kStep, 0, 0}) - height(p - Vec3f{kStep, 0, 0})) / (2 * kStep);
    const float dy =
        (height(p + Vec3f{0, kStep, 0}) - height(p - Vec3f{0, kStep, 0})) / (2 * kStep);
    EXPECT_NEAR(at.gradient.x, dx, 0.02f);
    EXPECT_NEAR(at.gradient.y, dy, 0.02f);
    sum += static_cast<double>(at.value);
    most = std::max(most, static_cast<double>(std::fabs(at.value)));
  }
  EXPECT_GT(most, 1e-4);
  EXPECT_LT(std::fabs(sum / 4000), 0.1 * most);
  EXPECT_EQ(rain_rings({0.3f, 0.2f, 0}, 3.1f, 0, 0).value, 0) << "no drops, no rings";
}

TEST(Weathering, WaterDarkensWhatIsPorous) {
  // Black stays black, white stays white, in between it darkens most.
  EXPECT_EQ(weathering::wet_albedo(0, 1), 0);
  EXPECT_NEAR(weathering::wet_albedo(1, 1), 1, 1e-6);
  const double deep = 1.5 - std::sqrt(1.25);  // Kubelka and Munk: K/S 0.25 dry, 0.5 wet
  EXPECT_NEAR(weathering::wet_albedo(0.5f, 1), deep * 0.526 / (1 - 0.474 * deep), 1e-5);
  double before = 1;
  for (const float amount : {0.0f, 0.1f, 0.25f, 0.4f, 0.5f}) {
    const WeatheredMaterial wet = apply_wetness(concrete(), {amount, 0.8f, 1}, {}, kAside, 0, 0);
    EXPECT_LT(luminance(wet.base_color), before);
    before = luminance(wet.base_color);
  }
  EXPECT_NEAR(before / luminance(concrete().base_color), 0.52, 0.02);
  WeatheredMaterial steel = concrete();
  steel.metallic = 1;
  EXPECT_EQ(apply_wetness(steel, {0.8f, 0.8f, 1}, {}, kAside, 0, 0).base_color.x,
            steel.base_color.x);
}

TEST(Weathering, WaterCoatsAndStandsOnLevelGround) {
  const WeatheredMaterial wall = apply_wetness(concrete(), {1, 0.8f, 1}, {}, kAside, 0, 0);
  EXPECT_NEAR(wall.coat_weight, 0.85, 1e-5);
  EXPECT_NEAR(wall.coat_ior, 1.33, 1e-5);
  EXPECT_LT(wall.coat_roughness, 0.1);
  EXPECT_LT(wall.roughness, concrete().roughness);
  // A puddle is a smooth level film: its share grows with the water, and low places fill first.
  const auto puddles = [](float amount, float relief) {
    return mean([&](Vec3f p) {
      return apply_wetness(concrete(), {amount, 0.8f, 1}, p, kUp, relief, 0).bump < 0.05f;
    });
  };
  EXPECT_EQ(puddles(0.5f, 0), 0);
  EXPECT_NEAR(puddles(0.75f, 0), 0.64, 0.05);  // of a normal distribution below 0.36
  EXPECT_GT(puddles(1, 0), 0.97);
  EXPECT_GT(puddles(0.7f, -1), puddles(0.7f, 0) + 0.1);
  EXPECT_LT(puddles(0.7f, 1), puddles(0.7f, 0) - 0.1);
}

TEST(Weathering, DustSettlesOnWhatFacesUp) {
  const Dust dust{0.5f};
  const auto light = [&](Vec3f n, float amount) {
    Dust d = dust;
    d.amount = amount;
    WeatheredMaterial black = concrete();
    black.base_color = {0, 0, 0};
    return mean([&](Vec3f p) { return apply_dust(black, d, p, n, 0).base_color.y; }) / d.color.y;
  };
  EXPECT_GT(light(kUp, 1), 0.99);
  EXPECT_GT(light(kUp, 0.5f), 2 * light(kAside, 0.5f));
  EXPECT_GT(light(kAside, 0.5f), 0);
  EXPECT_EQ(light(kDown, 0.5f), 0);
  EXPECT_GT(light(kUp, 0.5f), light(kUp, 0.2f) + 0.1);
  const WeatheredMaterial deep = apply_dust(concrete(), {1}, {}, kUp, 0);
  EXPECT_NEAR(deep.roughness, 1, 0.01);
}

TEST(Weathering, SnowStartsInPatchesAndLeavesSteepFaces) {
  const auto share = [](float amount, Vec3f n, float footprint) {
    return mean(
        [&](Vec3f p) { return apply_snow(concrete(), {amount, 1}, p, n, footprint).cover; });
  };
  double before = 0;
  for (const float amount : {0.2f, 0.4f, 0.6f, 0.8f, 1.0f}) {
    EXPECT_GT(share(amount, kUp, 0), before);
    before = share(amount, kUp, 0);
    // From afar the camera sees the share that lies there.
    EXPECT_NEAR(share(amount, kUp, 5), before, 0.02) << amount;
  }
  EXPECT_GT(before, 0.99);
  EXPECT_EQ(share(1, kAside, 0), 0);
  const Vec3f roof = normalize(Vec3f{0.7f, 0, 0.7f});
  EXPECT_LT(share(0.5f, roof, 0), share(0.5f, kUp, 0));
  const Vec3f steep = normalize(Vec3f{0.87f, 0, 0.5f});  // 60 degrees
  EXPECT_LT(share(0.5f, steep, 0), 0.05 * share(0.5f, kUp, 0));
  const SnowCover deep = apply_snow(concrete(), {1, 1}, {0.3f, 0.2f, 0}, kUp, 0);
  EXPECT_NEAR(luminance(deep.material.base_color), 0.9, 0.01);
  EXPECT_NEAR(deep.relief.value, 0.04, 0.002);
}

TEST(Weathering, EverythingStaysInRange) {
  const RandomStream stream{9, 1};
  const float nan = std::nanf("");
  const Vec3f normals[] = {kUp, kDown, kAside, {0, 0, 0}, {nan, nan, nan}, {1e-30f, 0, 0}};
  for (uint32_t i = 0; i < 4000; ++i) {
    const auto u = [&](uint32_t k) { return static_cast<float>(stream.uniform(i, k)); };
    WeatheredMaterial m{{u(0), u(1), u(2)}, u(3), u(4), u(5), 1.5f, u(6), u(7), 1};
    const float reach = i % 2 == 0 ? 10.0f : 1e4f, footprint = i % 3 == 0 ? 0.0f : 10 * u(11);
    const Vec3f p{reach * u(8), reach * u(9), reach * u(10)}, n = normals[i % 6];
    m = apply_wetness(m, {u(12), u(13), i}, p, n, 4 * u(14) - 2, footprint);
    m = apply_dust(m, {u(15), {0.4f, 0.4f, 0.3f}, i}, p, n, footprint);
    const SnowCover snow = apply_snow(m, {u(16), i}, p, n, footprint);
    m = snow.material;
    for (const float x : {m.base_color.x, m.base_color.y, m.base_color.z, m.metallic, m.roughness,
                          m.coat_weight, m.coat_roughness, m.fuzz, m.bump, snow.cover}) {
      ASSERT_TRUE(x >= 0 && x <= 1) << x;
    }
    ASSERT_TRUE(m.coat_ior >= 1.3f && m.coat_ior <= 1.51f) << m.coat_ior;
    ASSERT_TRUE(std::isfinite(length(snow.relief.gradient)));
  }
}

}  // namespace
}  // namespace gloam
