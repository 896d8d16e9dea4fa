#include "geometry/convert/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "geometry/convert/closest_point.h"
#include "geometry/convert/decompose.h"
#include "geometry/convert/fit.h"
#include "geometry/convert/hull.h"
#include "geometry/convert/pieces.h"
#include "geometry/convert/room.h"
#include "geometry/mesh/weld.h"

namespace gloam {
namespace {

constexpr double kShapeTolerance = 0.01;  // distance of surfaces that count as one, of the size
constexpr double kFlatThickness = 1e-4;   // thickness of a flat mesh, of the longest side
constexpr double kPlateThickness = 1e-3;  // thickness that it gets, of the longest side
constexpr double kHullTolerance = 1e-5;   // gap of the hull of the mesh, over the diagonal
constexpr double kColliderHullTolerance = 1e-3;  // gap of a hull, over the longest side
constexpr double kWeldTolerance = 1e-6;          // between vertices that are one, of the diagonal
constexpr double kMinRoomVolume =
    0.25;  // volume that an open room encloses at least, over its hull's
// Vertices of nearly one place along the sweep that are compared.
constexpr size_t kMaxSweepCandidates = 4096;
constexpr double kMaxCoordinate = 1e9;  // [m] a vertex from the origin
constexpr int kHullVertices = 128;      // vertices of a collider
constexpr size_t kSamples = 4096;       // samples of a surface, to find its shape

double diagonal(const TriangleMesh& mesh) {
  Vec3f low = mesh.positions[0], high = low;
  for (const Vec3f p : mesh.positions) {
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
  }
  return length(high - low);
}

// Joins vertices closer than a millionth of the mesh's size. They are sorted along a line, so that
// neighbours are close in the list. The line is oblique, so that the rows of a grid stay apart.
TriangleMesh without_seams(TriangleMesh mesh) {
  const std::vector<Vec3f>& p = mesh.positions;
  const auto near = static_cast<float>(kWeldTolerance * diagonal(mesh));
  constexpr Vec3f kLine{0.7309f, 0.5413f, 0.4155f};  // direction of length 1
  std::vector<float> along;
  for (const Vec3f q : p) along.push_back(dot(q - p[0], kLine));
  std::vector<uint32_t> order(p.size()), vertex(p.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return along[a] < along[b]; });
  std::iota(vertex.begin(), vertex.end(), 0);
  for (size_t i = 0; i < order.size(); ++i) {
    const uint32_t a = order[i];
    for (size_t k = i;
         k-- > 0 && along[a] - along[order[k]] <= 2 * near && i - k < kMaxSweepCandidates;) {
      const uint32_t b = order[k];
      if (vertex[b] == b && length(p[a] - p[b]) <= near) {
        vertex[a] = b;
        break;
      }
    }
  }
  TriangleMesh out;
  out.positions = mesh.positions;
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const uint32_t a = vertex[mesh.indices[t]], b = vertex[mesh.indices[t + 1]],
                   c = vertex[mesh.indices[t + 2]];
    if (a != b && b != c && c != a) out.indices.insert(out.indices.end(), {a, b, c});
  }
  return out;
}

