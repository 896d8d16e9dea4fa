#include "record/frame_files.h"

#include <fmt/format.h>

#include <cstring>
#include <initializer_list>

#include "record/run_files.h"
#include "render/film/exr.h"
#include "render/film/png.h"

namespace gloam {
namespace {

using Bytes = std::vector<uint8_t>;

Result<Bytes> png8(const CameraFrame& frame, const std::vector<uint8_t>& values) {
  if (values.empty()) return Bytes{};
  return encode_png8(frame.intrinsics.width, frame.intrinsics.height, 3, values);
}

/// Several values of a pixel (a raw picture's colours) stand side by side in its row.
Result<Bytes> png16(const CameraFrame& frame, const std::vector<uint16_t>& values) {
  if (values.empty()) return Bytes{};
  const size_t height = static_cast<size_t>(frame.intrinsics.height);
  return encode_png16(static_cast<int>(values.size() / height), frame.intrinsics.height, values);
}

Result<Bytes> exr(const CameraFrame& frame, const std::vector<float>& values,
                  std::initializer_list<const char*> names) {
  if (values.empty()) return Bytes{};
  std::vector<ExrChannel> channels;
  for (const char* name : names)
    channels.push_back({name, values.data() + channels.size(), static_cast<int>(names.size())});
  return encode_exr(frame.intrinsics.width, frame.intrinsics.height, channels);
}

/// 16 bits where they can number all parts of the world, which the frame need not show. Else three
/// bytes as in COCO's panoptic pictures: id = R + 256 G + 65536 B (Kirillov et al. 2019).
Result<Bytes> ids(const CameraFrame& frame, const std::vector<uint32_t>& values) {
  constexpr uint32_t kMost16 = 0xFFFF, kMost24 = 0xFFFFFF;
  if (frame.part_count <= kMost16) return png16(frame, {values.begin(), values.end()});
  if (frame.part_count > kMost24)
    return Error{ErrorKind::kUsage,
                 fmt::format("the scene of camera '{}' has {} parts; pictures number {} at most",
                             frame.camera, frame.part_count, kMost24),
                 {},
                 "read CameraFrame::part instead"};
  std::vector<uint8_t> rgb;
  rgb.reserve(3 * values.size());
  for (const uint32_t id : values)
    for (const int shift : {0, 8, 16}) rgb.push_back(static_cast<uint8_t>(id >> shift));
  return png8(frame, rgb);
}

Result<Bytes> boxes(const CameraFrame& frame) {
  if (frame.objects.empty()) return Bytes{};
  const std::string text = objects_json(frame.objects);
  return Bytes(text.begin(), text.end());
}

using F = CameraFrame;
constexpr FrameFile kFiles[] = {
    {"png", "rgb", "rgb", ".png", [](const F& f) { return png8(f, f.rgb); }},
    {"radiance_exr", "radiance", "radiance", ".exr",
     [](const F& f) { return exr(f, f.radiance, {"R", "G", "B"}); }},
    {"samples_exr", "samples", "samples", "_samples.exr",
     [](const F& f) { return exr(f, {f.samples.begin(), f.samples.end()}, {"samples"}); }},
    {"depth_png", "depth", "depth", "_depth.png",
     [](const F& f) { return png16(f, depth_to_millimetres(f.depth)); }},
    {"depth_exr", "depth", "depth_exr", "_depth.exr",
     [](const F& f) { return exr(f, f.depth, {"Z"}); }},
    {"distance_exr", "distance", "distance", "_distance.exr",
     [](const F& f) { return exr(f, f.distance, {"distance"}); }},
    {"sensor_depth_png", "sensor_depth", "sensor_depth", "_sensor_depth.png",
     [](const F& f) { return png16(f, depth_to_millimetres(f.sensor_depth)); }},
    {"sensor_depth_exr", "sensor_depth", "sensor_depth_exr", "_sensor_depth.exr",
     [](const F& f) { return exr(f, f.sensor_depth, {"Z"}); }},
    {"raw_png", "raw", "raw", "_raw.png", [](const F& f) { return png16(f, f.raw); }},
    {"thermal_png", "thermal", "thermal", "_thermal.png",
     [](const F& f) { return png16(f, to_centikelvins(f.thermal)); }},
    {"thermal_exr", "thermal", "thermal_exr", "_thermal.exr",
     [](const F& f) { return exr(f, f.thermal, {"K"}); }},
    {"segmentation", "segmentation", "instance", "_instance.png",
     [](const F& f) { return ids(f, f.instance); }},
    {"segmentation", "segmentation", "semantic", "_semantic.png",
     [](const F& f) { return ids(f, f.semantic); }},
    {"segmentation", "segmentation", "part", "_part.png",
     [](const F& f) { return ids(f, f.part); }},
    {"normal_exr", "normal", "normal", "_normal.exr",
     [](const F& f) { return exr(f, f.normal, {"X", "Y", "Z"}); }},
    {"albedo_exr", "albedo", "albedo", "_albedo.exr",
     [](const F& f) { return exr(f, f.albedo, {"R", "G", "B"}); }},
    {"motion_exr", "motion", "motion", "_motion.exr",
     [](const F& f) { return exr(f, f.motion, {"U", "V"}); }},
    {"scene_flow_exr", "scene_flow", "scene_flow", "_scene_flow.exr",
     [](const F& f) { return exr(f, f.scene_flow, {"X", "Y", "Z"}); }},
    {"boxes_json", "boxes", "boxes", "_boxes.json", boxes},
};

}  // namespace

const char* FrameFile::extension() const { return std::strrchr(suffix, '.') + 1; }

std::span<const FrameFile> frame_files() { return kFiles; }

}  // namespace gloam
