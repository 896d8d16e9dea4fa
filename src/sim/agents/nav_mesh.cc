#include "sim/agents/nav_mesh.h"

#include <fmt/format.h>
#include <recastnavigation/DetourCommon.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "base/check.h"
#include "sim/agents/nav_impl.h"

namespace gloam {
namespace {

constexpr int kMostTiles = 8192;  // leaves Detour's numbers of 32 bits room for 512 polygons each
constexpr int kSearchNodes = 8192;
constexpr float kMostHeights = 8000;  // limit of Recast's voxels, which have 13 bits

// In the plane, of a polygon of the mesh [m²].
double area_of(const dtMeshTile& tile, const dtPoly& poly) {
  double twice = 0;
  const float* a = tile.verts + 3 * poly.verts[0];
  for (int i = 2; i < poly.vertCount; ++i) {
    const float* b = tile.verts + 3 * poly.verts[i - 1];
    const float* c = tile.verts + 3 * poly.verts[i];
    twice += std::abs(double{b[0] - a[0]} * double{c[2] - a[2]} -
                      double{c[0] - a[0]} * double{b[2] - a[2]});
  }
  return twice / 2;
}

}  // namespace

NavMesh::NavMesh() : impl_(std::make_unique<Impl>()) {}
NavMesh::~NavMesh() = default;

Result<std::unique_ptr<NavMesh>> NavMesh::create(const NavSettings& settings) {
  std::unique_ptr<NavMesh> made(new NavMesh);
  Impl& mesh = *made->impl_;
  mesh.settings = settings;
  mesh.cell = static_cast<float>(settings.cell);
  const NavBounds& b = settings.bounds;
  const float height = b.high.z - b.low.z + static_cast<float>(settings.headroom) + 1;
  mesh.cell_height = max(mesh.cell / 2, height / kMostHeights);
  mesh.low[0] = b.low.x, mesh.low[1] = b.low.z - 0.5f, mesh.low[2] = -b.high.y;
  mesh.high[0] = b.high.x, mesh.high[1] = mesh.low[1] + height, mesh.high[2] = -b.low.y;
  const double edge = kNavTileCells * settings.cell;
  const double columns = std::ceil(double{b.high.x - b.low.x} / edge),
               rows = std::ceil(double{b.high.y - b.low.y} / edge);
  if (!(columns * rows <= kMostTiles)) {
    return Error{
        ErrorKind::kInput,
        fmt::format(
            "the area that agents can use, {:.0f} x {:.0f} m, is too large for cells of {:g} m",
            double{b.high.x - b.low.x}, double{b.high.y - b.low.y}, settings.cell),
        {},
        fmt::format("set 'cell' in [navigation] to {:.2g} m",
                    settings.cell * std::sqrt(columns * rows / kMostTiles) * 1.05)};
  }
  mesh.columns = std::max(static_cast<int>(columns), 1);
  mesh.rows = std::max(static_cast<int>(rows), 1);
  if (!made->clear()) return Error{ErrorKind::kInput, "out of memory for the navigation mesh"};
  return made;
}

bool NavMesh::clear() {
  Impl& mesh = *impl_;
  dtNavMeshParams p{};
  std::copy(mesh.low, mesh.low + 3, p.orig);
  p.tileWidth = p.tileHeight = static_cast<float>(kNavTileCells) * mesh.cell;
  p.maxTiles = static_cast<int>(dtNextPow2(static_cast<unsigned>(mesh.columns * mesh.rows)));
  p.maxPolys = 1 << (22 - static_cast<int>(dtIlog2(static_cast<unsigned>(p.maxTiles))));
  mesh.mesh = std::make_unique<dtNavMesh>();
  mesh.parts.clear();
  mesh.part_of_poly.clear();
  return dtStatusSucceed(mesh.mesh->init(&p)) &&
         dtStatusSucceed(mesh.query.init(mesh.mesh.get(), kSearchNodes));
}

int NavMesh::columns() const { return impl_->columns; }
int NavMesh::rows() const { return impl_->rows; }

void NavMesh::set_tile(int column, int row, const NavTile& tile) {
  dtNavMesh& mesh = *impl_->mesh;
  if (const dtTileRef old = mesh.getTileRefAt(column, row, 0))
    mesh.removeTile(old, nullptr, nullptr);
  if (tile.data.empty()) return;
  const size_t size = tile.data.size();
  auto* data = static_cast<unsigned char*>(dtAlloc(size, DT_ALLOC_PERM));
  GLOAM_CHECK(data != nullptr, "out of memory for a tile of the navigation mesh");
  std::memcpy(data, tile.data.data(), size);
  const dtStatus status = mesh.addTile(data, static_cast<int>(size), DT_TILE_FREE_DATA, 0, nullptr);
  GLOAM_CHECK(dtStatusSucceed(status), "Detour rejected a tile that it created");
}

void NavMesh::find_parts() {
  const dtNavMesh& mesh = *impl_->mesh;
  std::map<dtPolyRef, int> part;
  std::vector<dtPolyRef> open;
  int count = 0;
  for (int t = 0; t < mesh.getMaxTiles(); ++t) {
    const dtMeshTile* tile = mesh.getTile(t);
    if (tile == nullptr || tile->header == nullptr) continue;
    const dtPolyRef base = mesh.getPolyRefBase(tile);
    for (int i = 0; i < tile->header->polyCount; ++i) {
      const dtPolyRef first = base | static_cast<dtPolyRef>(i);
      if (!part.emplace(first, count).second) continue;
      open.push_back(first);
      while (!open.empty()) {
        const dtPolyRef ref = open.back();
        open.pop_back();
        const dtMeshTile* at = nullptr;
        const dtPoly* poly = nullptr;
        mesh.getTileAndPolyByRefUnsafe(ref, &at, &poly);
        for (unsigned k = poly->firstLink; k != DT_NULL_LINK; k = at->links[k].next) {
          const dtPolyRef next = at->links[k].ref;
          if (next != 0 && part.emplace(next, count).second) open.push_back(next);
        }
      }
      ++count;
    }
  }
  impl_->part_of_poly.assign(part.begin(), part.end());
  impl_->parts.assign(static_cast<size_t>(count), {});
  impl_->largest = 0;
  for (const auto& [ref, number] : part) {
    const dtMeshTile* at = nullptr;
    const dtPoly* poly = nullptr;
    mesh.getTileAndPolyByRefUnsafe(ref, &at, &poly);
    Impl::Part& own = impl_->parts[static_cast<size_t>(number)];
    const double sum = own.area() + area_of(*at, *poly);
    own.polys.push_back(ref);
    own.areas.push_back(sum);
  }
  for (size_t i = 1; i < impl_->parts.size(); ++i)
    if (impl_->parts[i].area() > impl_->parts[impl_->largest].area()) impl_->largest = i;
}

double NavMesh::area() const {
  return impl_->parts.empty() ? 0 : impl_->parts[impl_->largest].area();
}

NavPoint NavMesh::nearest(Vec3d p, double reach, double up) const {
  float at[3], on[3];
  to_recast(p, at);
  const float half[3] = {static_cast<float>(reach), static_cast<float>(up),
                         static_cast<float>(reach)};
  dtPolyRef ref = 0;
  impl_->query.findNearestPoly(at, half, &impl_->filter, &ref, on);
  if (ref == 0) return {};
  const NavPoint found{from_recast(on), ref};
  // Detour takes what is near in its own measure, which is larger above and below.
  if (std::abs(found.p.z - p.z) > up || flat_norm(found.p - p) > 1.42 * reach) return {};
  return found;
}

NavPoint NavMesh::nearest(Vec3d p) const {
  const NavBounds& b = impl_->settings.bounds;
  const Vec3d in{std::clamp(p.x, double{b.low.x}, double{b.high.x}),
                 std::clamp(p.y, double{b.low.y}, double{b.high.y}),
                 std::clamp(p.z, double{b.low.z}, double{b.high.z})};
  const double all = std::max(b.high.x - b.low.x, b.high.y - b.low.y) + 1;
  // Rather some way off on the same floor than near on another.
  for (const double reach : {1.0, 4.0, 16.0, 64.0, 256.0})
    if (const NavPoint found = nearest(in, reach, 3); found.ref != 0) return found;
  return nearest(in, all, std::max(all, double{b.high.z - b.low.z} + 1));
}

// -1 = of none.
int NavMesh::part_of(const NavPoint& point) const {
  const auto found = std::lower_bound(impl_->part_of_poly.begin(), impl_->part_of_poly.end(),
                                      std::pair<dtPolyRef, int>(point.ref, 0));
  const bool is_there = point.ref != 0 && found != impl_->part_of_poly.end();
  return is_there && found->first == point.ref ? found->second : -1;
}

double NavMesh::area_around(const NavPoint& point) const {
  const int part = part_of(point);
  return part >= 0 ? impl_->parts[static_cast<size_t>(part)].area() : 0;
}

bool NavMesh::are_connected(const NavPoint& a, const NavPoint& b) const {
  return part_of(a) >= 0 && part_of(a) == part_of(b);
}

NavPoint NavMesh::random_point(const NavPoint& from, double u, double v, double w) const {
  if (impl_->parts.empty()) return {};
  const int number = part_of(from);
  const Impl::Part& part = impl_->parts[number >= 0 ? static_cast<size_t>(number) : impl_->largest];
  const auto row = static_cast<size_t>(
      std::upper_bound(part.areas.begin(), part.areas.end() - 1, u * part.area()) -
      part.areas.begin());
  const dtPolyRef ref = part.polys[row];
  const dtMeshTile* tile = nullptr;
  const dtPoly* poly = nullptr;
  impl_->mesh->getTileAndPolyByRefUnsafe(ref, &tile, &poly);
  float corners[3 * DT_VERTS_PER_POLYGON], areas_of[DT_VERTS_PER_POLYGON], p[3];
  for (int i = 0; i < poly->vertCount; ++i)
    std::copy_n(tile->verts + 3 * poly->verts[i], 3, corners + 3 * i);
  dtRandomPointInConvexPoly(corners, poly->vertCount, areas_of, static_cast<float>(v),
                            static_cast<float>(w), p);
  float height = p[1];
  if (dtStatusSucceed(impl_->query.getPolyHeight(ref, p, &height))) p[1] = height;
  return {from_recast(p), ref};
}

}  // namespace gloam
