// One tile of a navigation mesh: colliders -> voxels -> regions -> polygons, by Recast.

#include <recastnavigation/DetourAlloc.h>
#include <recastnavigation/DetourNavMeshBuilder.h>
#include <recastnavigation/Recast.h>

#include <memory>

#include "sim/agents/nav_impl.h"

namespace gloam {
namespace {

constexpr float kLeastRegion = 0.5f;  // [m²]; smaller places are nobody's way

template <class T, void (*free_it)(T*)>
struct RecastDeleter {
  void operator()(T* object) const { free_it(object); }
};
using Voxels = std::unique_ptr<rcHeightfield, RecastDeleter<rcHeightfield, rcFreeHeightField>>;
using OpenVoxels = std::unique_ptr<rcCompactHeightfield,
                                   RecastDeleter<rcCompactHeightfield, rcFreeCompactHeightfield>>;
using Contours = std::unique_ptr<rcContourSet, RecastDeleter<rcContourSet, rcFreeContourSet>>;
using Polygons = std::unique_ptr<rcPolyMesh, RecastDeleter<rcPolyMesh, rcFreePolyMesh>>;
using Details =
    std::unique_ptr<rcPolyMeshDetail, RecastDeleter<rcPolyMeshDetail, rcFreePolyMeshDetail>>;

rcConfig config_of(const NavMesh::Impl& mesh, int column, int row) {
  const NavSettings& s = mesh.settings;
  rcConfig c{};
  c.cs = mesh.cell;
  c.ch = mesh.cell_height;
  c.walkableSlopeAngle = static_cast<float>(s.slope);
  c.walkableHeight = static_cast<int>(std::ceil(s.headroom / double{c.ch}));
  c.walkableClimb = static_cast<int>(std::floor(s.climb / double{c.ch} + 1e-6));
  c.walkableRadius = static_cast<int>(std::ceil(s.radius / double{c.cs} - 1e-6));
  c.maxEdgeLen = static_cast<int>(12 / c.cs);
  c.maxSimplificationError = 1.3f;
  c.minRegionArea = static_cast<int>(kLeastRegion / (c.cs * c.cs));
  c.mergeRegionArea = 20 * c.minRegionArea;
  c.maxVertsPerPoly = DT_VERTS_PER_POLYGON;
  c.tileSize = kNavTileCells;
  c.borderSize = c.walkableRadius + 3;
  c.width = c.height = c.tileSize + 2 * c.borderSize;
  c.detailSampleDist = 6 * c.cs;
  c.detailSampleMaxError = c.ch;
  const float edge = static_cast<float>(kNavTileCells) * c.cs,
              border = static_cast<float>(c.borderSize) * c.cs;
  c.bmin[0] = mesh.low[0] + static_cast<float>(column) * edge - border;
  c.bmin[1] = mesh.low[1];
  c.bmin[2] = mesh.low[2] + static_cast<float>(row) * edge - border;
  c.bmax[0] = c.bmin[0] + edge + 2 * border;
  c.bmax[1] = mesh.high[1];
  c.bmax[2] = c.bmin[2] + edge + 2 * border;
  return c;
}

class TileBuilder {
 public:
  explicit TileBuilder(const rcConfig& config) : c_(config), voxels_(rcAllocHeightfield()) {}

  bool begin() {
    return voxels_ != nullptr && rcCreateHeightfield(&context_, *voxels_, c_.width, c_.height,
                                                     c_.bmin, c_.bmax, c_.cs, c_.ch);
  }

  bool add(const ColliderSurface& surface) {
    corners_.clear();
    for (const Vec3f v : surface.corners) {
      corners_.push_back(v.x), corners_.push_back(v.z), corners_.push_back(-v.y);
    }
    const int triangles = static_cast<int>(surface.corners.size() / 3);
    areas_.assign(static_cast<size_t>(triangles), 0);
    indices_.resize(surface.corners.size());
    for (size_t i = 0; i < indices_.size(); ++i) indices_[i] = static_cast<int>(i);
    rcMarkWalkableTriangles(&context_, c_.walkableSlopeAngle, corners_.data(),
                            static_cast<int>(surface.corners.size()), indices_.data(), triangles,
                            areas_.data());
    if (!surface.is_solid) {
      return rcRasterizeTriangles(&context_, corners_.data(), areas_.data(), triangles, *voxels_,
                                  c_.walkableClimb);
    }
    return add_solid(surface, triangles);
  }

