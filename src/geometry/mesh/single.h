#pragma once
// Vectors of the public API in single precision, as the renderer has them.

#include "base/vec.h"
#include "gloam/types.h"

namespace gloam {

inline Vec3f to_vec3f(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Between the world and a render scene whose origin is there (RenderDescription::origin) [m].
inline Vec3 from_origin(const Vec3& p_W, const Vec3& origin) {
  return {p_W.x - origin.x, p_W.y - origin.y, p_W.z - origin.z};
}
inline Vec3 in_world(const Vec3& p, const Vec3& origin) {
  return {p.x + origin.x, p.y + origin.y, p.z + origin.z};
}

}  // namespace gloam
