#include "sim/agents/collider_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/shape_corners.h"
#include "sim/effects/bodies/collider_mesh.h"

namespace gloam {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

void add_hull(const mjModel& m, int mesh, ShapeCorners* out) {
  const float* vertices = m.mesh_vert + 3 * m.mesh_vertadr[mesh];
  for (const int i : hull_faces(m, mesh)) {
    const float* v = vertices + 3 * i;
    out->push_back({v[0], v[1], v[2]});
  }
}

void add_ground(const mjModel& m, int hfield, ShapeCorners* out) {
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
void wind_outwards(Vec3f inside, ShapeCorners* corners) {
  for (size_t i = 0; i + 2 < corners->size(); i += 3) {
    Vec3f* t = corners->data() + i;
    const Vec3f normal = cross(t[1] - t[0], t[2] - t[0]);
    if (dot(normal, t[0] - inside) < 0) std::swap(t[1], t[2]);
  }
}

// A plane within bounds, about the point of it that is nearest to their middle.
void add_plane_square(const mjtNum* size, const mjtNum* p, const mjtNum* R, const NavBounds& b,
                      ShapeCorners* out) {
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
  ShapeCorners* out = &surface.corners;
  surface.is_solid = true;
  Vec3f inside;
  switch (m.geom_type[geom]) {
    case mjGEOM_BOX:
      add_box_corners({a, b, c}, out);
      break;
    case mjGEOM_SPHERE:
      add_ball_corners({a, a, a}, 0, out);
      break;
    case mjGEOM_ELLIPSOID:
      add_ball_corners({a, b, c}, 0, out);
      break;
    case mjGEOM_CAPSULE:
      add_ball_corners({a, a, a}, b, out);
      break;
    case mjGEOM_CYLINDER:
      add_lathe_corners({{a, a, -b}, {a, a, b}}, out);
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
