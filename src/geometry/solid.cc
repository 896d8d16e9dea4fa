#include "geometry/solid.h"

#include <algorithm>
#include <array>

#include "base/rng.h"

namespace gloam {
namespace {

float& at(Vec3f* v, int axis) { return axis == 0 ? v->x : axis == 1 ? v->y : v->z; }

Vec3f unit_or(Vec3f v, Vec3f otherwise) {
  const float size = length(v);
  return size > 1e-12f ? v / size : otherwise;
}

// Area-weighted vertex normals; vertices at one place do not share theirs.
void smooth_normals(TriangleMesh* mesh) {
  mesh->normals.assign(mesh->positions.size(), {});
  for (size_t f = 0; f + 2 < mesh->indices.size(); f += 3) {
    const uint32_t* c = &mesh->indices[f];
    const Vec3f a = mesh->positions[c[0]];
    const Vec3f weighted = cross(mesh->positions[c[1]] - a, mesh->positions[c[2]] - a);
    for (int k = 0; k < 3; ++k) mesh->normals[c[k]] += weighted;
  }
  for (Vec3f& n : mesh->normals) n = unit_or(n, {0, 0, 1});
}

void add_quad(std::vector<uint32_t>* indices, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  indices->insert(indices->end(), {a, b, c, a, c, d});
}

// Six faces of a rounded box whose vertices are where `side` (of the half extents) and `tilt` (of
// the normal) say.
TriangleMesh box_faces(Vec3f half, float radius, const std::vector<float>& side,
                       const std::vector<float>& tilt) {
  TriangleMesh mesh;
  const auto count = static_cast<uint32_t>(side.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      const auto base = static_cast<uint32_t>(mesh.positions.size());
      for (uint32_t row = 0; row < count; ++row) {
        for (uint32_t column = 0; column < count; ++column) {
          Vec3f n;
          at(&n, axis) = sign, at(&n, a) = tilt[column], at(&n, b) = tilt[row];
          n = normalize(n);
          Vec3f p = n * radius;
          at(&p, axis) += sign * (half[axis] - radius);
          at(&p, a) += side[column] * (half[a] - radius);
          at(&p, b) += side[row] * (half[b] - radius);
          mesh.positions.push_back(p);
          mesh.normals.push_back(n);
        }
      }
      for (uint32_t row = 0; row + 1 < count; ++row) {
        for (uint32_t column = 0; column + 1 < count; ++column) {
          const uint32_t i = base + row * count + column;
          if (sign > 0) {
            add_quad(&mesh.indices, i, i + 1, i + count + 1, i + count);
          } else {
            add_quad(&mesh.indices, i, i + count, i + count + 1, i + 1);
          }
        }
      }
    }
  }
  return mesh;
}

// x axis of a frame whose z axis is `z`, without a twist where z is upright.
Vec3f side_of(Vec3f z) {
  return unit_or(cross({0.3f, 0.1f, 1.0f}, z), unit_or(cross({1, 0, 0}, z), {1, 0, 0}));
}

}  // namespace

Solid Solid::moved(float x, float y, float z) const {
  Solid out = *this;
  for (Vec3f& p : out.mesh_.positions) p += {x, y, z};
  return out;
}

Solid Solid::turned(Axis axis, float degrees) const {
  const float angle = degrees * kPi / 180, c = std::cos(angle), s = std::sin(angle);
  const int k = static_cast<int>(axis), a = (k + 1) % 3, b = (k + 2) % 3;
  const auto turn = [&](Vec3f v) {
    Vec3f out = v;
    at(&out, a) = c * v[a] - s * v[b];
    at(&out, b) = s * v[a] + c * v[b];
    return out;
  };
  Solid out = *this;
  for (Vec3f& p : out.mesh_.positions) p = turn(p);
  for (Vec3f& n : out.mesh_.normals) n = turn(n);
  return out;
}

Solid Solid::scaled(Vec3f by) const {
  Solid out = *this;
  for (Vec3f& p : out.mesh_.positions) p = p * by;
  for (Vec3f& n : out.mesh_.normals) n = normalize(Vec3f{n.x / by.x, n.y / by.y, n.z / by.z});
  return out;
}

