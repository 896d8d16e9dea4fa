#pragma once
// Streams of a World, as its model and scene tell.

#include <vector>

#include "gloam/stream_info.h"

namespace gloam {

struct CompiledWorld;

/// LiDARs have the rate that their options give; 0 = their preset's.
std::vector<StreamInfo> list_streams(const CompiledWorld& world);

/// Inputs of robots and of bodies that are driven from outside.
std::vector<InputInfo> list_inputs(const CompiledWorld& world);

}  // namespace gloam
