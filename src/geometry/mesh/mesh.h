#pragma once
// Triangle meshes as everything downstream reads them.

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace gloam {

struct TriangleMesh {
  std::vector<Vec3f> positions;   ///< [m]
  std::vector<Vec3f> normals;     ///< unit shading normals, one per position; empty = flat
  std::vector<Vec2f> uvs;         ///< one per position; empty = none. v grows upwards, as in OBJ
  std::vector<uint32_t> indices;  ///< three per triangle, counter-clockwise seen from outside
  std::vector<Vec2f> uvs1;        ///< a second set for textures that ask for it; empty = none
  size_t triangle_count() const { return indices.size() / 3; }
};

}  // namespace gloam
