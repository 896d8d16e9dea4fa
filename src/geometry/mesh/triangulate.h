#pragma once
// Polygons of mesh files as triangles.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"

namespace gloam {

/// Polygons one after the other: sizes[i] corners each.
struct PolygonList {
  std::vector<uint32_t> sizes, corners;
};

/// Cuts polygons into triangles, three indices each, in order and with the same winding. Concave
/// ones are cut by ears in the plane that fits them best. Those of fewer than three corners vanish.
/// Returns "" or why not, with the number of the polygon in `bad`. Every corner must be a position.
std::string triangulate_polygons(std::span<const Vec3f> positions, const PolygonList& polygons,
                                 std::vector<uint32_t>* indices, uint64_t* bad);

}  // namespace gloam
