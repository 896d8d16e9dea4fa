#pragma once
// A mirrored border around a picture. Device-safe.

#include "base/device.h"

namespace gloam {

/// Place in 0 … n - 1 of a mirror image that repeats on both sides.
GLOAM_HD int mirrored(int i, int n) {
  const int turn = 2 * n, at = ((i % turn) + turn) % turn;
  return at < n ? at : turn - 1 - at;
}

}  // namespace gloam