Solid Solid::mirrored(Axis axis) const {
  Solid out = *this;
  const int k = static_cast<int>(axis);
  for (Vec3f& p : out.mesh_.positions) at(&p, k) = -p[k];
  for (Vec3f& n : out.mesh_.normals) at(&n, k) = -n[k];
  for (size_t f = 0; f + 2 < out.mesh_.indices.size(); f += 3)
    std::swap(out.mesh_.indices[f + 1], out.mesh_.indices[f + 2]);
  return out;
}

Solid& Solid::operator+=(const Solid& other) {
  const auto base = static_cast<uint32_t>(mesh_.positions.size());
  const TriangleMesh& from = other.mesh_;
  mesh_.positions.insert(mesh_.positions.end(), from.positions.begin(), from.positions.end());
  mesh_.normals.insert(mesh_.normals.end(), from.normals.begin(), from.normals.end());
  if (!mesh_.uvs.empty() || !from.uvs.empty()) {
    mesh_.uvs.resize(base);
    mesh_.uvs.insert(mesh_.uvs.end(), from.uvs.begin(), from.uvs.end());
    mesh_.uvs.resize(mesh_.positions.size());
  }
  for (const uint32_t i : from.indices) mesh_.indices.push_back(base + i);
  return *this;
}

Vec3f Solid::low() const {
  if (mesh_.positions.empty()) return {};
  Vec3f out = mesh_.positions[0];
  for (const Vec3f p : mesh_.positions) out = {min(out.x, p.x), min(out.y, p.y), min(out.z, p.z)};
  return out;
}

Vec3f Solid::high() const {
  if (mesh_.positions.empty()) return {};
  Vec3f out = mesh_.positions[0];
  for (const Vec3f p : mesh_.positions) out = {max(out.x, p.x), max(out.y, p.y), max(out.z, p.z)};
  return out;
}

Solid rounded_box(Vec3f size, float radius, int steps, int cuts) {
  const Vec3f half = size * 0.5f;
  radius = min(radius, 0.999f * min(half.x, min(half.y, half.z)));
  if (radius <= 0) steps = 0;
  std::vector<float> side, tilt;
  // From the middle of the edge, where the normal leans by 45 degrees, to the flat of the face.
  for (int i = 0; i <= steps; ++i) {
    side.push_back(-1);
    tilt.push_back(steps == 0 ? 0 : -std::tan(kPi / 4 * static_cast<float>(steps - i) / steps));
  }
  for (int i = 1; i <= cuts; ++i) {
    side.push_back(-1 + 2 * static_cast<float>(i) / static_cast<float>(cuts + 1));
    tilt.push_back(0);
  }
  for (int i = steps; i >= 0; --i) {
    side.push_back(1);
    tilt.push_back(-tilt[static_cast<size_t>(i)]);
  }
  return Solid(box_faces(half, max(radius, 0.0f), side, tilt));
}

Solid slab(Vec3f low, Vec3f high, float radius, int steps) {
  return rounded_box(high - low, radius, steps).moved((low + high) * 0.5f);
}

