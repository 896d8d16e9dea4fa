#pragma once
// Vectors of the public API in single precision, as the renderer has them.

#include "base/vec.h"
#include "gloam/types.h"

namespace gloam {

inline Vec3f to_vec3f(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace gloam
