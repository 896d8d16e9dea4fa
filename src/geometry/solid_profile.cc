// Solids from a drawn outline: lathes and extrusions.

#include <algorithm>

#include "geometry/mesh/triangulate.h"
#include "geometry/solid.h"

namespace gloam {
namespace {

float length(Vec2f v) { return std::sqrt(v.x * v.x + v.y * v.y); }
Vec2f unit(Vec2f v) {
  const float size = length(v);
  return size > 1e-12f ? v * (1 / size) : Vec2f{};
}

// One smooth run of a profile.
void add_run(const Profile& run, int segments, TriangleMesh* mesh) {
  const auto base = static_cast<uint32_t>(mesh->positions.size());
  const auto around = static_cast<uint32_t>(segments + 1);
  const size_t count = run.size();
  for (size_t i = 0; i < count; ++i) {
    const Vec2f d = unit(run[std::min(i + 1, count - 1)] - run[i > 0 ? i - 1 : 0]);
    for (uint32_t k = 0; k < around; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(segments);
      const float c = std::cos(angle), s = std::sin(angle);
      mesh->positions.push_back({run[i].x * c, run[i].x * s, run[i].y});
      mesh->normals.push_back({d.y * c, d.y * s, -d.x});
    }
  }
  for (uint32_t i = 0; i + 1 < count; ++i) {
    for (uint32_t k = 0; k + 1 < around; ++k) {
      const uint32_t j = base + i * around + k;
      // On the axis a quad is a triangle.
      if (run[i].x > 0) mesh->indices.insert(mesh->indices.end(), {j, j + 1, j + around + 1});
      if (run[i + 1].x > 0)
        mesh->indices.insert(mesh->indices.end(), {j, j + around + 1, j + around});
    }
  }
}

}  // namespace

Profile rounded(const Profile& corners, float radius, int steps) {
  if (radius <= 0) return corners;
  Profile out{corners.front()};
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec2f a = corners[i - 1], b = corners[i], c = corners[i + 1];
    const Vec2f from = b + unit(a - b) * min(radius, 0.49f * length(a - b));
    const Vec2f to = b + unit(c - b) * min(radius, 0.49f * length(c - b));
    for (int k = 0; k <= steps; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(steps);
      out.push_back(from * ((1 - t) * (1 - t)) + b * (2 * t * (1 - t)) + to * (t * t));
    }
  }
  out.push_back(corners.back());
  return out;
}

Profile rounded_outline(const Profile& corners, float radius, int steps) {
  Profile open{corners.back()};
  open.insert(open.end(), corners.begin(), corners.end());
  open.push_back(corners.front());
  const Profile out = rounded(open, radius, steps);
  return {out.begin() + 1, out.end() - 1};
}

Profile rounded_rectangle(float width, float height, float radius, int steps) {
  radius = min(radius, 0.499f * min(width, height));
  const Vec2f centers[4] = {{width / 2 - radius, height / 2 - radius},
                            {radius - width / 2, height / 2 - radius},
                            {radius - width / 2, radius - height / 2},
                            {width / 2 - radius, radius - height / 2}};
  Profile out;
  for (int corner = 0; corner < 4; ++corner) {
    for (int k = 0; k <= steps; ++k) {
      const float angle =
          kPi / 2 *
          (static_cast<float>(corner) + static_cast<float>(k) / static_cast<float>(steps));
      out.push_back(centers[corner] + Vec2f{std::cos(angle), std::sin(angle)} * radius);
    }
  }
  return out;
}

