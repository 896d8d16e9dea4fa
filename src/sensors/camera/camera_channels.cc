#include "sensors/camera/camera_channels.h"

#include <fmt/format.h>

#include "base/text.h"
#include "gloam/output_names.h"

namespace gloam {

Result<CameraChannels> CameraChannels::parse(const std::vector<std::string>& names) {
  CameraChannels channels;
  for (const std::string& name : names) {
    const CameraChannel* found = find_output_channel(name);
    if (found == nullptr) {
      const std::vector<std::string> all(kCameraOutputNames.begin(), kCameraOutputNames.end());
      return Error{ErrorKind::kInput,
                   fmt::format("there is no camera output '{}'", name),
                   {},
                   suggest_name(name, all)};
    }
    channels.wanted_.set(static_cast<size_t>(found - kCameraChannels.data()));
  }
  return channels;
}

bool CameraChannels::needs(ChannelSource source) const {
  for (size_t i = 0; i < kCameraChannels.size(); ++i)
    if (wanted_[i] && kCameraChannels[i].source == source) return true;
  return false;
}

const CameraChannel* CameraChannels::without_model(const CameraSensing& sensing) const {
  for (size_t i = 0; i < kCameraChannels.size(); ++i)
    if (wanted_[i] && !kCameraChannels[i].has_model(sensing)) return &kCameraChannels[i];
  return nullptr;
}

uint64_t CameraChannels::pixel_bytes() const {
  uint64_t bytes = 0;
  for (size_t i = 0; i < kCameraChannels.size(); ++i)
    if (wanted_[i]) bytes += kCameraChannels[i].bytes;
  return bytes;
}

}  // namespace gloam
