#include "world/shapes/imported_mesh.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace gloam {
namespace {

using Vec3d = Vec3Of<double>;
struct Matrix3d {
  Vec3d x, y, z;  // columns
};

constexpr int64_t kGrain = 1 << 15;
constexpr double kFlat = 1e-9;    // determinant that counts as no volume
constexpr int kStretchBits = 18;  // bits that are kept of a stretch: float's rounding is gone

Matrix3d matrix_of(const Affine3f& X) {
  const auto d = [](Vec3f v) { return Vec3d{v.x, v.y, v.z}; };
  return {d(X.x), d(X.y), d(X.z)};
}
Vec3f to_float(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
double determinant(const Matrix3d& m) { return dot(m.x, cross(m.y, m.z)); }

/// Inverse transpose; the determinant is not 0.
Matrix3d cofactors(const Matrix3d& m) {
  const double inv = 1 / determinant(m);
  return {cross(m.y, m.z) * inv, cross(m.z, m.x) * inv, cross(m.x, m.y) * inv};
}

/// The orthogonal factor of m: Newton's iteration, quadratic once it is near.
Matrix3d rotation_of(Matrix3d m) {
  for (int i = 0; i < 100; ++i) {
    const Matrix3d other = cofactors(m);
    const Matrix3d mean{(m.x + other.x) * 0.5, (m.y + other.y) * 0.5, (m.z + other.z) * 0.5};
    const double change =
        length_squared(mean.x - m.x) + length_squared(mean.y - m.y) + length_squared(mean.z - m.z);
    m = mean;
    if (change < 1e-28) break;
  }
  return m;
}

double largest(const Matrix3d& m) {
  double out = 0;
  for (const Vec3d& v : {m.x, m.y, m.z})
    out = std::max({out, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return out;
}

}  // namespace

bool RigidAndStretch::is_rigid() const {
  return stretch.x == Vec3f{1, 0, 0} && stretch.y == Vec3f{0, 1, 0} && stretch.z == Vec3f{0, 0, 1};
}

RigidAndStretch split_stretch(const Affine3f& X) {
  const Matrix3d m = matrix_of(X);
  const double size = largest(m);
  RigidAndStretch out;
  out.rigid.p = X.p;
  const auto scaled = [](const Matrix3d& a, double by) {
    return Matrix3d{a.x * by, a.y * by, a.z * by};
  };
  if (!(size > 0) || std::abs(determinant(scaled(m, 1 / size))) < kFlat) {
    out.stretch = {X.x, X.y, X.z, {}};
    return out;
  }
  Matrix3d r = rotation_of(scaled(m, 1 / size));
  if (determinant(r) < 0) r = scaled(r, -1);  // the stretch mirrors
  const auto column = [&](const Vec3d& v) {   // column of R^T m
    return Vec3d{dot(r.x, v), dot(r.y, v), dot(r.z, v)};
  };
  const Matrix3d s{column(m.x), column(m.y), column(m.z)};
  const double step = std::ldexp(1.0, std::ilogb(largest(s)) - kStretchBits);
  const auto rounded = [&](const Vec3d& v) {
    return to_float(Vec3d{std::round(v.x / step), std::round(v.y / step), std::round(v.z / step)} *
                    step);
  };
  out.rigid.x = to_float(r.x);
  out.rigid.y = to_float(r.y);
  out.rigid.z = to_float(r.z);
  out.stretch = {rounded(s.x), rounded(s.y), rounded(s.z), {}};
  return out;
}

void bake_mesh(const Affine3f& stretch, const UvUse& uv, TriangleMesh* mesh) {
  const auto count = static_cast<int64_t>(mesh->positions.size());
  const Matrix3d m = matrix_of(stretch);
  const double size = largest(m);
  const double volume = size > 0 ? determinant(m) / (size * size * size) : 0;
  if (!RigidAndStretch{{}, stretch}.is_rigid()) {
    if (std::abs(volume) < kFlat) mesh->normals.clear();
    const Matrix3d n = mesh->normals.empty() ? Matrix3d{} : cofactors(m);
    const bool has_normals = !mesh->normals.empty();
    parallel_for_range("stretch mesh", count, kGrain, [&](int64_t begin, int64_t end) {
      for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
        mesh->positions[i] = transform_vector(stretch, mesh->positions[i]);
        if (!has_normals) continue;
        Vec3f& normal = mesh->normals[i];
        const Vec3d v = n.x * double{normal.x} + n.y * double{normal.y} + n.z * double{normal.z};
        const double l = length(v);
        normal = l > 0 ? to_float(v * (1 / l)) : Vec3f{};
      }
    });
    if (volume < 0)
      for (size_t i = 0; i + 2 < mesh->indices.size(); i += 3)
        std::swap(mesh->indices[i + 1], mesh->indices[i + 2]);
  }
  if (uv.set == 1) mesh->uvs = std::move(mesh->uvs1);
  mesh->uvs1 = {};
  const UvTransform& t = uv.transform;
  const bool moves =
      t.offset.x != 0 || t.offset.y != 0 || t.rotation != 0 || t.scale.x != 1 || t.scale.y != 1;
  if (!moves) return;
  for (Vec2f& at : mesh->uvs) at = transform_uv(t, at);
}

Vec3f half_extents(const TriangleMesh& mesh) {
  if (mesh.positions.empty()) return {};
  Vec3f low = mesh.positions[0], high = low;
  for (const Vec3f& p : mesh.positions) {
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
  }
  return (high - low) * 0.5f;
}

}  // namespace gloam
