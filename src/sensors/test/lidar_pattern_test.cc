// Where and when beams go: presets against their manuals' tables, directions of rotation, rosettes.

#include "sensors/lidar/lidar_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "scene/options/lidar_names.h"
#include "sensors/lidar/lidar_presets.h"

namespace gloam {
namespace {

constexpr double kDegrees = 180 / M_PI;

LidarModel model_of(const std::string& preset, const LidarOptions& more = {}) {
  LidarOptions options = more;
  options.name = "l";
  options.preset = preset;
  Result<LidarModel> model = make_lidar_model(options);
  EXPECT_TRUE(model.ok()) << preset;
  return *model;
}
std::vector<LidarFiring> fire(const LidarModel& model, int64_t scan = 0) {
  return lidar_pattern(model.pattern).fire(model, scan);
}
double elevation(const LidarFiring& f) {
  return kDegrees * std::atan2(f.d.z, std::hypot(f.d.x, f.d.y));
}
double azimuth(const LidarFiring& f) { return kDegrees * std::atan2(f.d.y, f.d.x); }

TEST(LidarPresets, EveryWordOfTheSceneFileIsAPreset) {
  for (const std::string_view name : kLidarPresets) {
    EXPECT_NE(find_lidar_preset(name), nullptr) << name;
    EXPECT_GT(fire(model_of(std::string(name))).size(), 1000u) << name;
  }
  EXPECT_EQ(find_lidar_preset("VLP-61"), nullptr);
}

TEST(LidarPresets, RingsHaveTheAnglesOfTheManuals) {
  const auto ring = [](const char* preset, int ring) {
    for (const LidarFiring& f : fire(model_of(preset))) {
      if (f.ring == ring) return elevation(f);
    }
    return 1e9;
  };
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(ring("VLP-16", i), -15 + 2 * i, 1e-4);
  EXPECT_NEAR(ring("HDL-32E", 0), -30.67, 0.01);
  EXPECT_NEAR(ring("HDL-32E", 15), -10.67, 0.01);
  EXPECT_NEAR(ring("HDL-32E", 16), -9.33, 0.01);
  EXPECT_NEAR(ring("HDL-32E", 23), 0, 0.01);
  EXPECT_NEAR(ring("HDL-32E", 31), 10.67, 0.01);
  EXPECT_NEAR(ring("HDL-64E", 0), -24.33, 1e-3);
  EXPECT_NEAR(ring("HDL-64E", 31) - ring("HDL-64E", 30), 0.5, 1e-3);
  EXPECT_NEAR(ring("HDL-64E", 63), 2, 1e-3);
  EXPECT_NEAR(ring("HDL-64E", 63) - ring("HDL-64E", 62), 1.0 / 3, 1e-3);
  EXPECT_NEAR(ring("OS1-64", 0), -16.6, 1e-3);
  EXPECT_NEAR(ring("OS1-64", 63), 16.6, 1e-3);
  EXPECT_NEAR(ring("OS1-128", 127), 22.5, 1e-3);
  EXPECT_EQ(model_of("OS1-128").elevations.size(), 128u);
}

TEST(LidarPresets, LasersFireInTheOrderOfTheManuals) {
  const std::vector<LidarFiring> vlp = fire(model_of("VLP-16"));
  const double order[] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(elevation(vlp[static_cast<size_t>(i)]), order[i], 1e-4);
  const std::vector<LidarFiring> hdl = fire(model_of("HDL-32E"));
  EXPECT_NEAR(elevation(hdl[1]), -9.33, 0.01);
  EXPECT_NEAR(elevation(hdl[2]), -29.33, 0.01);
  EXPECT_NEAR(elevation(hdl[31]), 10.67, 0.01);
}

TEST(LidarSpinning, TurnsClockwiseFromBehindUnlessToldOtherwise) {
  const auto quarter = [](bool clockwise) {
    LidarOptions options;
    options.clockwise = clockwise;
    options.elevations = {{0}};
    const std::vector<LidarFiring> firings = fire(model_of("OS1-64", options));
    EXPECT_NEAR(std::abs(azimuth(firings[0])), 180, 1e-3);
    EXPECT_NEAR(azimuth(firings[512]), 0, 1e-3);
    EXPECT_NEAR(firings[512].time, 0.5, 1e-6);
    return azimuth(firings[256]);
  };
  EXPECT_NEAR(quarter(true), 90, 1e-3);  // from behind over the left side
  EXPECT_NEAR(quarter(false), -90, 1e-3);
}

TEST(LidarSpinning, TheHeadTurnsOnWhileItsLasersFire) {
  const std::vector<LidarFiring> f = fire(model_of("VLP-16"));
  // 34.56 us after the first at 10 turns a second.
  EXPECT_NEAR(azimuth(f[0 + 16]) - azimuth(f[15 + 16]), 360 * 10 * 15 * 2.304e-6, 1e-4);
}

TEST(LidarSpinning, ASectorHoldsItsColumnsAlone) {
  LidarOptions options;
  options.azimuth = {{-30, 60}};
  const std::vector<LidarFiring> f = fire(model_of("OS1-64", options));
  EXPECT_NEAR(static_cast<double>(f.size()) / 64, 1024 * 90.0 / 360, 1.01);
  for (const LidarFiring& firing : f) {
    EXPECT_GT(azimuth(firing), -30.01);
    EXPECT_LT(azimuth(firing), 60.01);
  }
}

TEST(LidarGrid, CoversItsFieldEvenly) {
  LidarOptions options;
  options.pattern = "raster";
  options.rows = 4;
  options.columns = 10;
  options.field_of_view = {{50, 20}};
  LidarModel model = model_of("OS1-64", options);
  std::vector<LidarFiring> f = fire(model);
  ASSERT_EQ(f.size(), 40u);
  EXPECT_NEAR(azimuth(f[0]), 22.5, 1e-4);  // the left column first
  EXPECT_NEAR(elevation(f[0]), -7.5, 1e-4);
  EXPECT_NEAR(azimuth(f[39]), -22.5, 1e-4);
  EXPECT_NEAR(f[20].time, 0.5, 1e-6);
  model.pattern = LidarPatternKind::kFlash;
  f = fire(model);
  for (const LidarFiring& firing : f) EXPECT_EQ(firing.time, 0);

  options.rows.reset();
  options.name = "l";
  EXPECT_FALSE(make_lidar_model(options).ok()) << "a grid needs its numbers";
  options.pattern = "rosette";
  EXPECT_FALSE(make_lidar_model(options).ok()) << "so does a rosette";
}

TEST(LidarModelOf, RefusesWhatDoesNotGoTogether) {
  const auto error_of = [](LidarOptions options) {
    options.name = "l";
    const Result<LidarModel> model = make_lidar_model(options);
    return model.ok() ? std::string() : model.error().to_string();
  };
  EXPECT_EQ(error_of({}), "");
  EXPECT_NE(error_of({.preset = "Mid-40", .pattern = "spinning"}).find("elevations"),
            std::string::npos);
  // The preset's other end of the range.
  EXPECT_NE(error_of({.max_range = 0.1}).find("min_range"), std::string::npos);
  LidarOptions dense{.pattern = "raster"};
  dense.rows = 4096;
  dense.columns = 65535;
  dense.field_of_view = {{60, 60}};
  EXPECT_NE(error_of(dense).find("the limit"), std::string::npos);
}

TEST(LidarRosette, StaysInItsFieldAndFillsItOverTime) {
  const LidarModel model = model_of("Mid-40");
  // Cells of half a degree that have been looked at.
  std::set<std::pair<int, int>> cells;
  double share[2] = {}, widest = 0;
  for (int scan = 0; scan < 10; ++scan) {
    for (const LidarFiring& f : fire(model, scan)) {
      const double left = kDegrees * std::atan2(f.d.y, f.d.x), up = elevation(f);
      const double bend = kDegrees * std::acos(std::min(1.0, static_cast<double>(f.d.x)));
      widest = std::max(widest, bend);
      cells.insert({static_cast<int>(std::floor(2 * left)), static_cast<int>(std::floor(2 * up))});
    }
    const double all = M_PI * 38.4 * 38.4;  // cells of the circle
    if (scan == 0) share[0] = static_cast<double>(cells.size()) / all;
    if (scan == 9) share[1] = static_cast<double>(cells.size()) / all;
  }
  EXPECT_LE(widest, 19.2001);
  EXPECT_GT(widest, 19.1);
  EXPECT_LT(share[0], 0.75);
  EXPECT_GT(share[1], 0.93);
}

}  // namespace
}  // namespace gloam
