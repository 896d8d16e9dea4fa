#pragma once
// Objects of Recast and Detour, for the files of the navigation mesh.

#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshQuery.h>

#include "sim/agents/nav_mesh.h"

namespace gloam {

/// Recast has y up: (x, y, z) of ours is (x, z, -y) there.
inline void to_recast(Vec3d p, float* out) {
  out[0] = static_cast<float>(p.x), out[1] = static_cast<float>(p.z);
  out[2] = static_cast<float>(-p.y);
}
inline Vec3d from_recast(const float* r) { return {double{r[0]}, -double{r[2]}, double{r[1]}}; }

struct NavMesh::Impl {
  NavSettings settings;
  float cell = 0, cell_height = 0;
  float low[3] = {}, high[3] = {};  // Recast's axes
  int columns = 0, rows = 0;
  std::unique_ptr<dtNavMesh> mesh;
  dtNavMeshQuery query;
  dtQueryFilter filter;
  // Parts that hang together: the polygons of each, in order, and the area up to each [m²].
  struct Part {
    std::vector<dtPolyRef> polys;
    std::vector<double> areas;
    double area() const { return areas.empty() ? 0 : areas.back(); }
  };
  std::vector<Part> parts;
  size_t largest = 0;
  std::vector<std::pair<dtPolyRef, int>> part_of_poly;  // sorted
};

inline constexpr int kNavTileCells = 48;

}  // namespace gloam
