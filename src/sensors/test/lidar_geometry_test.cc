// Where LiDAR points are: against closed forms.

#include <algorithm>
#include <cmath>

#include "sensors/test/lidar_scene.h"

namespace gloam {
namespace {

/// Distance along d from p inside the box [-h, h] to its wall, in double.
double to_box_wall(Vec3f h, Vec3f p, Vec3f d) {
  double nearest = 1e30;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) continue;
    const double wall = d[k] > 0 ? h[k] : -h[k];
    nearest = std::min(nearest, (wall - static_cast<double>(p[k])) / static_cast<double>(d[k]));
  }
  return nearest;
}

SceneBuilder box_room(Vec3f h) {
  SceneBuilder b;
  const int white = b.add_diffuse({0.5f, 0.5f, 0.5f});
  for (int k = 0; k < 3; ++k) {
    for (const float side : {-1.0f, 1.0f}) {
      Vec3f half{h.x + 1, h.y + 1, h.z + 1}, p;
      (k == 0 ? half.x : k == 1 ? half.y : half.z) = 0.5f;
      (k == 0 ? p.x : k == 1 ? p.y : p.z) = side * (h[k] + 0.5f);
      add_wall(&b, half, p, white);
    }
  }
  return b;
}

TEST(LidarGeometry, WhatColourPicturesAloneShowIsNotMet) {
  SceneBuilder b;
  const int white = b.add_diffuse({0.5f, 0.5f, 0.5f});
  add_wall(&b, {0.1f, 5, 5}, {10.1f, 0, 0}, white);
  add_wall(&b, {0.1f, 5, 5}, {4.1f, 0, 0}, white);
  b.description.instances.back().color_only = true;
  const auto scan = scan_scene(b, pencil());
  ASSERT_EQ(scan->x.size(), 1u);
  EXPECT_NEAR(scan->range[0], 10, 1e-3);
  EXPECT_NEAR(scan->intensity[0], 50, 1) << "nothing is lost on the way";
}

TEST(LidarGeometry, EveryBeamOfEveryPresetMeasuresABoxRoom) {
  const Vec3f h{6, 4, 3};
  const SceneBuilder room = box_room(h);
  for (const char* preset : {"VLP-16", "HDL-32E", "OS1-64", "HDL-64E", "OS1-128", "Mid-40"}) {
    LidarOptions options = ideal_lidar(preset);
    options.position = {1.5, -0.7, 0.4};
    options.orientation = {std::cos(0.35), 0, 0, std::sin(0.35)};  // 0.7 rad about z
    const auto scan = scan_scene(room, options);
    ASSERT_EQ(scan->size(), static_cast<size_t>(scan->beams)) << preset;
    const Affine3f X_WL = rigid({0, 0, 1}, 0.7f, {1.5f, -0.7f, 0.4f});
    double worst = 0;
    for (size_t i = 0; i < scan->size(); ++i) {
      const Vec3f d = normalize(transform_vector(X_WL, point(*scan, i)));
      const double wanted = to_box_wall(h, X_WL.p, d);
      worst = std::max(worst, std::abs(scan->range[i] / wanted - 1));
      ASSERT_NEAR(length(point(*scan, i)), scan->range[i], 1e-5f * scan->range[i]);
    }
    EXPECT_LT(worst, 1e-5) << preset;
  }
}

TEST(LidarGeometry, NothingIsSeenOutsideTheRangeOfTheSensor) {
  LidarOptions options = ideal_lidar();
  const SceneBuilder room = box_room({6, 4, 3});
  options.max_range = 4.5;
  options.min_range = 4.1;
  const auto scan = scan_scene(room, options);
  ASSERT_GT(scan->size(), 0u);
  ASSERT_LT(scan->size(), static_cast<size_t>(scan->beams));
  for (const float range : scan->range) {
    EXPECT_GE(range, 4.1f);
    EXPECT_LE(range, 4.5f);
  }
}