  // A solid's voxels from its lowest to its highest in each column: nobody walks inside.
  bool add_solid(const ColliderSurface& surface, int triangles) {
    const auto column_of = [&](float p, int axis) {
      return static_cast<int>(std::floor((p - c_.bmin[axis]) / c_.cs));
    };
    const int x0 = std::max(column_of(surface.low.x, 0), 0),
              x1 = std::min(column_of(surface.high.x, 0), c_.width - 1),
              z0 = std::max(column_of(-surface.high.y, 2), 0),
              z1 = std::min(column_of(-surface.low.y, 2), c_.height - 1);
    if (x0 > x1 || z0 > z1) return true;
    const Voxels own(rcAllocHeightfield());
    float low[3] = {c_.bmin[0] + static_cast<float>(x0) * c_.cs, c_.bmin[1],
                    c_.bmin[2] + static_cast<float>(z0) * c_.cs};
    float high[3] = {c_.bmin[0] + static_cast<float>(x1 + 1) * c_.cs, c_.bmax[1],
                     c_.bmin[2] + static_cast<float>(z1 + 1) * c_.cs};
    if (own == nullptr ||
        !rcCreateHeightfield(&context_, *own, x1 - x0 + 1, z1 - z0 + 1, low, high, c_.cs, c_.ch) ||
        !rcRasterizeTriangles(&context_, corners_.data(), areas_.data(), triangles, *own, 1))
      return false;
    for (int z = 0; z < own->height; ++z) {
      for (int x = 0; x < own->width; ++x) {
        const rcSpan* span = own->spans[x + z * own->width];
        if (span == nullptr) continue;
        const unsigned lowest = span->smin;
        while (span->next != nullptr) span = span->next;
        if (!rcAddSpan(&context_, *voxels_, x0 + x, z0 + z, static_cast<unsigned short>(lowest),
                       static_cast<unsigned short>(span->smax),
                       static_cast<unsigned char>(span->area), c_.walkableClimb))
          return false;
      }
    }
    return true;
  }

  NavTile finish(int column, int row) {
    NavTile tile;
    rcFilterLowHangingWalkableObstacles(&context_, c_.walkableClimb, *voxels_);
    rcFilterLedgeSpans(&context_, c_.walkableHeight, c_.walkableClimb, *voxels_);
    rcFilterWalkableLowHeightSpans(&context_, c_.walkableHeight, *voxels_);
    const OpenVoxels open(rcAllocCompactHeightfield());
    const Contours contours(rcAllocContourSet());
    const Polygons polygons(rcAllocPolyMesh());
    const Details details(rcAllocPolyMeshDetail());
    const bool made =
        open && contours && polygons && details &&
        rcBuildCompactHeightfield(&context_, c_.walkableHeight, c_.walkableClimb, *voxels_,
                                  *open) &&
        rcErodeWalkableArea(&context_, c_.walkableRadius, *open) &&
        rcBuildDistanceField(&context_, *open) &&
        rcBuildRegions(&context_, *open, c_.borderSize, c_.minRegionArea, c_.mergeRegionArea) &&
        rcBuildContours(&context_, *open, c_.maxSimplificationError, c_.maxEdgeLen, *contours) &&
        contours->nconts > 0 &&
        rcBuildPolyMesh(&context_, *contours, c_.maxVertsPerPoly, *polygons) &&
        polygons->npolys > 0 &&
        rcBuildPolyMeshDetail(&context_, *polygons, *open, c_.detailSampleDist,
                              c_.detailSampleMaxError, *details);
    if (!made) return tile;
    for (int i = 0; i < polygons->npolys; ++i) {
      polygons->areas[i] = 0;
      polygons->flags[i] = 1;
    }
    dtNavMeshCreateParams p{};
    p.verts = polygons->verts, p.vertCount = polygons->nverts;
    p.polys = polygons->polys, p.polyAreas = polygons->areas, p.polyFlags = polygons->flags;
    p.polyCount = polygons->npolys, p.nvp = polygons->nvp;
    p.detailMeshes = details->meshes;
    p.detailVerts = details->verts, p.detailVertsCount = details->nverts;
    p.detailTris = details->tris, p.detailTriCount = details->ntris;
    p.walkableHeight = static_cast<float>(c_.walkableHeight) * c_.ch;
    p.walkableRadius = static_cast<float>(c_.walkableRadius) * c_.cs;
    p.walkableClimb = static_cast<float>(c_.walkableClimb) * c_.ch;
    p.tileX = column, p.tileY = row;
    std::copy(polygons->bmin, polygons->bmin + 3, p.bmin);
    std::copy(polygons->bmax, polygons->bmax + 3, p.bmax);
    p.cs = c_.cs, p.ch = c_.ch;
    p.buildBvTree = true;
    unsigned char* data = nullptr;
    int size = 0;
    if (dtCreateNavMeshData(&p, &data, &size)) tile.data.assign(data, data + size);
    dtFree(data);
    return tile;
  }

 private:
  rcConfig c_;
  rcContext context_{false};
  Voxels voxels_;
  std::vector<float> corners_;
  std::vector<int> indices_;
  std::vector<unsigned char> areas_;
};

}  // namespace

NavBounds NavMesh::tile_reach(int column, int row) const {
  const rcConfig c = config_of(*impl_, column, row);
  return {{c.bmin[0], -c.bmax[2], c.bmin[1]}, {c.bmax[0], -c.bmin[2], c.bmax[1]}};
}

NavTile NavMesh::build_tile(int column, int row,
                            std::span<const ColliderSurface* const> near) const {
  TileBuilder builder(config_of(*impl_, column, row));
  if (!builder.begin()) return {};
  for (const ColliderSurface* surface : near)
    if (!builder.add(*surface)) return {};
  return builder.finish(column, row);
}

}  // namespace gloam