Profile circle(float radius, int segments) {
  Profile out;
  for (int k = 0; k < segments; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(segments);
    out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return out;
}

Solid lathe(const Profile& profile, int segments) {
  TriangleMesh mesh;
  add_run(profile, segments, &mesh);
  return Solid(std::move(mesh));
}

Solid sharp_lathe(const Profile& profile, int segments) {
  TriangleMesh mesh;
  for (size_t i = 0; i + 1 < profile.size(); ++i)
    add_run({profile[i], profile[i + 1]}, segments, &mesh);
  return Solid(std::move(mesh));
}

Solid cone(float radius_low, float radius_high, float z0, float z1, float bevel, int segments) {
  return lathe(rounded({{0, z0}, {radius_low, z0}, {radius_high, z1}, {0, z1}}, bevel), segments);
}

Solid cylinder(float radius, float z0, float z1, float bevel, int segments) {
  return cone(radius, radius, z0, z1, bevel, segments);
}

Solid ball(float radius, int segments) {
  Profile half;
  const int steps = segments / 2;
  for (int i = 0; i <= steps; ++i) {
    const float angle = kPi * (static_cast<float>(i) / static_cast<float>(steps) - 0.5f);
    half.push_back({i == 0 || i == steps ? 0 : radius * std::cos(angle), radius * std::sin(angle)});
  }
  return lathe(half, segments);
}

Solid loft(const std::vector<Path>& rings) {
  TriangleMesh mesh;
  const auto around = static_cast<uint32_t>(rings.front().size());
  for (const Path& ring : rings)
    mesh.positions.insert(mesh.positions.end(), ring.begin(), ring.end());
  mesh.normals.resize(mesh.positions.size());
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const Vec3f p = mesh.positions[a];
    const Vec3f weighted = cross(mesh.positions[b] - p, mesh.positions[c] - p);
    if (dot(weighted, weighted) < 1e-20f) return;
    for (const uint32_t i : {a, b, c}) mesh.normals[i] += weighted;
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (uint32_t row = 0; row + 1 < rings.size(); ++row) {
    if (rings[row] == rings[row + 1]) continue;
    for (uint32_t k = 0; k < around; ++k) {
      const uint32_t i = row * around + k, j = row * around + (k + 1) % around;
      add(i, j, j + around);
      add(i, j + around, i + around);
    }
  }
  for (uint32_t row = 0; row < rings.size(); ++row) {  // a ring that is a point has one normal
    Vec3f sum;
    bool point = true;
    for (uint32_t k = 0; k < around; ++k) {
      sum += mesh.normals[row * around + k];
      point = point && rings[row][k] == rings[row][0];
    }
    for (uint32_t k = 0; k < around; ++k) {
      Vec3f& n = mesh.normals[row * around + k];
      if (point) n = sum;
      const float squared = dot(n, n);
      n = squared > 1e-24f ? n / std::sqrt(squared) : Vec3f{0, 0, 1};
    }
  }
  return Solid(std::move(mesh));
}

Solid extrude(const Profile& outline, float z0, float z1) {
  constexpr float kSmooth = 0.766f;  // cosine of 40 degrees
  TriangleMesh mesh;
  const size_t count = outline.size();
  const auto normal_of = [&](size_t i) {
    const Vec2f d = unit(outline[(i + 1) % count] - outline[i % count]);
    return Vec2f{d.y, -d.x};
  };
  for (size_t i = 0; i < count; ++i) {
    const Vec2f here = normal_of(i), before = normal_of(i + count - 1), after = normal_of(i + 1);
    const auto blend = [&](Vec2f other) {
      const float cosine = here.x * other.x + here.y * other.y;
      return cosine > kSmooth ? unit(here + other) : here;
    };
    const Vec2f n0 = blend(before), n1 = blend(after), p0 = outline[i],
                p1 = outline[(i + 1) % count];
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(),
                          {{p0.x, p0.y, z0}, {p1.x, p1.y, z0}, {p1.x, p1.y, z1}, {p0.x, p0.y, z1}});
    mesh.normals.insert(mesh.normals.end(),
                        {{n0.x, n0.y, 0}, {n1.x, n1.y, 0}, {n1.x, n1.y, 0}, {n0.x, n0.y, 0}});
    mesh.indices.insert(mesh.indices.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
  }
  for (const bool top : {false, true}) {
    std::vector<Vec3f> ring;
    for (const Vec2f p : outline) ring.push_back({p.x, p.y, top ? z1 : z0});
    PolygonList polygon;
    polygon.sizes.push_back(static_cast<uint32_t>(count));
    for (uint32_t i = 0; i < count; ++i)
      polygon.corners.push_back(top ? i : static_cast<uint32_t>(count) - 1 - i);
    std::vector<uint32_t> cap;
    uint64_t bad = 0;
    triangulate_polygons(ring, polygon, &cap, &bad);
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    for (const uint32_t i : cap) mesh.indices.push_back(base + i);
    for (const Vec3f p : ring) {
      mesh.positions.push_back(p);
      mesh.normals.push_back({0, 0, top ? 1.0f : -1.0f});
    }
  }
  return Solid(std::move(mesh));
}

}  // namespace gloam