/// Sensor on body 1 (or the world) and a wall whose near side is at x = 10, instants `n` stretches
/// apart over 0.1 s.
struct Motion {
  Vec3f v;             ///< of body 1 [m/s]
  float yaw_rate = 0;  ///< [rad/s]
  Vec3f wall_v;        ///< of the wall's body [m/s]
};
std::vector<PoseFrame> instants(const SceneBuilder& scene, const Motion& motion, int n) {
  std::vector<PoseFrame> keys(static_cast<size_t>(n) + 1, scene.frame);
  for (int k = 0; k <= n; ++k) {
    PoseFrame& key = keys[static_cast<size_t>(k)];
    const float t = 0.1f * static_cast<float>(k) / static_cast<float>(n);
    key.time = 5 + 0.1 * k / n;
    SceneBuilder::set_body(&key, 1, rigid({0, 0, 1}, motion.yaw_rate * t, motion.v * t));
    SceneBuilder::set_body(&key, 2, translation(Vec3f{10.5f, 0, 0} + motion.wall_v * t));
  }
  return keys;
}
SceneBuilder wall_ahead() {
  SceneBuilder b;
  b.add_body({});
  const int wall = b.add_body(translation({10.5f, 0, 0}));
  b.add(ShapeType::kBox, {0.5f, 200, 200}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}), wall);
  return b;
}
LidarOptions forward_lidar() {
  LidarOptions options = ideal_lidar();
  options.azimuth = {{-60, 60}};
  return options;
}

TEST(LidarMotion, AMovingSensorSeesTheWallWhereItIsAtEachFiring) {
  const SceneBuilder b = wall_ahead();
  const Motion motion{.v = {8, 3, 0}};
  const auto scan = scan_scene(b, forward_lidar(), 1, instants(b, motion, 1));
  ASSERT_EQ(scan->size(), static_cast<size_t>(scan->beams));
  double spread = 0;
  for (size_t i = 0; i < scan->size(); ++i) {
    // The cloud is as a driver hands it out: each point in the frame of its own time.
    const double wanted = 10 - 8.0 * scan->time[i];
    EXPECT_NEAR(scan->x[i], wanted, 1e-4 * wanted);
    spread = std::max(spread, std::abs(scan->x[i] - 10.0));
  }
  EXPECT_GT(spread, 0.5) << "this test is about motion";
}

TEST(LidarMotion, AMovingWallIsSeenWhereItIsAtEachFiring) {
  const SceneBuilder b = wall_ahead();
  const auto scan = scan_scene(b, forward_lidar(), 0, instants(b, {.wall_v = {-12, 0, 0}}, 3));
  ASSERT_EQ(scan->size(), static_cast<size_t>(scan->beams));
  for (size_t i = 0; i < scan->size(); ++i) {
    const double wanted = 10 - 12.0 * scan->time[i];
    EXPECT_NEAR(scan->x[i], wanted, 1e-4 * wanted);
  }
}

TEST(LidarMotion, ATurningSensorSeesTheWallTurned) {
  const SceneBuilder b = wall_ahead();
  const float w = 4;  // [rad/s]
  const auto scan = scan_scene(b, forward_lidar(), 1, instants(b, {.yaw_rate = w}, 1));
  ASSERT_GT(scan->size(), 1000u);
  for (size_t i = 0; i < scan->size(); ++i) {
    const double yaw = w * scan->time[i];
    const double x_W = scan->x[i] * std::cos(yaw) - scan->y[i] * std::sin(yaw);
    EXPECT_NEAR(x_W, 10, 1e-4 * scan->range[i]);
  }
}

TEST(LidarMotion, ADeskewedCloudLiesOnTheWallInTheFrameAtTheEnd) {
  const SceneBuilder b = wall_ahead();
  LidarOptions options = forward_lidar();
  options.deskew = true;
  const Motion motion{.v = {8, 3, 0}, .yaw_rate = 2};
  const auto scan = scan_scene(b, options, 1, instants(b, motion, 64));
  ASSERT_GT(scan->size(), 1000u);
  const double yaw = 0.2;
  for (size_t i = 0; i < scan->size(); ++i) {
    const double x_W = 0.8 + scan->x[i] * std::cos(yaw) - scan->y[i] * std::sin(yaw);
    EXPECT_NEAR(x_W, 10, 1e-4 * scan->range[i]);
  }
}

