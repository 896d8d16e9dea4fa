#include "runtime/recording/sensing_metrics.h"

#include <array>
#include <cmath>

#include "base/srgb.h"
#include "runtime/recording/sensing_quality.h"

namespace gloam {
namespace {

constexpr size_t kPixelSpacing = 4;  // [px]
constexpr int kLeastWidth = 16;      // [px], below which four apart tell nothing

/// Linear light of 8-bit sRGB.
const std::array<float, 256>& linear_table() {
  static const auto table = [] {
    std::array<float, 256> t{};
    for (size_t i = 0; i < t.size(); ++i) t[i] = srgb_decode(static_cast<float>(i) / 255.0f);
    return t;
  }();
  return table;
}

double percent(int64_t part, int64_t of) {
  return 100 * static_cast<double>(part) / static_cast<double>(of);
}

}  // namespace

void CameraQuality::add(const CameraFrame& frame) {
  ++frames_;
  events_ += static_cast<int64_t>(frame.events.size());
  add_picture(frame);
  add_depth(frame);
  add_thermal(frame);
}

void CameraQuality::add_picture(const CameraFrame& frame) {
  if (frame.rgb.empty() || frame.intrinsics.width < kLeastWidth ||
      frame.intrinsics.height < kLeastWidth)
    return;
  linear_.resize(frame.rgb.size());
  for (size_t i = 0; i < frame.rgb.size(); ++i) linear_[i] = linear_table()[frame.rgb[i]];
  const double contrast = contrast_of(linear_, frame.intrinsics.width);
  if (!std::isfinite(contrast)) return;  // a black picture
  contrast_ += contrast;
  ++pictures_;
}

void CameraQuality::add_depth(const CameraFrame& frame) {
  if (frame.sensor_depth.size() != frame.depth.size()) return;
  for (size_t i = 0; i < frame.depth.size(); ++i) {
    const auto truth = static_cast<double>(frame.depth[i]);
    const auto seen = static_cast<double>(frame.sensor_depth[i]);
    if (!std::isfinite(truth) || truth <= 0) continue;
    ++there_;
    if (seen <= 0) continue;
    ++measured_;
    error_squared_ += (seen / truth - 1) * (seen / truth - 1);
  }
}

void CameraQuality::add_thermal(const CameraFrame& frame) {
  const auto across = static_cast<size_t>(frame.intrinsics.width);
  for (size_t i = 0; i + kPixelSpacing < frame.thermal.size(); ++i) {
    if (i % across + kPixelSpacing >= across) continue;
    const auto step = static_cast<double>(frame.thermal[i + kPixelSpacing] - frame.thermal[i]);
    thermal_squared_ += step * step;
    ++thermal_;
  }
}

void CameraQuality::summarize(std::vector<std::pair<std::string, double>>* numbers) const {
  if (pictures_ > 0)
    numbers->emplace_back(name_ + ".contrast", contrast_ / static_cast<double>(pictures_));
  if (there_ > 0)
    numbers->emplace_back(name_ + ".depth_measured_percent", percent(measured_, there_));
  if (measured_ > 0)
    numbers->emplace_back(name_ + ".depth_error_percent",
                          100 * std::sqrt(error_squared_ / static_cast<double>(measured_)));
  if (thermal_ > 0)
    numbers->emplace_back(name_ + ".thermal_contrast_K",
                          std::sqrt(thermal_squared_ / static_cast<double>(thermal_)));
  if (events_ > 0)
    numbers->emplace_back(name_ + ".events_per_frame",
                          static_cast<double>(events_) / static_cast<double>(frames_));
}

void LidarQuality::add(const LidarScan& scan) {
  beams_ += scan.beams;
  has_truth_ |= !scan.part.empty();
  for (size_t i = 0; i < scan.size(); ++i) {
    if (scan.return_number[i] != 0) continue;
    ++returns_;
    if (!scan.part.empty() && scan.part[i] == 0) ++false_;
  }
}

void LidarQuality::summarize(std::vector<std::pair<std::string, double>>* numbers) const {
  if (beams_ == 0) return;
  numbers->emplace_back(name_ + ".returns_percent", percent(returns_, beams_));
  if (has_truth_) numbers->emplace_back(name_ + ".false_returns_percent", percent(false_, beams_));
}

CameraQuality* SensingMetrics::add_camera(const std::string& name) {
  return cameras_.emplace_back(std::make_unique<CameraQuality>(name)).get();
}

LidarQuality* SensingMetrics::add_lidar(const std::string& name) {
  return lidars_.emplace_back(std::make_unique<LidarQuality>(name)).get();
}

std::vector<std::pair<std::string, double>> SensingMetrics::summary() const {
  std::vector<std::pair<std::string, double>> numbers;
  for (const auto& camera : cameras_) camera->summarize(&numbers);
  for (const auto& lidar : lidars_) lidar->summarize(&numbers);
  return numbers;
}

}  // namespace gloam
