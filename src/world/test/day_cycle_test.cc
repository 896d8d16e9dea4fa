// A sky whose clock runs: where its sun is, and which skies it has.

#include "world/sky/day_cycle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

using visual_test::expect_near;

const GeoPosition kMunich{48.14, 11.58};

TEST(DayCycle, TheSunIsWhereTheClockSaysHoursAndDaysLater) {
  const DayCycle day{{2026, 6, 30, 22, 0, 0, 2}, kMunich, 3600};
  for (const auto& [seconds, clock] :
       {std::pair{0.0, CivilTime{2026, 6, 30, 22, 0, 0, 2}},
        std::pair{8.5, CivilTime{2026, 7, 1, 6, 30, 0, 2}},
        std::pair{2 + 24 * 184.0, CivilTime{2027, 1, 1, 0, 0, 0, 2}}}) {
    const auto sun = sun_position(clock, kMunich);
    ASSERT_TRUE(sun.ok());
    expect_near(to_sun_at(day, seconds), sun->to_sun, 1e-5f);
  }
}

TEST(DayCycle, NorthTurnsTheSun) {
  DayCycle day{{2026, 6, 21, 13, 15, 0, 2}, kMunich, 1};
  const Vec3f south = to_sun_at(day, 0);
  EXPECT_LT(south.y, -0.3f);
  day.north = -M_PI / 2;  // north is +X, so south is -X
  expect_near(to_sun_at(day, 0), {south.y, -south.x, south.z}, 1e-5f);
}

TEST(DayCycle, ItsSkiesLieAQuarterOfADegreeApartWhereLightChangesFast) {
  for (int row = 0; row < sky_count(); ++row) {
    EXPECT_NEAR(sky_row(sky_elevation(row)), row, 1e-9);
    if (row == 0) continue;
    const double step = (sky_elevation(row) - sky_elevation(row - 1)) / kDegree;
    EXPECT_NEAR(step, sky_elevation(row) < 6.1 * kDegree ? 0.25 : 1, 1e-9) << row;
  }
  EXPECT_EQ(sky_row(-90 * kDegree), 0) << "the night";
  EXPECT_EQ(sky_row(91 * kDegree), sky_count() - 1);
}

/// Of level ground by sky and sun [lx], the sun being `elevation` [deg] high.
double ground_light(double elevation) {
  DayCycle day{{2026, 6, 21, 12, 0, 0, 2}, kMunich, 1};
  day.air.width = 64, day.air.height = 32;
  const int row = static_cast<int>(std::lround(sky_row(elevation * kDegree)));
  const SkyLight sky = sky_of_row(day, row);
  for (const Vec3f& t : sky.texels) {
    EXPECT_TRUE(std::isfinite(t.x + t.y + t.z) && t.x >= 0 && t.y >= 0 && t.z >= 0);
  }
  return luminance(sky.sky_illuminance) +
         luminance(sky.sun_illuminance) * std::max(0.0, std::sin(sky_elevation(row)));
}

// Illuminance of the ground in twilight and by day (Seidelmann 1992, "Explanatory supplement to the
// astronomical almanac", table 9.3, clear skies).
TEST(DayCycle, TheGroundIsAsBrightAsTablesSayFromNoonToNight) {
  EXPECT_NEAR(std::log10(ground_light(60)), std::log10(102e3), 0.1);
  EXPECT_NEAR(std::log10(ground_light(20)), std::log10(31e3), 0.12);
  EXPECT_NEAR(std::log10(ground_light(5)), std::log10(4.8e3), 0.2);
  EXPECT_NEAR(std::log10(ground_light(0)), std::log10(600.0), 0.3);
  EXPECT_NEAR(std::log10(ground_light(-6)), std::log10(3.4), 0.5);
  EXPECT_NEAR(ground_light(-18), M_PI * 2e-4, 2e-4) << "stars and airglow";
}

CompiledWorld world_under(SkyOptions sky) {
  CompiledWorld world = visual_test::compile(
      "<mujoco><worldbody><geom type='plane' size='9 9 1'/></worldbody></mujoco>");
  world.scene.sky = std::move(sky);
  return world;
}
SkyOptions evening(double speed) {
  SkyOptions sky{.date = CalendarDate{2026, 6, 21},
                 .time = ClockTime{19, 0, 0},
                 .utc_offset = 2,
                 .latitude = 48.14,
                 .longitude = 11.58};
  sky.speed = speed;
  return sky;
}

TEST(DayCycle, AClockThatStandsStillIsASkyThatStandsStill) {
  const RenderDescription still = visual_test::describe(world_under(evening(0)));
  EXPECT_FALSE(still.sky.day.has_value());
  EXPECT_TRUE(still.lights.back().is_static);
  const RenderDescription moving = visual_test::describe(world_under(evening(60)));
  ASSERT_TRUE(moving.sky.day.has_value());
  EXPECT_FALSE(moving.lights.back().is_static);
  EXPECT_EQ(moving.ev100, still.ev100) << "exposed for its begin";
  expect_near(to_sun_at(*moving.sky.day, 0), moving.lights.back().X_BL.z, 1e-6f);
}

TEST(DayCycle, ASunThatIsYetToRiseIsThere) {
  SkyOptions night = evening(3600);
  night.time = ClockTime{2, 0, 0};
  const RenderDescription d = visual_test::describe(world_under(night));
  ASSERT_EQ(d.lights.size(), 1u);
  EXPECT_EQ(d.lights[0].name, "sun");
  EXPECT_EQ(luminance(d.lights[0].intensity), 0);
  EXPECT_TRUE(std::isfinite(d.ev100));
}

}  // namespace
}  // namespace gloam
