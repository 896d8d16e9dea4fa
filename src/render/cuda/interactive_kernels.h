#pragma once
// Interface of the host to the kernels of the interactive tier.

#include "render/kernel/interactive/temporal.h"

struct CUstream_st;

namespace gloam::cuda {

using Stream = CUstream_st*;

/// Adds the picture to its history, and makes `color` of both.
void launch_temporal(const TemporalPicture& picture, Stream stream);

}  // namespace gloam::cuda
