#pragma once
// The files that hold one frame of a camera, a line each: what a recording writes into a folder per
// kind, and a still beside its picture.

#include <cstdint>
#include <span>
#include <vector>

#include "gloam/camera.h"
#include "gloam/result.h"

namespace gloam {

struct FrameFile {
  const char* output;   ///< output that asks for it, as in [record]: "depth_exr"
  const char* channel;  ///< channel of CameraRequest that fills it: "depth"
  const char* folder;   ///< folder of a recording: CAMERA/depth_exr/000000.exr
  const char* suffix;   ///< suffix of a still: NAME_depth.exr
  /// The content; empty for a frame that lacks the channel.
  Result<std::vector<uint8_t>> (*encode)(const CameraFrame&);

  const char* extension() const;  ///< "exr"
};

std::span<const FrameFile> frame_files();

}  // namespace gloam
