#pragma once
// Pictures on their way to the page: a JPEG behind a fixed header, docs/view_protocol.md.

#include <cstdint>
#include <vector>

#include "gloam/camera.h"
#include "gloam/result.h"

namespace gloam::studio {

inline constexpr size_t kPictureHeaderSize = 152;

/// Header and JPEG of one frame. `sequence` counts the frames that came from the renderer, so that
/// gaps tell a client what it has not been sent; `camera` is a row of the hello message's list.
Result<std::vector<uint8_t>> encode_picture(const CameraFrame& frame, uint64_t sequence,
                                            uint32_t camera);

}  // namespace gloam::studio
