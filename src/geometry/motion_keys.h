#pragma once
// Position of a time among keys of a motion. Device-safe.

#include "base/vec.h"

namespace gloam {

/// The place of a time 0 … 1 among `count` >= 2 keys: the key before it, and the fraction of the
/// way to the next.
GLOAM_HD uint32_t key_before(uint32_t count, float time, float* share) {
  const float at = clamp(time, 0.0f, 1.0f) * static_cast<float>(count - 1);
  const uint32_t key = static_cast<uint32_t>(min(at, static_cast<float>(count - 2)));
  *share = at - static_cast<float>(key);
  return key;
}

}  // namespace gloam
