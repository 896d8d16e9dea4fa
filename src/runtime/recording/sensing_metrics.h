#pragma once
// Metrics of how well the recorded cameras and LiDARs sense: what smoke, rain and darkness take
// from them.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gloam/camera.h"
#include "gloam/sensor.h"

namespace gloam {

/// Quality of one camera; frames come on one thread at a time.
class CameraQuality {
 public:
  explicit CameraQuality(std::string camera) : name_(std::move(camera)) {}
  void add(const CameraFrame& frame);
  /// "CAMERA.contrast": mean of contrast_of the pictures (1 = a factor of e). With a depth model
  /// and true depth "CAMERA.depth_measured_percent": pixels with a measured depth of those where
  /// there is something; "CAMERA.depth_error_percent": root mean square of its relative error.
  /// Thermal: "CAMERA.thermal_contrast_K", the root mean square of differences over four pixels of
  /// a row. Event cameras: "CAMERA.events_per_frame".
  void summarize(std::vector<std::pair<std::string, double>>* numbers) const;

 private:
  void add_picture(const CameraFrame& frame);
  void add_depth(const CameraFrame& frame);
  void add_thermal(const CameraFrame& frame);

  std::string name_;
  std::vector<float> linear_;  // of one picture
  double contrast_ = 0, error_squared_ = 0, thermal_squared_ = 0;
  int64_t pictures_ = 0, there_ = 0, measured_ = 0, thermal_ = 0, frames_ = 0, events_ = 0;
};

/// Quality of one LiDAR; scans come on one thread at a time.
class LidarQuality {
 public:
  explicit LidarQuality(std::string lidar) : name_(std::move(lidar)) {}
  void add(const LidarScan& scan);
  /// "LIDAR.returns_percent": beams with a return; with truth "LIDAR.false_returns_percent": those
  /// whose first return is a medium's.
  void summarize(std::vector<std::pair<std::string, double>>* numbers) const;

 private:
  std::string name_;
  int64_t beams_ = 0, returns_ = 0, false_ = 0;
  bool has_truth_ = false;
};

/// Quality of all that a run records. Pointers stay good while it lives.
class SensingMetrics {
 public:
  CameraQuality* add_camera(const std::string& name);
  LidarQuality* add_lidar(const std::string& name);
  /// After the last frame and scan.
  std::vector<std::pair<std::string, double>> summary() const;

 private:
  std::vector<std::unique_ptr<CameraQuality>> cameras_;
  std::vector<std::unique_ptr<LidarQuality>> lidars_;
};

}  // namespace gloam