// Corners at the same place, but for rounding, become one vertex; triangles without area go.
Result<TriangleMesh> welded(const TriangleMesh& mesh) {
  std::vector<Vec3f> corners;
  corners.reserve(mesh.indices.size());
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const Vec3f a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                c = mesh.positions[mesh.indices[t + 2]];
    for (const Vec3f p : {a, b, c}) {
      const double far = max_component(Vec3f{std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      if (std::isnan(p.x) || std::isnan(p.y) || std::isnan(p.z))
        return Error{ErrorKind::kInput, "has a vertex that is not a number"};
      if (far > kMaxCoordinate)
        return Error{ErrorKind::kInput,
                     fmt::format("has a vertex {:.2g} m from its origin", far),
                     {},
                     "set 'unit' to the length of one unit of the file in metres"};
    }
    if (a == b || b == c || c == a) continue;
    corners.insert(corners.end(), {a, b, c});
  }
  if (corners.empty()) return Error{ErrorKind::kInput, "has no triangles"};
  return without_seams(weld(corners));
}

double longest_side(const MeshCollider& box) {
  return 2 * std::max({box.size.x, box.size.y, box.size.z});
}
double shortest_side(const MeshCollider& box) {
  return 2 * std::min({box.size.x, box.size.y, box.size.z});
}

// A flat mesh with a back and walls along its rim, `thickness` apart.
TriangleMesh plate_of(const TriangleMesh& flat, double thickness) {
  Vec3d normal;
  for (size_t t = 0; t < flat.triangle_count(); ++t) {
    const Triangle3d c = triangle_of(flat, t);
    const Vec3d n = cross(c[1] - c[0], c[2] - c[0]);
    if (length_squared(n) > length_squared(normal)) normal = n;
  }
  normal = normal * (thickness / 2 / std::sqrt(length_squared(normal)));
  const Vec3f up{static_cast<float>(normal.x), static_cast<float>(normal.y),
                 static_cast<float>(normal.z)};
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  for (size_t t = 0; t + 2 < flat.indices.size(); t += 3)
    for (size_t k = 0; k < 3; ++k)
      edges.emplace_back(flat.indices[t + k], flat.indices[t + (k + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  TriangleMesh out;
  const auto count = static_cast<uint32_t>(flat.positions.size());
  for (const Vec3f p : flat.positions) out.positions.push_back(p + up);
  for (const Vec3f p : flat.positions) out.positions.push_back(p - up);
  out.indices = flat.indices;
  for (size_t t = 0; t + 2 < flat.indices.size(); t += 3)
    for (const size_t k : {t, t + 2, t + 1}) out.indices.push_back(flat.indices[k] + count);
  for (const auto& [a, b] : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(b, a)))
      out.indices.insert(out.indices.end(), {a, a + count, b, b, a + count, b + count});
  return out;
}

class Converter {
 public:
  explicit Converter(const ConvertOptions& options) : options_(options) {}

  Result<Converted> convert(const TriangleMesh& mesh) {
    GLOAM_TRY_STATUS(go_on());
    GLOAM_TRY(out_.mesh, welded(mesh));
    GLOAM_TRY_STATUS(go_on());
    GLOAM_TRY_STATUS(find_hull());
    GLOAM_TRY_STATUS(go_on());
    find_mass();
    GLOAM_TRY_STATUS(go_on());
    GLOAM_TRY_STATUS(add_colliders());
    return std::move(out_);
  }

 private:
  Status go_on() const {
    if (options_.is_cancelled == nullptr || !*options_.is_cancelled) return {};
    return Error{ErrorKind::kInterrupted, "the conversion was cancelled"};
  }

  Status find_hull() {
    hull_ = convex_hull(out_.mesh.positions, {.tolerance = kHullTolerance * diagonal(out_.mesh)});
    if (!hull_.indices.empty()) box_ = box_around(hull_);
    if (!hull_.indices.empty() && shortest_side(box_) >= kFlatThickness * longest_side(box_))
      return {};
    const double thickness = kPlateThickness * diagonal(out_.mesh);
    const TriangleMesh plate = plate_of(out_.mesh, thickness);
    const bool is_finite = std::all_of(plate.positions.begin(), plate.positions.end(),
                                       [](Vec3f p) { return std::isfinite(p.x + p.y + p.z); });
    if (is_finite) hull_ = convex_hull(plate.positions);
    if (!is_finite || hull_.indices.empty())
      return Error{ErrorKind::kInput, "has no extent: all vertices lie on a line"};
    out_.mesh = plate;
    box_ = box_around(hull_);
    out_.notes.push_back(
        fmt::format("is flat: it is represented by a plate {:.2g} m thick", thickness));
    return {};
  }

  void find_mass() {
    const EdgeCount edges = count_edges(out_.mesh);
    MassProperties mass = mass_properties(out_.mesh);
    out_.is_room = options_.may_be_room && is_room_sized(out_.mesh) &&
                   (edges.is_closed() ? mass.volume < 0
                                      : enclosed_volume(out_.mesh) <
                                            -kMinRoomVolume * mass_properties(hull_).volume);
    if (out_.is_room) {
      out_.is_closed = edges.is_closed();
      out_.mass = mass_properties(hull_);
      out_.notes.push_back(
          fmt::format("faces inwards{}: it is treated as a room, whose faces are colliders",
                      out_.is_closed ? "" : " and is not closed"));
      return;
    }
    if (edges.is_closed() && mass.volume < 0) {
      out_.notes.emplace_back("faces inwards: its triangles are flipped");
      for (size_t i = 0; i + 2 < out_.mesh.indices.size(); i += 3)
        std::swap(out_.mesh.indices[i + 1], out_.mesh.indices[i + 2]);
      mass = mass_properties(out_.mesh);
    }
    out_.is_closed = edges.is_closed() && is_physical(mass);
    out_.mass = out_.is_closed ? mass : mass_properties(hull_);
    if (edges.open > 0)
      out_.notes.push_back(fmt::format(
          "is open ({} edges with one triangle): volume and mass are computed from its hull",
          edges.open));
    if (edges.tangled > 0)
      out_.notes.push_back(
          fmt::format("is not a manifold ({} edges where more than two triangles meet, or two of "
                      "opposite orientation): volume and mass are computed from its hull",
                      edges.tangled));
    if (edges.is_closed() && !out_.is_closed)
      out_.notes.emplace_back("intersects itself: volume and mass are computed from its hull");
  }

  Status add_colliders() {
    const std::string& kind = options_.colliders;
    if (kind == "none") return {};
    if (out_.is_room) {
      out_.colliders = slabs_behind(out_.mesh, out_.is_closed);
      return {};
    }
    if (kind == "box") return add(box_);
    if (kind == "sphere") return add(sphere_around(hull_));
    if (kind == "capsule") return add(capsule_around(hull_));
    if (kind == "hull") return add(hull_of(hull_.positions));
    if (kind == "auto") {
      if (std::optional<MeshCollider> shape = recognised()) return add(std::move(*shape));
    }
    if (out_.mesh.triangle_count() > kMostDecomposed)
      out_.notes.push_back(
          fmt::format("has {} triangles: it is simplified to at most {} before it is decomposed",
                      out_.mesh.triangle_count(), kMostDecomposed));
    GLOAM_TRY(const std::vector<TriangleMesh> parts, find_parts());
    for (const TriangleMesh& part : parts) {
      MeshCollider collider = hull_of(part.positions);
      // A part that is thin beside the whole would have no volume for MuJoCo.
      if (!collider.hull.indices.empty()) GLOAM_TRY_STATUS(add(std::move(collider)));
    }
    return {};
  }

  // Pieces that are convex are parts as they are. CoACD gets the others one by one, each with its
  // share of the hulls: where pieces cross each other its search would take minutes.
  Result<std::vector<TriangleMesh>> find_parts() {
    constexpr size_t kMostPieces = 256;
    Pieces pieces = pieces_of(out_.mesh, options_.concavity);
    if (!pieces.open.indices.empty()) pieces.closed.push_back(std::move(pieces.open));
    if (pieces.convex.size() + pieces.closed.size() > kMostPieces)
      return decompose(out_.mesh, {options_.concavity, options_.max_hulls, options_.is_cancelled});
    std::vector<TriangleMesh> parts = std::move(pieces.convex);
    const int left = options_.max_hulls - static_cast<int>(parts.size());
    const int share = left / std::max(1, static_cast<int>(pieces.closed.size()));
    for (const TriangleMesh& piece : pieces.closed) {
      GLOAM_TRY_STATUS(go_on());
      GLOAM_TRY(std::vector<TriangleMesh> found,
                decompose(piece, {options_.concavity, std::max(1, share), options_.is_cancelled}));
      for (TriangleMesh& part : found) parts.push_back(std::move(part));
    }
    return merge_hulls(std::move(parts), static_cast<size_t>(options_.max_hulls));
  }

  Status add(MeshCollider collider) {
    out_.colliders.push_back(std::move(collider));
    return {};
  }

  MeshCollider hull_of(const std::vector<Vec3f>& points) const {
    MeshCollider out;
    out.hull = convex_hull(points, {.vertices = kHullVertices,
                                    .tolerance = kColliderHullTolerance * longest_side(box_)});
    return out;
  }

  // The simplest shape that the mesh is, if any, its own hull the last. What the shape has and the
  // mesh has not, such as a missing lid, counts as well as the other way.
  std::optional<MeshCollider> recognised() {
    const double most = kShapeTolerance * longest_side(box_);
    const std::vector<SurfacePoint> samples = sample_surface(out_.mesh, kSamples);
    std::optional<MeshQueries> mesh;
    const auto is_alike = [&](const MeshCollider& shape) {
      const ColliderDistance distance(shape);
      const auto is_near = [&](Vec3d p) { return std::abs(distance(p)) < most; };
      const size_t stride = out_.mesh.positions.size() / kSamples + 1;
      for (size_t i = 0; i < out_.mesh.positions.size(); i += stride) {
        const Vec3f p = out_.mesh.positions[i];
        if (!is_near({p.x, p.y, p.z})) return false;
      }
      if (!std::all_of(samples.begin(), samples.end(),
                       [&](const SurfacePoint& s) { return is_near(s.p); }))
        return false;
      if (!mesh) mesh.emplace(out_.mesh);
      const std::vector<SurfacePoint> own = sample_surface(surface_of(shape), kSamples);
      return std::all_of(own.begin(), own.end(), [&](const SurfacePoint& s) {
        return mesh->distance(s.p, 2 * most) < most;
      });
    };
    if (is_alike(box_)) return box_;
    for (MeshCollider (*const around)(const TriangleMesh&) :
         {&sphere_around, &cylinder_around, &capsule_around}) {
      MeshCollider shape = around(hull_);
      if (is_alike(shape)) return shape;
    }
    MeshCollider hull = hull_of(hull_.positions);
    if (is_alike(hull)) return hull;
    return {};
  }

  const ConvertOptions& options_;
  Converted out_;
  TriangleMesh hull_;
  MeshCollider box_;
};

}  // namespace

Result<Converted> convert_mesh(const TriangleMesh& mesh, const ConvertOptions& options) {
  return Converter(options).convert(mesh);
}

}  // namespace gloam
