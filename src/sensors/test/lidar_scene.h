#pragma once
// LiDARs in scenes made by hand, for tests.

#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"
#include "render/test/scene_builder.h"
#include "sensors/lidar/lidar_sensor.h"
#include "sensors/test/statistics.h"

namespace gloam {

/// Without detection threshold, noise and overlap: an ideal range finder.
inline LidarOptions ideal_lidar(const std::string& preset = "OS1-64") {
  LidarOptions options;
  options.name = "lidar";
  options.preset = preset;
  options.range_at_10_percent = 0;
  options.min_range = 0.01;
  options.receiver_diameter = 0;
  options.truth = true;
  return options;
}

/// `rows` x `columns` beams straight ahead, all but parallel.
inline LidarOptions pencil(int rows = 1, int columns = 1) {
  LidarOptions options = ideal_lidar();
  options.pattern = "raster";
  options.rows = rows;
  options.columns = columns;
  options.field_of_view = {{0.01, 0.01}};
  options.returns = "all";
  return options;
}

/// A wall of half the size `half` about p.
inline int add_wall(SceneBuilder* b, Vec3f half, Vec3f p, int material) {
  return b->add(ShapeType::kBox, half, translation(p), material);
}

/// One scan through the scene at the instants `keys`; none = two that are the scene's own frame.
inline std::shared_ptr<const LidarScan> scan_scene(const SceneBuilder& scene,
                                                   const LidarOptions& options, int body = 0,
                                                   std::vector<PoseFrame> keys = {},
                                                   int64_t index = 0, uint64_t seed = 1) {
  if (keys.empty()) keys = {scene.frame, scene.frame};
  auto renderer = make_cpu_renderer(scene.description);
  GLOAM_CHECK(renderer.ok(), "the test's scene is refused");
  const LidarDescription lidar{options, body, {options.position, options.orientation}};
  auto sensor = LidarSensor::create(scene.description, lidar, seed);
  if (!sensor.ok()) {
    ADD_FAILURE() << sensor.error().to_string();
    abort();
  }
  RenderTurns turns;
  return (*sensor)->scan(**renderer, turns, keys, index);
}

inline Vec3f point(const LidarScan& scan, size_t i) { return {scan.x[i], scan.y[i], scan.z[i]}; }

}  // namespace gloam
