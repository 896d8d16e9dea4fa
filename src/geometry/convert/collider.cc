#include "geometry/convert/collider.h"

#include <algorithm>
#include <cmath>

#include "geometry/convert/closest_point.h"
#include "geometry/convert/mass.h"
#include "geometry/solid.h"

namespace gloam {
namespace {

constexpr int kSegments = 96;  // segments of round surfaces: 0.05 % of the radius inside

Vec3d local(const AffineOf<double>& X, Vec3d p) {
  const Vec3d d = p - X.p;
  return {dot(d, X.x), dot(d, X.y), dot(d, X.z)};
}

Profile capsule_profile(float radius, float half) {
  constexpr int kHalf = kSegments / 2;
  Profile out;
  for (int i = 0; i <= kHalf; ++i) {
    const float angle = kPi * (static_cast<float>(i) / static_cast<float>(kHalf) - 0.5f);
    if (i == kSegments / 4 && half > 0) out.push_back({radius, -half});
    const float z = std::sin(angle) * radius + (2 * i < kHalf ? -half : half);
    out.push_back({i % kHalf == 0 ? 0 : std::cos(angle) * radius, z});
  }
  return out;
}

}  // namespace

const char* word_of(MeshColliderType type) {
  constexpr const char* kWords[] = {"box", "sphere", "cylinder", "capsule", "hull"};
  return kWords[static_cast<size_t>(type)];
}

double volume_of(const MeshCollider& c) {
  const double r = c.size.x;
  switch (c.type) {
    case MeshColliderType::kBox:
      return 8 * c.size.x * c.size.y * c.size.z;
    case MeshColliderType::kSphere:
      return 4 * M_PI * r * r * r / 3;
    case MeshColliderType::kCylinder:
      return M_PI * r * r * 2 * c.size.y;
    case MeshColliderType::kCapsule:
      return M_PI * r * r * (2 * c.size.y + 4 * r / 3);
    case MeshColliderType::kHull:
      return mass_properties(c.hull).volume;
  }
  return 0;
}

TriangleMesh surface_of(const MeshCollider& c) {
  if (c.type == MeshColliderType::kHull) return c.hull;
  const auto r = static_cast<float>(c.size.x), half = static_cast<float>(c.size.y);
  TriangleMesh mesh;
  if (c.type == MeshColliderType::kBox)
    mesh = rounded_box({2 * r, 2 * half, 2 * static_cast<float>(c.size.z)}, 0).mesh();
  if (c.type == MeshColliderType::kSphere) mesh = lathe(capsule_profile(r, 0), kSegments).mesh();
  if (c.type == MeshColliderType::kCapsule)
    mesh = lathe(capsule_profile(r, half), kSegments).mesh();
  if (c.type == MeshColliderType::kCylinder)
    mesh = sharp_lathe({{0, -half}, {r, -half}, {r, half}, {0, half}}, kSegments).mesh();
  TriangleMesh out;
  out.indices = std::move(mesh.indices);
  for (const Vec3f p : mesh.positions) {
    const Vec3d at = transform_point(c.X_MG, Vec3d{p.x, p.y, p.z});
    out.positions.push_back(
        {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)});
  }
  return out;
}

ColliderDistance::ColliderDistance(const MeshCollider& collider) : collider_(collider) {
  const TriangleMesh& hull = collider.hull;
  for (size_t t = 0; t + 2 < hull.indices.size(); t += 3) {
    const auto at = [&](size_t k) {
      const Vec3f p = hull.positions[hull.indices[t + k]];
      return Vec3d{p.x, p.y, p.z};
    };
    const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
    const double l = length_of(normal);
    if (l > 0) planes_.push_back({normal * (1 / l), dot(normal, at(0)) / l});
  }
}

double ColliderDistance::from_hull(Vec3d p) const {
  double highest = -1e300;
  for (const Plane& plane : planes_)
    highest = std::max(highest, dot(plane.normal, p) - plane.offset);
  if (highest <= 0) return highest;
  const TriangleMesh& hull = collider_.hull;
  double nearest = 1e300;
  for (size_t t = 0; t + 2 < hull.indices.size(); t += 3)
    nearest = std::min(nearest, squared_distance(p, triangle_of(hull, t / 3)));
  return std::sqrt(nearest);
}

double ColliderDistance::operator()(Vec3d p_M) const {
  if (collider_.type == MeshColliderType::kHull) return from_hull(p_M);
  const Vec3d p = local(collider_.X_MG, p_M);
  const Vec3d& size = collider_.size;
  const auto box = [](double x, double y, double z) {  // excess of a point over each side
    const Vec3d out{std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0)};
    return length_of(out) + std::min(std::max({x, y, z}), 0.0);
  };
  switch (collider_.type) {
    case MeshColliderType::kBox:
      return box(std::abs(p.x) - size.x, std::abs(p.y) - size.y, std::abs(p.z) - size.z);
    case MeshColliderType::kCylinder:
      return box(std::hypot(p.x, p.y) - size.x, std::abs(p.z) - size.y, -1e300);
    case MeshColliderType::kCapsule:
      return length_of({p.x, p.y, p.z - std::clamp(p.z, -size.y, size.y)}) - size.x;
    default:
      return length_of(p) - size.x;
  }
}

Quat quaternion_of(const AffineOf<double>& X) {
  // Shepperd 1978: by the largest of the four, so that nothing cancels.
  const double m[3][3] = {{X.x.x, X.y.x, X.z.x}, {X.x.y, X.y.y, X.z.y}, {X.x.z, X.y.z, X.z.z}};
  const double trace = m[0][0] + m[1][1] + m[2][2];
  double q[4];
  if (trace > std::max({m[0][0], m[1][1], m[2][2]})) {
    q[0] = 1 + trace;
    for (int i = 0; i < 3; ++i)
      q[i + 1] = m[(i + 2) % 3][(i + 1) % 3] - m[(i + 1) % 3][(i + 2) % 3];
  } else {
    const int i = m[0][0] >= m[1][1] && m[0][0] >= m[2][2] ? 0 : m[1][1] >= m[2][2] ? 1 : 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    q[i + 1] = 1 + 2 * m[i][i] - trace;
    q[0] = m[k][j] - m[j][k];
    q[j + 1] = m[j][i] + m[i][j];
    q[k + 1] = m[k][i] + m[i][k];
  }
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
}

}  // namespace gloam
