#include "world/shapes/implicit_mesh.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

float distance_to(const RoundSolid& s, Vec3f p) {
  const Vec3f scale{s.flat, 1, 1};
  const Vec3f a = s.a * scale, ab = s.b * scale - a, ap = p * scale - a;
  const float along = dot(ab, ab);
  const float t = along > 0 ? clamp(dot(ap, ab) / along, 0, 1) : 0;
  return length(ap - ab * t) - (s.ra + (s.rb - s.ra) * t);
}

float blended(float a, float b, float k) {
  const float h = max(k - std::abs(a - b), 0) / k;
  return min(a, b) - 0.25f * h * h * k;
}

}  // namespace

float ImplicitShape::distance(Vec3f p) const {
  float d = 1e9f;
  for (const RoundSolid& solid : solids) d = blended(d, distance_to(solid, p), blend);
  for (const CutPlane& cut : cuts) d = max(d, dot(cut.p - p, cut.n));
  return d;
}

TriangleMesh mesh_of(const ImplicitShape& shape, float cell) {
  TriangleMesh mesh;
  Vec3f low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  for (const RoundSolid& s : shape.solids) {
    for (const auto& [p, r] : {std::pair(s.a, s.ra), std::pair(s.b, s.rb)}) {
      const float reach = r + 2 * cell + 0.25f * shape.blend;
      low = {min(low.x, p.x - reach), min(low.y, p.y - reach), min(low.z, p.z - reach)};
      high = {max(high.x, p.x + reach), max(high.y, p.y + reach), max(high.z, p.z + reach)};
    }
  }
  const auto count = [&](float edge) { return static_cast<int>(std::ceil(edge / cell)) + 1; };
  const int nx = count(high.x - low.x), ny = count(high.y - low.y), nz = count(high.z - low.z);
  const auto at = [&](int x, int y, int z) { return static_cast<size_t>((z * ny + y) * nx + x); };
  const auto point = [&](int x, int y, int z) {
    return low + Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * cell;
  };
  std::vector<float> field(static_cast<size_t>(nx) * static_cast<size_t>(ny) *
                           static_cast<size_t>(nz));
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) field[at(x, y, z)] = shape.distance(point(x, y, z));

  // A vertex in each cell that the surface goes through: the middle of where it crosses the edges,
  // then moved onto the surface.
  std::vector<int> vertex(field.size(), -1);
  for (int z = 0; z + 1 < nz; ++z) {
    for (int y = 0; y + 1 < ny; ++y) {
      for (int x = 0; x + 1 < nx; ++x) {
        Vec3f sum;
        int crossings = 0;
        const auto cross_edge = [&](int ax, int ay, int az, int bx, int by, int bz) {
          const float a = field[at(x + ax, y + ay, z + az)], b = field[at(x + bx, y + by, z + bz)];
          if ((a < 0) == (b < 0)) return;
          sum += lerp(point(x + ax, y + ay, z + az), point(x + bx, y + by, z + bz), a / (a - b));
          ++crossings;
        };
        for (int i = 0; i < 2; ++i) {
          for (int k = 0; k < 2; ++k) {
            cross_edge(0, i, k, 1, i, k);
            cross_edge(i, 0, k, i, 1, k);
            cross_edge(i, k, 0, i, k, 1);
          }
        }
        if (crossings == 0) continue;
        Vec3f p = sum * (1.0f / static_cast<float>(crossings));
        const float e = 0.1f * cell;
        for (int step = 0; step < 2; ++step) {
          const float d = shape.distance(p);
          const Vec3f gradient{shape.distance(p + Vec3f{e, 0, 0}) - d,
                               shape.distance(p + Vec3f{0, e, 0}) - d,
                               shape.distance(p + Vec3f{0, 0, e}) - d};
          const float square = dot(gradient, gradient) / (e * e);
          if (!(square > 0.1f)) break;
          const float move = clamp(d / square, -0.3f * cell, 0.3f * cell) / e;
          p = p - gradient * move;
        }
        vertex[at(x, y, z)] = static_cast<int>(mesh.positions.size());
        mesh.positions.push_back(p);
      }
    }
  }
  // A square between the four cells around each edge that is crossed, seen from outside.
  const auto add = [&](bool turned, size_t a, size_t b, size_t c, size_t d) {
    const auto v = [&](size_t i) { return static_cast<uint32_t>(vertex[i]); };
    if (turned) std::swap(b, d);
    for (const size_t i : {a, b, c, a, c, d}) mesh.indices.push_back(v(i));
  };
  for (int z = 1; z + 1 < nz; ++z) {
    for (int y = 1; y + 1 < ny; ++y) {
      for (int x = 1; x + 1 < nx; ++x) {
        const bool in = field[at(x, y, z)] < 0;
        if (in != (field[at(x + 1, y, z)] < 0))
          add(!in, at(x, y - 1, z - 1), at(x, y, z - 1), at(x, y, z), at(x, y - 1, z));
        if (in != (field[at(x, y + 1, z)] < 0))
          add(!in, at(x - 1, y, z - 1), at(x - 1, y, z), at(x, y, z), at(x, y, z - 1));
        if (in != (field[at(x, y, z + 1)] < 0))
          add(!in, at(x - 1, y - 1, z), at(x, y - 1, z), at(x, y, z), at(x - 1, y, z));
      }
    }
  }
  return mesh;
}

}  // namespace gloam
