#include "render/scene/patterns/faced_triangle.h"

#include <algorithm>
#include <cmath>

#include "render/kernel/surface/baked_lookup.h"
#include "render/scene/patterns/shape_mesh.h"

namespace gloam {
namespace {

/// Whether the normal n is nearest to the face's direction, or so near to it that a hit's may be.
bool leans(const PatternSurface& surface, Vec3f n, int face) {
  const Vec3f along = baking::along_face(n, face);
  const float to_face = (face & 1) != 0 ? -along.z : along.z;
  if (surface.is_sheet) return face == baking::kUp && to_face > 0.05f;
  // Normals of a round shape differ by up to one segment's turn from its facets'.
  const float slack = surface.is_round() ? 1.0f - 4.0f * kPi / kRoundSegments : 0.999f;
  return to_face > 0 && to_face >= slack * max(std::fabs(along.x), std::fabs(along.y));
}

}  // namespace

std::optional<FacedTriangle> FacedTriangle::make(const PatternSurface& surface, uint32_t triangle,
                                                 int face) {
  const TriangleMesh& mesh = *surface.mesh;
  const uint32_t* corner = mesh.indices.data() + 3 * static_cast<size_t>(triangle);
  const Vec3f a = mesh.positions[corner[0]], b = mesh.positions[corner[1]],
              c = mesh.positions[corner[2]];
  const Vec3f normal = cross(b - a, c - a);
  const float twice = length(normal);
  if (!(twice > 1e-14f)) return {};
  FacedTriangle out;
  out.n = normal * (1.0f / twice);
  if (!leans(surface, out.n, face)) return {};
  const Vec3f q[3] = {baking::along_face(a, face), baking::along_face(b, face),
                      baking::along_face(c, face)};
  out.low = out.high = q[0];
  for (const Vec3f& at : {q[1], q[2]}) {
    out.low = {min(out.low.x, at.x), min(out.low.y, at.y), min(out.low.z, at.z)};
    out.high = {max(out.high.x, at.x), max(out.high.y, at.y), max(out.high.z, at.z)};
  }
  const Vec3f n = baking::along_face(out.n, face);
  out.per_u = -n.x / n.z;
  out.per_v = -n.y / n.z;
  out.across = q[0].z - out.per_u * q[0].x - out.per_v * q[0].y;
  const float turn = (q[1].x - q[0].x) * (q[2].y - q[0].y) - (q[1].y - q[0].y) * (q[2].x - q[0].x);
  for (int i = 0; i < 3; ++i) {
    const Vec3f &from = q[i], &to = q[(i + 1) % 3];
    const float du = to.x - from.x, dv = to.y - from.y;
    const float scale = (turn > 0 ? 1.0f : -1.0f) / max(std::sqrt(du * du + dv * dv), 1e-12f);
    out.edge_u[i] = dv * scale;
    out.edge_v[i] = -du * scale;
    out.edge[i] = -(out.edge_u[i] * from.x + out.edge_v[i] * from.y);
  }
  return out;
}

float FacedTriangle::outside(float u, float v) const {
  float most = -1e30f;
  for (int i = 0; i < 3; ++i) most = max(most, edge_u[i] * u + edge_v[i] * v + edge[i]);
  return most;
}

bool FacedTriangle::touches(float u, float v, float half) const {
  if (u + half < low.x || u - half > high.x || v + half < low.y || v - half > high.y) return false;
  for (int i = 0; i < 3; ++i) {
    const float reach = half * (std::fabs(edge_u[i]) + std::fabs(edge_v[i]));
    if (edge_u[i] * u + edge_v[i] * v + edge[i] > reach) return false;
  }
  return true;
}

}  // namespace gloam
