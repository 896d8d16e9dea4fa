#include "sim/agents/collider_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gloam {
namespace {

constexpr int kSides = 16;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

using Corners = std::vector<Vec3f>;

void add_triangle(Vec3f a, Vec3f b, Vec3f c, Corners* out) {
  out->push_back(a), out->push_back(b), out->push_back(c);
}

void add_box_faces(Vec3f half, Corners* out) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      const auto at = [&](float u, float v) {
        float p[3];
        p[axis] = sign * half[axis];
        p[(axis + 1) % 3] = u * half[(axis + 1) % 3];
        p[(axis + 2) % 3] = v * half[(axis + 2) % 3];
        return Vec3f{p[0], p[1], p[2]};
      };
      add_triangle(at(-1, -1), at(1, -1), at(1, 1), out);
      add_triangle(at(-1, -1), at(1, 1), at(-1, 1), out);
    }
  }
}

// A surface about z through rings of (radius in x, in y, z), closed at both ends.
void add_lathe(const std::vector<Vec3f>& rings, Corners* out) {
  const auto at = [&](size_t ring, int side) {
    const float angle = 2 * kPi * static_cast<float>(side) / kSides;
    const Vec3f r = rings[ring];
    return Vec3f{r.x * std::cos(angle), r.y * std::sin(angle), r.z};
  };
  for (int side = 0; side < kSides; ++side) {
    for (size_t ring = 0; ring + 1 < rings.size(); ++ring) {
      add_triangle(at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), out);
      add_triangle(at(ring, side), at(ring + 1, side + 1), at(ring + 1, side), out);
    }
    add_triangle({0, 0, rings.front().z}, at(0, side), at(0, side + 1), out);
    add_triangle({0, 0, rings.back().z}, at(rings.size() - 1, side), at(rings.size() - 1, side + 1),
                 out);
  }
}

// Half axes; a cylinder of that half length stands between the halves.
void add_ball(Vec3f radii, float half_length, Corners* out) {
  std::vector<Vec3f> rings;
  constexpr int kRings = 4;  // of a half
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 0; i < kRings; ++i) {
      const int k = side < 0 ? kRings - 1 - i : i;
      const float angle = 0.5f * kPi * static_cast<float>(k) / kRings;
      rings.push_back({radii.x * std::cos(angle), radii.y * std::cos(angle),
                       side * (half_length + radii.z * std::sin(angle))});
    }
  }
  rings.insert(rings.begin(), {0, 0, -half_length - radii.z});
  rings.push_back({0, 0, half_length + radii.z});
  add_lathe(rings, out);
}

void add_hull(const mjModel& m, int mesh, Corners* out) {
  const float* vertices = m.mesh_vert + 3 * m.mesh_vertadr[mesh];
  const int *faces, *end;
  if (m.mesh_graphadr[mesh] >= 0) {  // numvert, numface, …: mjModel::mesh_graph
    const int* graph = m.mesh_graph + m.mesh_graphadr[mesh];
    faces = graph + 2 + 2 * graph[0] + graph[0] + 3 * graph[1];
    end = faces + 3 * graph[1];
  } else {
    faces = m.mesh_face + 3 * m.mesh_faceadr[mesh];
    end = faces + 3 * m.mesh_facenum[mesh];
  }
  for (; faces < end; ++faces) {
    const float* v = vertices + 3 * *faces;
    out->push_back({v[0], v[1], v[2]});
  }
}

void add_ground(const mjModel& m, int hfield, Corners* out) {
  const int rows = m.hfield_nrow[hfield], columns = m.hfield_ncol[hfield];
  const mjtNum* size = m.hfield_size + 4 * hfield;
  const float* data = m.hfield_data + m.hfield_adr[hfield];
  const auto at = [&](int column, int row) {
    return Vec3f{static_cast<float>(size[0] * (2.0 * column / (columns - 1) - 1)),
                 static_cast<float>(size[1] * (2.0 * row / (rows - 1) - 1)),
                 static_cast<float>(size[2]) * data[row * columns + column]};
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const Vec3f a = at(column, row), b = at(column + 1, row), c = at(column, row + 1),
                  d = at(column + 1, row + 1);
      add_triangle(a, b, d, out);
      add_triangle(a, d, c, out);
    }
  }
}

