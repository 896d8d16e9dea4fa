#pragma once
// Outputs of cameras and runs: one table of the channels of a CameraFrame, and one of the files
// written from them. All other lists of outputs are derived from these two tables.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "gloam/camera.h"
#include "gloam/scene/sensor.h"

namespace gloam {

/// Part of the rendering that produces a channel.
enum class ChannelSource : uint8_t {
  kLight,    ///< samples of light
  kSurface,  ///< first surface: its position and identity
  kDetails,  ///< also its normal, albedo and motion
  kCover,    ///< pixels of each object, hidden or not
};

/// A channel that CameraRequest::outputs may name.
struct CameraChannel {
  std::string_view name;
  ChannelSource source;
  uint64_t bytes;               ///< bytes per pixel in a CameraFrame
  std::string_view model = "";  ///< table [camera.MODEL] that it needs; "" = none
  bool (*has_model)(const CameraSensing&) = [](const CameraSensing&) { return true; };
};

template <auto kTable>
constexpr bool has_table(const CameraSensing& sensing) {
  return (sensing.*kTable).has_value();
}

inline constexpr auto kCameraChannels = [] {
  using enum ChannelSource;
  return std::to_array<CameraChannel>({
      {"rgb", kLight, 3},
      {"radiance", kLight, 12},
      {"samples", kLight, 4},
      {"depth", kSurface, 4},
      {"distance", kSurface, 4},
      {"segmentation", kSurface, 12},
      {"normal", kDetails, 12},
      {"albedo", kDetails, 12},
      {"motion", kDetails, 8},
      {"scene_flow", kDetails, 12},
      {"boxes", kCover, 0},
      {"raw", kLight, 6, "imager", has_table<&CameraSensing::imager>},
      {"sensor_depth", kDetails, 4, "stereo_depth", has_table<&CameraSensing::stereo_depth>},
      {"events", kLight, 64, "events", has_table<&CameraSensing::events>},
      {"thermal", kSurface, 4, "thermal", has_table<&CameraSensing::thermal>},
  });
}();

/// Row of kCameraChannels; null if there is none of this name.
constexpr const CameraChannel* find_camera_channel(std::string_view name) {
  const auto* row = std::ranges::find(kCameraChannels, name, &CameraChannel::name);
  return row != kCameraChannels.end() ? row : nullptr;
}

enum class FileFormat : uint8_t {
  kVideo,  ///< H.264
  kCsv,
  kPng8,          ///< three values per pixel
  kPng16,         ///< the values of a pixel are side by side in its row
  kMillimetres,   ///< 16-bit PNG of [m]
  kCentikelvins,  ///< 16-bit PNG of [K]
  kIds,           ///< 16-bit PNG; 24-bit for worlds with more parts
  kExr,
  kJson,
};

/// Member of CameraFrame that a file holds.
using CameraPlane =
    std::variant<std::vector<uint8_t> CameraFrame::*, std::vector<uint16_t> CameraFrame::*,
                 std::vector<uint32_t> CameraFrame::*, std::vector<float> CameraFrame::*,
                 std::vector<Event> CameraFrame::*, std::vector<ObjectView> CameraFrame::*>;

/// A file that a recording or a still writes from a channel.
struct CameraFile {
  std::string_view output;  ///< output that selects it, as in [record]; it may have several files
  std::string_view channel;
  FileFormat format;
  CameraPlane plane;
  /// Folder of a recording, CAMERA/depth_exr/000000.exr; "" = one file of all frames.
  std::string_view folder = "";
  std::string_view suffix = "";     ///< suffix of a still: NAME_depth.exr
  std::string_view exr_names = "";  ///< channels of an EXR, separated by blanks

  bool is_of_each_frame() const { return !folder.empty(); }
  std::string_view extension() const { return suffix.substr(suffix.rfind('.') + 1); }
};

inline constexpr auto kCameraFiles = [] {
  using enum FileFormat;
  using F = CameraFrame;
  return std::to_array<CameraFile>({
      {"video", "rgb", kVideo, &F::rgb},
      {"png", "rgb", kPng8, &F::rgb, "rgb", ".png"},
      {"radiance_exr", "radiance", kExr, &F::radiance, "radiance", ".exr", "R G B"},
      {"samples_exr", "samples", kExr, &F::samples, "samples", "_samples.exr", "samples"},
      {"depth_png", "depth", kMillimetres, &F::depth, "depth", "_depth.png"},
      {"depth_exr", "depth", kExr, &F::depth, "depth_exr", "_depth.exr", "Z"},
      {"distance_exr", "distance", kExr, &F::distance, "distance", "_distance.exr", "distance"},
      {"segmentation", "segmentation", kIds, &F::instance, "instance", "_instance.png"},
      {"segmentation", "segmentation", kIds, &F::semantic, "semantic", "_semantic.png"},
      {"segmentation", "segmentation", kIds, &F::part, "part", "_part.png"},
      {"normal_exr", "normal", kExr, &F::normal, "normal", "_normal.exr", "X Y Z"},
      {"albedo_exr", "albedo", kExr, &F::albedo, "albedo", "_albedo.exr", "R G B"},
      {"motion_exr", "motion", kExr, &F::motion, "motion", "_motion.exr", "U V"},
      {"scene_flow_exr", "scene_flow", kExr, &F::scene_flow, "scene_flow", "_scene_flow.exr",
       "X Y Z"},
      {"boxes_json", "boxes", kJson, &F::objects, "boxes", "_boxes.json"},
      {"sensor_depth_png", "sensor_depth", kMillimetres, &F::sensor_depth, "sensor_depth",
       "_sensor_depth.png"},
      {"sensor_depth_exr", "sensor_depth", kExr, &F::sensor_depth, "sensor_depth_exr",
       "_sensor_depth.exr", "Z"},
      {"raw_png", "raw", kPng16, &F::raw, "raw", "_raw.png"},
      {"thermal_png", "thermal", kCentikelvins, &F::thermal, "thermal", "_thermal.png"},
      {"thermal_exr", "thermal", kExr, &F::thermal, "thermal_exr", "_thermal.exr", "K"},
      {"events", "events", kCsv, &F::events},
  });
}();

/// Outputs of a camera that can be recorded.
inline constexpr auto kCameraOutputs = [] {
  constexpr auto is_first = [](const CameraFile& file) {
    return &file == kCameraFiles.data() || (&file)[-1].output != file.output;
  };
  std::array<std::string_view, std::ranges::count_if(kCameraFiles, is_first)> names;
  auto* end = names.begin();
  for (const CameraFile& file : kCameraFiles)
    if (is_first(file)) *end++ = file.output;
  return names;
}();

/// Outputs of a run that can be recorded: all camera outputs, and the others.
inline constexpr auto kRecordOutputs = [] {
  constexpr std::string_view kOthers[] = {"lidar", "metrics", "contact_sheet", "sensors", "state"};
  std::array<std::string_view, kCameraOutputs.size() + std::size(kOthers)> all;
  std::ranges::copy(kOthers, std::ranges::copy(kCameraOutputs, all.begin()).out);
  return all;
}();

}  // namespace gloam
