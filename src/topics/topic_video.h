#pragma once
// H.264 video of a camera as messages.

#include "topics/topic.h"

namespace gloam {

/// Encoder of foxglove_msgs/CompressedVideo for one subscription: one picture a message, none that
/// refers to a later one, a key picture with its parameter sets at the beginning, after a reset and
/// at least once a second of simulation time. Odd sizes are extended by one repeated line. One
/// thread: the bytes are a function of the pictures.
FrameEncoder h264_encoder();

}  // namespace gloam