// Anticlockwise from outside of a shape that holds `inside`.
void wind_outwards(Vec3f inside, Corners* corners) {
  for (size_t i = 0; i + 2 < corners->size(); i += 3) {
    Vec3f* t = corners->data() + i;
    const Vec3f normal = cross(t[1] - t[0], t[2] - t[0]);
    if (dot(normal, t[0] - inside) < 0) std::swap(t[1], t[2]);
  }
}

// A plane within bounds, about the point of it that is nearest to their middle.
void add_plane_square(const mjtNum* size, const mjtNum* p, const mjtNum* R, const NavBounds& b,
                      Corners* out) {
  const Vec3f middle = (b.low + b.high) * 0.5f;
  const double away[3] = {double{middle.x} - p[0], double{middle.y} - p[1],
                          double{middle.z} - p[2]};
  const double u = R[0] * away[0] + R[3] * away[1] + R[6] * away[2];
  const double v = R[1] * away[0] + R[4] * away[1] + R[7] * away[2];
  const double reach = double{length(b.high - b.low)} / 2;
  double low[2] = {u - reach, v - reach}, high[2] = {u + reach, v + reach};
  for (int i = 0; i < 2; ++i) {
    if (!(size[i] > 0)) continue;
    low[i] = std::max(low[i], -size[i]), high[i] = std::min(high[i], size[i]);
    if (low[i] >= high[i]) return;
  }
  const auto at = [&](double x, double y) {
    return Vec3f{static_cast<float>(x), static_cast<float>(y), 0};
  };
  add_triangle(at(low[0], low[1]), at(high[0], low[1]), at(high[0], high[1]), out);
  add_triangle(at(low[0], low[1]), at(high[0], high[1]), at(low[0], high[1]), out);
}

}  // namespace

ColliderSurface collider_surface(const mjModel& m, int geom, const mjtNum* p, const mjtNum* R,
                                 const NavBounds& bounds) {
  ColliderSurface surface;
  const mjtNum* size = m.geom_size + 3 * geom;
  const float a = static_cast<float>(size[0]), b = static_cast<float>(size[1]),
              c = static_cast<float>(size[2]);
  Corners* out = &surface.corners;
  surface.is_solid = true;
  Vec3f inside;
  switch (m.geom_type[geom]) {
    case mjGEOM_BOX:
      add_box_faces({a, b, c}, out);
      break;
    case mjGEOM_SPHERE:
      add_ball({a, a, a}, 0, out);
      break;
    case mjGEOM_ELLIPSOID:
      add_ball({a, b, c}, 0, out);
      break;
    case mjGEOM_CAPSULE:
      add_ball({a, a, a}, b, out);
      break;
    case mjGEOM_CYLINDER:
      add_lathe({{a, a, -b}, {a, a, b}}, out);
      break;
    case mjGEOM_MESH: {
      add_hull(m, m.geom_dataid[geom], out);
      for (const Vec3f v : *out) inside += v * (1.0f / static_cast<float>(out->size()));
      break;
    }
    case mjGEOM_PLANE:
      surface.is_solid = false;
      add_plane_square(size, p, R, bounds, out);
      break;
    case mjGEOM_HFIELD:
      surface.is_solid = false;
      add_ground(m, m.geom_dataid[geom], out);
      break;
    default:
      break;
  }
  if (surface.is_solid) wind_outwards(inside, out);
  surface.low = {kInfinite, kInfinite, kInfinite};
  surface.high = surface.low * -1.0f;
  for (Vec3f& v : *out) {
    double w[3];
    for (int i = 0; i < 3; ++i) {
      w[i] =
          p[i] + R[3 * i] * double{v.x} + R[3 * i + 1] * double{v.y} + R[3 * i + 2] * double{v.z};
    }
    v = {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])};
    surface.low = {min(surface.low.x, v.x), min(surface.low.y, v.y), min(surface.low.z, v.z)};
    surface.high = {max(surface.high.x, v.x), max(surface.high.y, v.y), max(surface.high.z, v.z)};
  }
  return surface;
}

}  // namespace gloam
