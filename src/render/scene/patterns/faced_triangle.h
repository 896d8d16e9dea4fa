#pragma once
// A triangle of a surface, seen along one of the six directions of its tiles.

#include <optional>

#include "render/scene/patterns/pattern_surface.h"

namespace gloam {

struct FacedTriangle {
  Vec3f n;                              ///< unit normal in G
  Vec3f low, high;                      ///< its bounds, along_face()
  float edge_u[3], edge_v[3], edge[3];  ///< outside_edge() of each edge is linear in (u, v)
  float across, per_u, per_v;           ///< its plane: across + per_u u + per_v v

  /// Nothing where the triangle does not lean that way, or has no area. Triangles that lean almost
  /// as much another way have tiles there, too: rounding decides where a hit looks.
  static std::optional<FacedTriangle> make(const PatternSurface& surface, uint32_t triangle,
                                           int face);

  /// How far a place lies outside the triangle, at most; not above 0 inside [m].
  float outside(float u, float v) const;
  /// Whether some of it may lie in the square about (u, v) of half the edge `half`.
  bool touches(float u, float v, float half) const;
  float height(float u, float v) const { return across + per_u * u + per_v * v; }
};

}  // namespace gloam
