// Metrics of pictures, depths and scans against numbers that are known beforehand.

#include "runtime/recording/sensing_metrics.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>

namespace gloam {
namespace {

std::map<std::string, double> numbers_of(const SensingMetrics& metrics) {
  const auto list = metrics.summary();
  return {list.begin(), list.end()};
}

/// Columns of 4 pixels in two greys in turn: neighbours four apart differ along rows alone.
CameraFrame striped(uint8_t dark, uint8_t bright) {
  CameraFrame frame;
  frame.intrinsics.width = 64;
  frame.intrinsics.height = 32;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      frame.rgb.insert(frame.rgb.end(), 3, x / 4 % 2 == 0 ? dark : bright);
  return frame;
}

TEST(SensingMetrics, ContrastIsThatOfTheLogarithm) {
  SensingMetrics metrics;
  CameraQuality* eye = metrics.add_camera("eye");
  eye->add(striped(100, 100));
  EXPECT_NEAR(numbers_of(metrics)["eye.contrast"], 0, 1e-6);
  SensingMetrics other;
  other.add_camera("eye")->add(striped(64, 255));
  // sRGB 64 is 0.0513 of white; a hundredth of the mean, 0.0053, is added to both. One of the two
  // directions differs.
  const double log_ratio = std::log((1 + 0.005256) / (0.05126 + 0.005256));
  EXPECT_NEAR(numbers_of(other)["eye.contrast"], log_ratio / std::sqrt(2), 0.005);
}

TEST(SensingMetrics, DepthIsComparedWhereThereIsSomething) {
  CameraFrame frame;
  frame.depth = {2, 4, 10, std::numeric_limits<float>::infinity()};
  frame.sensor_depth = {2.2f, 0, 9, 5};
  SensingMetrics metrics;
  metrics.add_camera("rgbd")->add(frame);
  const auto numbers = numbers_of(metrics);
  EXPECT_NEAR(numbers.at("rgbd.depth_measured_percent"), 100.0 * 2 / 3, 1e-9);
  EXPECT_NEAR(numbers.at("rgbd.depth_error_percent"), 10, 1e-4);
  EXPECT_EQ(numbers.count("rgbd.contrast"), 0u);
}

TEST(SensingMetrics, HeatAndEventsAreCounted) {
  CameraFrame frame;
  frame.intrinsics.width = 8;
  frame.intrinsics.height = 1;
  frame.thermal = {290, 290, 290, 290, 293, 293, 293, 293};
  frame.events.resize(5);
  SensingMetrics metrics;
  CameraQuality* hot = metrics.add_camera("hot");
  hot->add(frame);
  frame.events.clear();
  hot->add(frame);
  const auto numbers = numbers_of(metrics);
  EXPECT_NEAR(numbers.at("hot.thermal_contrast_K"), 3, 1e-6);
  EXPECT_EQ(numbers.at("hot.events_per_frame"), 2.5);
}

TEST(SensingMetrics, ReturnsAreFirstOnesAndFalseOnesAreMedias) {
  LidarScan scan;
  scan.beams = 8;
  scan.return_number = {0, 1, 0, 0};
  scan.x = scan.y = scan.z = {0, 0, 0, 0};
  scan.part = {3, 0, 0, 5};
  SensingMetrics metrics;
  metrics.add_lidar("roof")->add(scan);
  auto numbers = numbers_of(metrics);
  EXPECT_EQ(numbers["roof.returns_percent"], 100.0 * 3 / 8);
  EXPECT_EQ(numbers["roof.false_returns_percent"], 100.0 / 8);
  scan.part.clear();
  SensingMetrics blind;
  blind.add_lidar("roof")->add(scan);
  EXPECT_EQ(numbers_of(blind).count("roof.false_returns_percent"), 0u);
  EXPECT_TRUE(SensingMetrics().summary().empty());
}

}  // namespace
}  // namespace gloam
