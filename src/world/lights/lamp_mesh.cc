#include "world/lights/lamp_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/mesh/model_file.h"

namespace gloam {
namespace {

Vec3f flat(double x, double y) { return {static_cast<float>(x), static_cast<float>(y), 0}; }

constexpr uint64_t kMostTriangles = uint64_t{1} << 22;

/// `mesh` moved into F. A mirror turns the triangles, so that their outside stays outside.
void append(const TriangleMesh& mesh, const Affine3f& X_FI, TriangleMesh* out) {
  const auto first = static_cast<uint32_t>(out->positions.size());
  for (const Vec3f& p : mesh.positions) out->positions.push_back(transform_point(X_FI, p));
  const bool mirrored = dot(cross(X_FI.x, X_FI.y), X_FI.z) < 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    out->indices.insert(out->indices.end(), {first + mesh.indices[i], first + (mirrored ? c : b),
                                             first + (mirrored ? b : c)});
  }
}

}  // namespace

TriangleMesh rect_lamp(double width, double height) {
  TriangleMesh mesh;
  const double x = width / 2, y = height / 2;
  mesh.positions = {flat(-x, -y), flat(x, -y), flat(x, y), flat(-x, y)};
  mesh.indices = {0, 2, 1, 0, 3, 2};
  return mesh;
}

TriangleMesh disk_lamp(double radius) {
  constexpr uint32_t kCorners = 64;
  constexpr double kStep = 2 * M_PI / kCorners;
  const double reach = radius * std::sqrt(kStep / std::sin(kStep));
  TriangleMesh mesh;
  mesh.positions = {flat(0, 0)};
  for (uint32_t i = 0; i < kCorners; ++i) {
    mesh.positions.push_back(flat(reach * std::cos(kStep * i), reach * std::sin(kStep * i)));
    mesh.indices.insert(mesh.indices.end(), {0, 1 + (i + 1) % kCorners, 1 + i});
  }
  return mesh;
}

Result<TriangleMesh> read_lamp(const std::filesystem::path& path) {
  ModelFileOptions options;
  options.limits.triangles = options.limits.vertices = kMostTriangles;
  GLOAM_TRY(const ModelFile file, read_model_file(path, options));
  uint64_t size = 0;  // many instances of one mesh take memory that the file's own does not show
  for (const ImportedInstance& instance : file.instances) {
    const TriangleMesh& mesh = file.meshes[static_cast<size_t>(instance.mesh)];
    size += std::max<uint64_t>(mesh.triangle_count(), mesh.positions.size());
  }
  if (size > kMostTriangles) {
    return Error{ErrorKind::kInput,
                 fmt::format("'{}' has more than {} triangles or vertices, too many for a lamp",
                             path.filename().string(), kMostTriangles)};
  }
  TriangleMesh out;
  for (const ImportedInstance& instance : file.instances)
    append(file.meshes[static_cast<size_t>(instance.mesh)], instance.X_FI, &out);
  if (!(area_of(out) > 0)) {
    return Error{ErrorKind::kInput, fmt::format("there is no triangle that can emit light in '{}'",
                                                path.filename().string())};
  }
  return out;
}

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3f a = mesh.positions[mesh.indices[i]];
    area += 0.5 * length(cross(mesh.positions[mesh.indices[i + 1]] - a,
                               mesh.positions[mesh.indices[i + 2]] - a));
  }
  return area;
}

}  // namespace gloam
