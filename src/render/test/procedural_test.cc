// Procedural materials: what they measure, that they filter, and that their bumps are their
// heights.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "base/rng.h"
#include "render/test/procedural_cases.h"

namespace gloam {
namespace {

constexpr Vec3f kWall{0, -1, 0};

struct Draws {
  RandomStream stream{7, 1};
  uint32_t count = 0;
  float operator()(float lo, float hi) {
    return lerp(lo, hi, static_cast<float>(stream.uniform(0, count++)));
  }
};

ProceduralSample sample_at(const ProceduralDescription& d, Vec3f p, float footprint,
                           Vec3f n = kWall) {
  ProceduralPoint at;
  at.p = p;
  at.n = n;
  at.footprint = footprint;
  return eval_procedural(d, at);
}
double tone(const ProceduralSample& s) { return luminance(s.base_color); }

/// Mean of point samples over the square of `width` about p on the wall.
struct AreaMean {
  double tone = 0, roughness = 0;
};
AreaMean mean_over_square(const ProceduralDescription& d, Vec3f p, float width, int side,
                          Draws* draw) {
  AreaMean mean;
  for (int i = 0; i < side * side; ++i) {
    const float x = (static_cast<float>(i % side) + (*draw)(0, 1)) / static_cast<float>(side);
    const float z = (static_cast<float>(i / side) + (*draw)(0, 1)) / static_cast<float>(side);
    const ProceduralSample s =
        sample_at(d, p + Vec3f{width * (x - 0.5f), 0, width * (z - 0.5f)}, 0);
    mean.tone += tone(s) / (side * side);
    mean.roughness += s.roughness / (side * side);
  }
  return mean;
}

TEST(Procedural, TheFootprintsValueIsTheMeanOverIt) {
  // Root mean square error and mean error of the filtered albedo against the mean of 1024 points of
  // its square, for squares from half a detail to 20 details wide; roughness likewise.
  for (const ProceduralCase& c : procedural_cases()) {
    Draws draw;
    for (const float details : {0.5f, 1.5f, 5.0f, 20.0f}) {
      const float width = details * c.unit;
      constexpr int kSquares = 60;
      double squares = 0, bias = 0, rough = 0;
      for (int i = 0; i < kSquares; ++i) {
        const Vec3f p{draw(-4, 4), draw(-4, 4), draw(-4, 4)};
        const AreaMean mean = mean_over_square(c.d, p, width, 32, &draw);
        const ProceduralSample s = sample_at(c.d, p, width);
        squares += sqr(static_cast<float>(tone(s) - mean.tone)) / kSquares;
        bias += (tone(s) - mean.tone) / kSquares;
        rough += (s.roughness - mean.roughness) / kSquares;
      }
      EXPECT_LT(std::sqrt(squares), 0.04) << c.name << ", " << width << " m";
      EXPECT_NEAR(bias, 0, 0.012) << c.name << ", " << width << " m";
      EXPECT_NEAR(rough, 0, 0.015) << c.name << ", " << width << " m";
    }
  }
}

TEST(Procedural, FarAwayOnlyTheMeanIsLeft) {
  // Spread of filtered values over places: falls with the footprint, to nothing.
  for (const ProceduralCase& c : procedural_cases()) {
    double before = 1e9, mean = 0;
    for (const float width : {0.0f, 3 * c.unit, 12 * c.unit, 60 * c.unit, 100.0f}) {
      Draws draw;
      double sum = 0, squares = 0;
      constexpr int kPlaces = 4000;
      for (int i = 0; i < kPlaces; ++i) {
        const double t = tone(sample_at(c.d, {draw(-50, 50), draw(-50, 50), draw(-50, 50)}, width));
        sum += t;
        squares += t * t;
      }
      const double variance =
          std::max(0.0, squares / kPlaces - sqr(static_cast<float>(sum / kPlaces)));
      EXPECT_LE(variance, before * 1.05 + 1e-6) << c.name << ", " << width << " m";
      before = variance;
      if (width == 0) mean = sum / kPlaces;
      if (width == 100.0f) {
        EXPECT_LT(std::sqrt(variance), 1e-3) << c.name;
        EXPECT_NEAR(sum / kPlaces, mean, 0.012) << c.name;
      }
    }
  }
}

TEST(Procedural, ReliefComesWithItsGradient) {
  for (const ProceduralCase& c : procedural_cases()) {
    for (const float footprint : {0.0f, 0.4f * c.unit}) {
      Draws draw;
      double squares = 0;
      std::vector<double> errors;
      constexpr float kStep = 1.0f / 65536;
      for (int i = 0; i < 2000; ++i) {
        const Vec3f p{draw(-0.4f, 0.4f), draw(-0.4f, 0.4f), draw(-0.4f, 0.4f)};
        const Vec3f g = sample_at(c.d, p, footprint).relief.gradient;
        const auto slope = [&](Vec3f along) {
          return (static_cast<double>(sample_at(c.d, p + along * kStep, footprint).relief.value) -
                  sample_at(c.d, p - along * kStep, footprint).relief.value) /
                 (2.0 * kStep);
        };
        const double ex = slope({1, 0, 0}) - g.x, ez = slope({0, 0, 1}) - g.z;
        squares += (sqr(g.x) + sqr(g.z)) / 2000;
        errors.push_back(std::sqrt(ex * ex + ez * ez));
      }
      std::sort(errors.begin(), errors.end());
      // One in ten may sit on a border, where slopes break.
      const double rms = std::sqrt(squares);
      EXPECT_LT(errors[1800], 0.06 * rms + 2e-4) << c.name << ", footprint " << footprint;
    }
  }
}

TEST(Procedural, ReliefHasNoSteps) {
  // 0.2 m in steps of 4 µm: no step is steeper than a wall of 75 degrees. Boards end sharply.
  for (const ProceduralCase& c : procedural_cases()) {
    float before = 0, largest = 0;
    for (int i = 0; i < 50000; ++i) {
      const float x = 0.05f + 4e-6f * static_cast<float>(i);
      const float h = sample_at(c.d, {x, 0.3f, 0.7f * x}, 0).relief.value;
      if (i > 0) largest = max(largest, fabsf(h - before));
      before = h;
    }
    EXPECT_LT(largest, c.d.kind == ProceduralKind::kWood ? 6e-5f : 1.9e-5f) << c.name;
  }
}

TEST(Procedural, SamplesAreFiniteInRangeAndRepeatable) {
  const float nan = std::nanf("");
  const Vec3f normals[] = {
      {0, 0, 1}, {0, 0, 0}, {nan, nan, nan}, {1, 0, 0}, {0.577f, 0.577f, 0.577f}, {1e-20f, 0, 0}};
  for (const ProceduralCase& c : procedural_cases()) {
    Draws draw;
    for (int i = 0; i < 3000; ++i) {
      const float reach = i % 3 == 0 ? 1.0f : (i % 3 == 1 ? 100.0f : 1e4f);
      ProceduralPoint at;
      at.p = {draw(-reach, reach), draw(-reach, reach), draw(-reach, reach)};
      if (i % 50 == 0) at.p = {0, 0, 0};
      if (i % 77 == 0) at.p.x = 1e30f;
      at.n = normals[i % 6];
      at.footprint = i % 4 == 0 ? 0.0f : (i % 4 == 1 ? 1e-3f : (i % 4 == 2 ? 0.3f : 1e6f));
      at.convexity = draw(-1, 1);
      at.height = draw(-0.1f, 3);
      const ProceduralSample s = eval_procedural(c.d, at), again = eval_procedural(c.d, at);
      ASSERT_EQ(memcmp(&s, &again, sizeof s), 0) << c.name;
      for (const float x : {s.base_color.x, s.base_color.y, s.base_color.z, s.roughness, s.metallic,
                            s.coat_weight, s.coat_roughness, s.fuzz, s.mask}) {
        ASSERT_TRUE(x >= 0 && x <= 1) << c.name << ": " << x << " at " << at.p.x << " " << at.p.y
                                      << " " << at.p.z << ", footprint " << at.footprint;
      }
      for (const float x :
           {s.relief.value, s.relief.gradient.x, s.relief.gradient.y, s.relief.gradient.z}) {
        ASSERT_TRUE(std::isfinite(x) && fabsf(x) < 1000) << c.name << ": " << x;
      }
    }
  }
}

TEST(Procedural, AnotherSeedIsAnotherPattern) {
  for (ProceduralCase c : procedural_cases()) {
    Draws draw;
    int same = 0;
    for (int i = 0; i < 200; ++i) {
      const Vec3f p{draw(-2, 2), draw(-2, 2), draw(-2, 2)};
      const double first = tone(sample_at(c.d, p, 0.0f));
      ProceduralDescription other = c.d;
      other.seed = 12345;
      same += first == tone(sample_at(other, p, 0.0f));
    }
    // Scratched steel is bare over most of its surface.
    EXPECT_LT(same, c.d.kind == ProceduralKind::kScratches ? 190 : 60) << c.name;
  }
}

/// Black and white units without wear: their share is geometry.
ProceduralDescription plain_units(ProceduralKind kind) {
  ProceduralDescription d = default_procedural(kind);
  d.color_a = d.color_b = {1, 1, 1};
  d.color_c = {0, 0, 0};
  d.variation = d.amount = 0;
  return d;
}
double mean_tone(const ProceduralDescription& d, float footprint) {
  Draws draw;
  double sum = 0;
  constexpr int kPlaces = 200000;
  for (int i = 0; i < kPlaces; ++i)
    sum += tone(sample_at(d, {draw(-9, 9), 0.1f, draw(-9, 9)}, footprint));
  return sum / kPlaces;
}

TEST(Procedural, MortarAndGroutTakeTheShareOfTheirJoints) {
  ProceduralDescription brick = plain_units(ProceduralKind::kBrick);
  const double stretchers = 0.215 * 0.065 / (0.225 * 0.075);
  for (const float footprint : {0.0f, 0.02f, 0.2f, 5.0f}) {
    brick.bond = BrickBond::kRunning;
    EXPECT_NEAR(mean_tone(brick, footprint), stretchers, 0.004) << footprint;
    brick.bond = BrickBond::kStack;
    EXPECT_NEAR(mean_tone(brick, footprint), stretchers, 0.004) << footprint;
    brick.bond = BrickBond::kEnglish;  // half the rows are headers of (215 - 10) / 2 mm
    EXPECT_NEAR(mean_tone(brick, footprint), 0.5 * (0.215 + 0.205) * 0.065 / (0.225 * 0.075), 0.004)
        << footprint;
    ProceduralDescription tiles = plain_units(ProceduralKind::kTiles);
    EXPECT_NEAR(mean_tone(tiles, footprint), 0.15 * 0.15 / (0.153 * 0.153), 0.004) << footprint;
    tiles.tile = TileShape::kHexagon;
    EXPECT_NEAR(mean_tone(tiles, footprint), 0.15 * 0.15 / (0.153 * 0.153), 0.004) << footprint;
  }
}

TEST(Procedural, BricksMeasureWhatTheyShould) {
  // Along the middle of a row, and up the middle of a brick: joints per metre and their widths.
  ProceduralDescription brick = plain_units(ProceduralKind::kBrick);
  brick.bond = BrickBond::kStack;
  const auto count = [&](Vec3f from, Vec3f along, double* joint) {
    int borders = 0;
    double dark = 0, before = 1;
    constexpr int kSteps = 180000;
    for (int i = 0; i < kSteps; ++i) {
      const double t = tone(sample_at(brick, from + along * (9.0f * i / kSteps), 0));
      dark += 1 - t;
      borders += (t < 0.5) && (before >= 0.5);
      before = t;
    }
    *joint = dark / kSteps * 9.0 / borders;
    return borders;
  };
  double joint = 0;
  EXPECT_EQ(count({0.1f, 0, 0.0375f}, {1, 0, 0}, &joint), 40);  // 9 m / 225 mm
  EXPECT_NEAR(joint, 0.010, 0.0004);
  EXPECT_EQ(count({0.1125f, 0, 0.0375f}, {0, 0, 1}, &joint), 120);  // 9 m / 75 mm
  EXPECT_NEAR(joint, 0.010, 0.0004);
}

TEST(Procedural, DirtGathersInCornersNearTheFloorAndOnTop) {
  const ProceduralDescription d = default_procedural(ProceduralKind::kDirt);
  const auto cover = [&](float convexity, float height, Vec3f n, float amount) {
    ProceduralDescription with = d;
    with.amount = amount;
    Draws draw;
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      ProceduralPoint at{{draw(-9, 9), draw(-9, 9), draw(-9, 9)}, n, 0, convexity, height};
      sum += eval_procedural(with, at).mask / 2000;
    }
    return sum;
  };
  const double flat = cover(0, 2, kWall, 0.3f);
  EXPECT_GT(cover(-0.8f, 2, kWall, 0.3f), flat + 0.1);
  EXPECT_LT(cover(0.8f, 2, kWall, 0.3f), 0.5 * flat);
  EXPECT_GT(cover(0, 0.05f, kWall, 0.3f), flat + 0.1);
  EXPECT_GT(cover(0, 2, {0, 0, 1}, 0.3f), flat + 0.02);
  EXPECT_EQ(cover(-1, 0, {0, 0, 1}, 0), 0);
  EXPECT_GT(cover(1, 2, {0, 0, -1}, 1), 0.99);
}

TEST(Procedural, ScratchesRunAlongTheirAxis) {
  ProceduralDescription d = default_procedural(ProceduralKind::kScratches);
  d.variation = 0;
  // The mask changes less along the scratches than across them.
  Draws draw;
  double along = 0, across = 0;
  for (int i = 0; i < 50000; ++i) {
    const Vec3f p{draw(-2, 2), 0, draw(-2, 2)};
    const float here = sample_at(d, p, 0).mask;
    along += fabsf(sample_at(d, p + Vec3f{0.001f, 0, 0}, 0).mask - here);
    across += fabsf(sample_at(d, p + Vec3f{0, 0, 0.001f}, 0).mask - here);
  }
  EXPECT_GT(across, 8 * along);
  EXPECT_GT(across, 0);
}

}  // namespace
}  // namespace gloam
