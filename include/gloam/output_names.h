#pragma once
// Names of outputs that cameras, stills and recordings accept: channels and single files.

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/outputs.h"

namespace gloam {

/// Appends to a list of files ("depth_exr") the names of channels ("depth"). Where files are
/// written, a channel stands for every file that is made from it in each frame.
template <size_t kCount>
constexpr auto with_channels(const std::array<std::string_view, kCount>& outputs) {
  constexpr auto is_new = [](const CameraChannel& channel) {
    return std::ranges::find(kCameraOutputs, channel.name) == kCameraOutputs.end();
  };
  std::array<std::string_view, kCount + std::ranges::count_if(kCameraChannels, is_new)> all;
  auto* end = std::ranges::copy(outputs, all.begin()).out;
  for (const CameraChannel& channel : kCameraChannels)
    if (is_new(channel)) *end++ = channel.name;
  return all;
}
inline constexpr auto kCameraOutputNames = with_channels(kCameraOutputs);
inline constexpr auto kOutputNames = with_channels(kRecordOutputs);

/// Outputs of a recording: {"depth"} -> {"depth_png", "depth_exr"}. Other names stay.
inline std::vector<std::string> recorded_outputs(const std::vector<std::string>& names) {
  std::vector<std::string> outputs;
  const auto add = [&outputs](std::string_view name) {
    if (std::ranges::find(outputs, name) == outputs.end()) outputs.emplace_back(name);
  };
  for (const std::string& name : names) {
    const bool is_output = std::ranges::find(kRecordOutputs, name) != kRecordOutputs.end();
    if (is_output || find_camera_channel(name) == nullptr) {
      add(name);
      continue;
    }
    for (const CameraFile& file : kCameraFiles)
      if (file.channel == name && file.is_of_each_frame()) add(file.output);
  }
  return outputs;
}

/// Channel that an output is made of, or is; null if there is none of this name.
constexpr const CameraChannel* find_output_channel(std::string_view name) {
  if (const CameraChannel* channel = find_camera_channel(name)) return channel;
  const auto* file = std::ranges::find(kCameraFiles, name, &CameraFile::output);
  return file != kCameraFiles.end() ? find_camera_channel(file->channel) : nullptr;
}

}  // namespace gloam