Solid cushion(Vec3f size, float bulge, float radius, uint64_t seed, float edge, float wrinkle) {
  TriangleMesh mesh = rounded_box(size, radius, 2, 5).mesh();
  const Vec3f half = size * 0.5f;
  const int thin = half.x <= half.y && half.x <= half.z ? 0 : half.y <= half.z ? 1 : 2;
  const int a = (thin + 1) % 3, b = (thin + 2) % 3;
  const float hollow = edge < 1 ? 0.10f : 0.03f;
  const RandomStream random{seed, stream_id("solid.cushion")};
  std::array<std::array<float, 4>, 5> folds;
  for (uint32_t i = 0; i < 5; ++i)
    for (uint32_t k = 0; k < 4; ++k) folds[i][k] = static_cast<float>(random.uniform(i, k)) * 2 - 1;
  for (Vec3f& p : mesh.positions) {
    const Vec3f q{p.x / half.x, p.y / half.y, p.z / half.z};
    const float qa = min(std::fabs(q[a]), 1.0f), qb = min(std::fabs(q[b]), 1.0f);
    const float dome = (1 - std::pow(qa, 2.4f)) * (1 - std::pow(qb, 2.4f));
    float thick = 1 + bulge * dome - 0.22f * (1 - dome) * qa * qb * qa * qb * qa * qb;
    thick *= edge + (1 - edge) * std::pow(dome, 0.55f);
    at(&p, thin) *= thick;
    at(&p, b) *= 1 - hollow * (1 - qa * qa) * std::pow(qb, 6.0f);
    at(&p, a) *= 1 - hollow * (1 - qb * qb) * std::pow(qa, 6.0f);
    for (const auto& fold : folds) {
      const float wave = 3.5f * (fold[0] * q.x + fold[1] * q.y + fold[2] * q.z) + 3 * fold[3];
      at(&p, thin) += wrinkle * std::sin(wave) * dome;
    }
  }
  // Faces that meet at an edge of the box have the same vertices: one normal for each place.
  TriangleMesh welded = mesh;
  smooth_normals(&welded);
  std::vector<uint32_t> order(mesh.positions.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto less = [&](uint32_t i, uint32_t j) {
    const Vec3f p = mesh.positions[i], q = mesh.positions[j];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z != q.z ? p.z < q.z : i < j;
  };
  std::sort(order.begin(), order.end(), less);
  mesh.normals = welded.normals;
  for (size_t first = 0; first < order.size();) {
    size_t last = first;
    Vec3f sum;
    while (last < order.size() && mesh.positions[order[last]] == mesh.positions[order[first]])
      sum += welded.normals[order[last++]];
    for (size_t i = first; i < last; ++i)
      mesh.normals[order[i]] = unit_or(sum, welded.normals[order[i]]);
    first = last;
  }
  return Solid(std::move(mesh));
}

Solid sheet(std::span<const Vec3f> points, int columns, float thickness) {
  TriangleMesh mesh;
  const auto width = static_cast<uint32_t>(columns);
  const auto rows = static_cast<uint32_t>(points.size()) / width;
  mesh.positions.assign(points.begin(), points.end());
  for (uint32_t row = 0; row < rows; ++row) {
    for (uint32_t column = 0; column < width; ++column)
      mesh.uvs.push_back({static_cast<float>(column) / static_cast<float>(width - 1),
                          static_cast<float>(row) / static_cast<float>(rows - 1)});
  }
  for (uint32_t row = 0; row + 1 < rows; ++row) {
    for (uint32_t column = 0; column + 1 < width; ++column) {
      const uint32_t i = row * width + column;
      add_quad(&mesh.indices, i, i + 1, i + width + 1, i + width);
    }
  }
  smooth_normals(&mesh);
  if (thickness <= 0) return Solid(std::move(mesh));
  TriangleMesh back = mesh;
  for (size_t i = 0; i < back.positions.size(); ++i) {
    back.positions[i] += back.normals[i] * -thickness;
    back.normals[i] = -back.normals[i];
  }
  for (size_t f = 0; f < back.indices.size(); f += 3)
    std::swap(back.indices[f + 1], back.indices[f + 2]);
  Solid out(mesh);
  out += Solid(back);
  // The rim, from front to back.
  std::vector<uint32_t> rim;
  for (uint32_t c = 0; c + 1 < width; ++c) rim.push_back(c);
  for (uint32_t r = 0; r + 1 < rows; ++r) rim.push_back(r * width + width - 1);
  for (uint32_t c = width - 1; c > 0; --c) rim.push_back((rows - 1) * width + c);
  for (uint32_t r = rows - 1; r > 0; --r) rim.push_back(r * width);
  TriangleMesh edge;
  for (size_t k = 0; k < rim.size(); ++k) {
    const uint32_t i = rim[k], j = rim[(k + 1) % rim.size()];
    const auto base = static_cast<uint32_t>(edge.positions.size());
    const Vec3f corners[4] = {back.positions[i], back.positions[j], mesh.positions[j],
                              mesh.positions[i]};
    const Vec3f n = unit_or(cross(corners[1] - corners[0], corners[3] - corners[0]), {0, 0, 1});
    for (const Vec3f p : corners) {
      edge.positions.push_back(p);
      edge.normals.push_back(n);
    }
    add_quad(&edge.indices, base, base + 1, base + 2, base + 3);
  }
  return out += Solid(std::move(edge));
}

Solid panel(float width, float height) {
  const float y = width / 2, z = height / 2;
  const Vec3f corners[4] = {{0, -y, -z}, {0, y, -z}, {0, -y, z}, {0, y, z}};
  return sheet(corners, 2);
}

Solid bar(Vec3f from, Vec3f to, float radius_from, float radius_to, int segments) {
  const Vec3f along = to - from;
  const Solid upright =
      cone(radius_from, radius_to, 0, length(along), min(0.002f, 0.3f * radius_to), segments);
  const Vec3f z = unit_or(along, {0, 0, 1}), x = side_of(z), y = cross(z, x);
  const Affine3f X{x, y, z, from};
  TriangleMesh mesh = upright.mesh();
  for (Vec3f& p : mesh.positions) p = transform_point(X, p);
  for (Vec3f& n : mesh.normals) n = transform_vector(X, n);
  return Solid(std::move(mesh));
}

Solid tube(const Path& path, float radius, int segments) {
  TriangleMesh mesh;
  const size_t count = path.size();
  const auto around = static_cast<uint32_t>(segments + 1);
  Vec3f side;
  Path tangents;
  for (size_t i = 0; i < count; ++i) {
    const Vec3f tangent =
        unit_or(path[std::min(i + 1, count - 1)] - path[i > 0 ? i - 1 : 0], {0, 0, 1});
    tangents.push_back(tangent);
    // Carried along the path, so that the tube does not twist.
    side =
        i == 0 ? side_of(tangent) : unit_or(side - tangent * dot(side, tangent), side_of(tangent));
    const Vec3f up = cross(tangent, side);
    for (uint32_t k = 0; k < around; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(segments);
      const Vec3f n = side * std::cos(angle) + up * std::sin(angle);
      mesh.positions.push_back(path[i] + n * radius);
      mesh.normals.push_back(n);
    }
  }
  for (uint32_t i = 0; i + 1 < count; ++i) {
    for (uint32_t k = 0; k + 1 < around; ++k) {
      const uint32_t j = i * around + k;
      add_quad(&mesh.indices, j, j + 1, j + around + 1, j + around);
    }
  }
  for (const bool end : {false, true}) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    const size_t ring = end ? (count - 1) * around : 0;
    const Vec3f n = end ? tangents.back() : -tangents.front();
    for (uint32_t k = 0; k + 1 < around; ++k) {
      mesh.positions.push_back(mesh.positions[ring + k]);
      mesh.normals.push_back(n);
    }
    for (uint32_t k = 1; k + 2 < around; ++k)
      mesh.indices.insert(mesh.indices.end(),
                          {base, base + (end ? k : k + 1), base + (end ? k + 1 : k)});
  }
  return Solid(std::move(mesh));
}

Path smooth_path(const Path& points, int steps) {
  if (points.size() < 3) return points;
  Path q = points, out;
  q.insert(q.begin(), points[0] * 2.0f - points[1]);
  q.push_back(points.back() * 2.0f - points[points.size() - 2]);
  for (size_t i = 1; i + 2 < q.size(); ++i) {
    const Vec3f a = q[i - 1], b = q[i], c = q[i + 1], d = q[i + 2];
    for (int k = 0; k < steps; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(steps);
      out.push_back((b * 2.0f + (c - a) * t + (a * 2.0f - b * 5.0f + c * 4.0f - d) * (t * t) +
                     (b * 3.0f - a - c * 3.0f + d) * (t * t * t)) *
                    0.5f);
    }
  }
  out.push_back(points.back());
  return out;
}

}  // namespace gloam
