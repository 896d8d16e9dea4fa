#pragma once
// Channels of a CameraFrame that a request asks for: a subset of kCameraChannels.

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/outputs.h"
#include "gloam/result.h"

namespace gloam {

/// A channel by its name; one that is not in kCameraChannels does not compile.
struct ChannelName {
  size_t row = 0;
  consteval ChannelName(const char* name) {  // NOLINT: implicit on purpose, `has("depth")`
    while (kCameraChannels[row].name != std::string_view(name)) ++row;
  }
};

class CameraChannels {
 public:
  /// Error: an unknown name, with the nearest one.
  static Result<CameraChannels> parse(const std::vector<std::string>& names);

  bool has(ChannelName channel) const { return wanted_[channel.row]; }
  bool needs(ChannelSource source) const;
  bool light() const { return needs(ChannelSource::kLight); }
  /// A model that the camera lacks and a channel needs; null = none.
  const CameraChannel* without_model(const CameraSensing& sensing) const;
  /// Memory of a pixel in a CameraFrame [bytes].
  uint64_t pixel_bytes() const;

 private:
  std::bitset<kCameraChannels.size()> wanted_;
};

}  // namespace gloam
