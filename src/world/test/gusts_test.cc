// Gusts: how far they carry what is in the air, against sums over time.

#include "world/weather/gusts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gloam {
namespace {

Gusts gusty() {
  WindDescription wind;
  wind.speed = 10, wind.gusts = 2, wind.along_x = 0.6, wind.along_y = 0.8, wind.seed = 3;
  return Gusts(wind);
}

double size_of(Vec3 v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

TEST(Gusts, CarryAsFarAsTheirVelocitySumsUpTo) {
  const Gusts gusts = gusty();
  constexpr double kStep = 1e-3;
  Vec3 sum{};
  for (int i = 0; i < 60000; ++i) {
    const Vec3 v = gusts.at((i + 0.5) * kStep);
    sum = {sum.x + v.x * kStep, sum.y + v.y * kStep, sum.z + v.z * kStep};
    if (i % 10000 != 9999) continue;
    const Vec3 way = gusts.way((i + 1) * kStep, 0);
    EXPECT_LT(size_of({way.x - sum.x, way.y - sum.y, way.z - sum.z}), 1e-3) << i;
    EXPECT_GT(size_of(way), 0.5) << i;
  }
  EXPECT_EQ(size_of(gusts.way(0, 0.3)), 0);
}

// v' = (u - v) / lag, from long before.
TEST(Gusts, CarryWhatIsHeavyLaterAndLess) {
  const Gusts gusts = gusty();
  constexpr double kStep = 1e-4, kLag = 0.8;
  Vec3 v = gusts.carry(100, kLag), way{};
  double fast = 0, slow = 0;
  for (int i = 0; i < 200000; ++i) {
    const double time = 100 + i * kStep;
    const Vec3 u = gusts.at(time + kStep / 2);
    const double share = kStep / kLag;
    v = {v.x + (u.x - v.x) * share, v.y + (u.y - v.y) * share, v.z + (u.z - v.z) * share};
    way = {way.x + v.x * kStep, way.y + v.y * kStep, way.z + v.z * kStep};
    fast += u.x * u.x, slow += v.x * v.x;
    if (i % 50000 != 49999) continue;
    const Vec3 now = gusts.carry(time + kStep, kLag);
    EXPECT_LT(size_of({now.x - v.x, now.y - v.y, now.z - v.z}), 2e-3) << time;
    const Vec3 to = gusts.way(time + kStep, kLag), from = gusts.way(100, kLag);
    EXPECT_LT(size_of({to.x - from.x - way.x, to.y - from.y - way.y, to.z - from.z - way.z}), 5e-3)
        << time;
  }
  EXPECT_LT(slow, 0.95 * fast);
}

}  // namespace
}  // namespace gloam
