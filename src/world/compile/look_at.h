#pragma once
// Cameras and lamps that are aimed at a point.

#include "gloam/types.h"

namespace gloam {

/// Turns a frame at `from` so that its -Z points at `to` and its +Y upwards; "up" is Z of the frame
/// both are given in. Straight up or down: +Y points along that frame's +Y.
Quat look_at(const Vec3& from, const Vec3& to);

}  // namespace gloam