TEST(LidarMotion, MoreKeysFollowACurvedWayBetter) {
  // Accelerated: x = 40 t² [m].
  const SceneBuilder b = wall_ahead();
  double worst[2] = {};
  const int keys[2] = {1, 8};
  for (int run = 0; run < 2; ++run) {
    std::vector<PoseFrame> instants_of_run = instants(b, {}, keys[run]);
    for (PoseFrame& key : instants_of_run) {
      const auto t = static_cast<float>(key.time - 5);
      SceneBuilder::set_body(&key, 1, translation({40 * t * t, 0, 0}));
    }
    const auto scan = scan_scene(b, forward_lidar(), 1, instants_of_run);
    for (size_t i = 0; i < scan->size(); ++i) {
      const double t = scan->time[i];
      worst[run] = std::max(worst[run], std::abs(scan->x[i] - (10 - 40 * t * t)));
    }
  }
  // Chords of a parabola: a (dt)² / 4 at most.
  EXPECT_NEAR(worst[0], 0.1, 0.005);
  EXPECT_NEAR(worst[1], 0.1 / 64, 0.0003);
}

// Keys that are not evenly in time: sensor and wall go from one to the next evenly all the same.
TEST(LidarMotion, EveryStretchBetweenKeysHasItsOwnLength) {
  const SceneBuilder b = wall_ahead();
  const std::vector<double> times = {0, 0.011, 0.034, 0.05, 0.083, 0.1};
  std::vector<PoseFrame> keys(times.size(), b.frame);
  const auto sensor_at = [](double t) { return 40 * t * t; };
  const auto wall_at = [](double t) { return 10 - 60 * t * t; };
  for (size_t k = 0; k < times.size(); ++k) {
    keys[k].time = 5 + times[k];
    const auto sensor = static_cast<float>(sensor_at(times[k]));
    const auto wall = static_cast<float>(wall_at(times[k]) + 0.5);
    SceneBuilder::set_body(&keys[k], 1, translation({sensor, 0, 0}));
    SceneBuilder::set_body(&keys[k], 2, translation({wall, 0, 0}));
  }
  LidarOptions options = forward_lidar();
  options.deskew = true;
  const auto distorted = scan_scene(b, forward_lidar(), 1, keys);
  const auto deskewed = scan_scene(b, options, 1, keys);
  ASSERT_EQ(distorted->size(), static_cast<size_t>(distorted->beams));
  for (size_t i = 0; i < distorted->size(); ++i) {
    const double t = distorted->time[i];
    size_t k = 1;
    while (k + 1 < times.size() && times[k] < t) ++k;
    const double share = (t - times[k - 1]) / (times[k] - times[k - 1]);
    const auto between = [&](const auto& at) {
      return at(times[k - 1]) + share * (at(times[k]) - at(times[k - 1]));
    };
    EXPECT_NEAR(distorted->x[i], between(wall_at) - between(sensor_at), 1e-3) << "at " << t << " s";
    EXPECT_NEAR(deskewed->x[i], between(wall_at) - sensor_at(0.1), 1e-3);
  }
}

TEST(LidarMotion, PointsAreStampedWithTheirFirings) {
  const SceneBuilder room = box_room({6, 4, 3});
  const auto vlp = scan_scene(room, ideal_lidar("VLP-16"), 0, [&] {
    std::vector<PoseFrame> keys(2, room.frame);
    keys[1].time = 0.1;
    return keys;
  }());
  // Ring 8 (1 degree up) fires 2.304 us after ring 0 of the same column.
  double first = -1, second = -1;
  for (size_t i = 0; i < vlp->size() && second < 0; ++i) {
    if (vlp->column[i] != 100) continue;
    if (vlp->ring[i] == 0) first = vlp->time[i];
    if (vlp->ring[i] == 8) second = vlp->time[i];
  }
  EXPECT_NEAR(first, 0.1 * 100 / 1808, 1e-8);
  EXPECT_NEAR(second - first, 2.304e-6, 1e-8);
  EXPECT_LE(*std::max_element(vlp->time.begin(), vlp->time.end()), 0.1f);
}

}  // namespace
}  // namespace gloam
