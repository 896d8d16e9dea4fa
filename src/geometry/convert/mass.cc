#include "geometry/convert/mass.h"

#include <algorithm>
#include <cmath>

namespace gloam {

EdgeCount count_edges(const TriangleMesh& welded) {
  // An edge is its two vertices, the smaller first, and in the last bit which way it is walked.
  std::vector<uint64_t> edges;
  edges.reserve(welded.indices.size());
  for (size_t t = 0; t + 2 < welded.indices.size(); t += 3) {
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t a = welded.indices[t + k], b = welded.indices[t + (k + 1) % 3];
      edges.push_back((std::min(a, b) << 33) | (std::max(a, b) << 1) | uint64_t{a > b});
    }
  }
  std::sort(edges.begin(), edges.end());
  EdgeCount out;
  for (size_t i = 0; i < edges.size();) {
    size_t end = i, backwards = 0;
    for (; end < edges.size() && edges[end] >> 1 == edges[i] >> 1; ++end)
      backwards += edges[end] & 1;
    if (end - i == 1) ++out.open;
    if (end - i > 2 || (end - i == 2 && backwards != 1)) ++out.tangled;
    i = end;
  }
  return out;
}

MassProperties mass_properties(const TriangleMesh& mesh) {
  MassProperties out;
  if (mesh.positions.empty()) return out;
  // Tetrahedra over the triangles, from a point nearby, lest large coordinates cancel.
  const auto wide = [](Vec3f p) { return Vec3d{p.x, p.y, p.z}; };
  const Vec3d origin = wide(mesh.positions[0]);
  Vec3d first;                     // integral of x
  std::array<double, 6> second{};  // integrals of xx yy zz xy xz yz
  double volume = 0;
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const Vec3d a = wide(mesh.positions[mesh.indices[t]]) - origin;
    const Vec3d b = wide(mesh.positions[mesh.indices[t + 1]]) - origin;
    const Vec3d c = wide(mesh.positions[mesh.indices[t + 2]]) - origin;
    const double six = dot(a, cross(b, c));  // volumes
    const Vec3d sum = a + b + c;
    volume += six / 6;
    first += sum * (six / 24);
    const auto add = [&](size_t k, int i, int j) {
      second[k] += six / 120 * (sum[i] * sum[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    };
    add(0, 0, 0), add(1, 1, 1), add(2, 2, 2), add(3, 0, 1), add(4, 0, 2), add(5, 1, 2);
  }
  out.volume = volume;
  if (volume == 0) return out;
  const Vec3d c = first * (1 / volume);
  out.center = c + origin;
  const double xx = second[0] - volume * c.x * c.x, yy = second[1] - volume * c.y * c.y,
               zz = second[2] - volume * c.z * c.z;
  out.inertia = {yy + zz,
                 xx + zz,
                 xx + yy,
                 volume * c.x * c.y - second[3],
                 volume * c.x * c.z - second[4],
                 volume * c.y * c.z - second[5]};
  return out;
}

bool is_physical(const MassProperties& mass) {
  if (!(mass.volume > 0)) return false;
  // xx, yy, zz of the second moments must be positive definite: by leading minors.
  const auto& i = mass.inertia;
  const double half = (i[0] + i[1] + i[2]) / 2;
  const double xx = half - i[0], yy = half - i[1], zz = half - i[2];
  const double xy = -i[3], xz = -i[4], yz = -i[5];
  const double minor = xx * yy - xy * xy;
  const double det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  return xx > 0 && minor > 0 && det > 0;
}

}  // namespace gloam
