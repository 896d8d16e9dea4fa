#pragma once
// Content of the files that hold one frame of a camera: what a recording writes into a folder per
// kind, and a still beside its picture. The files are the rows of kCameraFiles.

#include <cstdint>
#include <vector>

#include "gloam/outputs.h"
#include "gloam/result.h"

namespace gloam {

/// The content of a file that is_of_each_frame(); empty for a frame that lacks the channel.
Result<std::vector<uint8_t>> encode_frame_file(const CameraFile& file, const CameraFrame& frame);

}  // namespace gloam
