#pragma once
// Meshes as MuJoCo draws them, out of its separate index arrays. No MuJoCo types.

#include <cstdint>
#include <span>

#include "geometry/mesh/mesh.h"
#include "world/render_description.h"

namespace gloam {

/// A mesh whose corners name position, normal and uv by separate indices.
struct IndexedCorners {
  std::span<const Vec3f> positions;
  std::span<const Vec3f> normals;                   ///< unit, or zero where there is none
  std::span<const Vec2f> uvs;                       ///< t down the image (MuJoCo's), empty = none
  std::span<const int> face, face_normal, face_uv;  ///< three per triangle; face_uv as uvs
};

/// One vertex per distinct (position, normal, uv) corner, in the order of first use. As MuJoCo's
/// renderer does, a corner whose normal leans from its face by more than acos 0.8 is an edge and
/// gets the face's own normal.
TriangleMesh split_corners(const IndexedCorners& corners);

/// Surface, four sides and base of a height field in its own frame. `data` = rows x columns, 0..1,
/// first row at -y. Sides reach from the surface down to -base.
TriangleMesh height_field_mesh(const HeightFieldDescription& field, std::span<const float> data);

}  // namespace gloam
