#include "sim/effects/bodies/collider_mesh.h"

#include <algorithm>

namespace gloam {
namespace {

// Through three points, anticlockwise from outside. False: they are in line.
bool plane_through(const double* a, const double* b, const double* c, SolidPlane* plane) {
  double ab[3], ac[3];
  mju_sub3(ab, b, a);
  mju_sub3(ac, c, a);
  mju_cross(plane->n, ab, ac);
  const double size = mju_norm3(plane->n), sides = mju_norm3(ab) * mju_norm3(ac);
  if (!(size > 1e-12 * sides)) return false;
  mju_scl3(plane->n, plane->n, 1 / size);
  plane->offset = mju_dot3(plane->n, a);
  return true;
}

}  // namespace

std::vector<bool> colliders(const mjModel& m) {
  std::vector<bool> collide(static_cast<size_t>(m.ngeom));
  for (size_t g = 0; g < collide.size(); ++g)
    collide[g] = m.geom_contype[g] != 0 || m.geom_conaffinity[g] != 0;
  for (size_t p = 0; p < static_cast<size_t>(m.npair); ++p)
    for (const int g : {m.pair_geom1[p], m.pair_geom2[p]}) collide[static_cast<size_t>(g)] = true;
  return collide;
}

std::span<const int> hull_faces(const mjModel& m, int mesh) {
  if (m.mesh_graphadr[mesh] < 0) {  // too small for a hull: it is one
    return {m.mesh_face + 3 * m.mesh_faceadr[mesh], static_cast<size_t>(3 * m.mesh_facenum[mesh])};
  }
  // numvert, numface, edge addresses, vertex numbers, edge lists, faces: mjModel::mesh_graph.
  const int* graph = m.mesh_graph + m.mesh_graphadr[mesh];
  const int n = graph[0], n_faces = graph[1];
  return {graph + 2 + 2 * n + n + 3 * n_faces, static_cast<size_t>(3 * n_faces)};
}

// A face's plane is moved out to the outermost point of all, so that slivers, whose normals are
// noise, cut nothing off.
std::vector<SolidPlane> hull_planes(const mjModel& m, int mesh) {
  const float* vertices = m.mesh_vert + 3 * m.mesh_vertadr[mesh];
  const std::span<const int> faces = hull_faces(m, mesh);
  std::vector<int> points;  // numbers of vertices
  if (m.mesh_graphadr[mesh] >= 0) {
    const int* graph = m.mesh_graph + m.mesh_graphadr[mesh];
    points.assign(graph + 2 + graph[0], graph + 2 + 2 * graph[0]);
  } else {
    for (int i = 0; i < m.mesh_vertnum[mesh]; ++i) points.push_back(i);
  }
  const auto at = [&](int i, double* p) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = double{vertices[3 * i + axis]};
  };
  std::vector<SolidPlane> planes;
  for (size_t f = 0; f + 2 < faces.size(); f += 3) {
    double a[3], b[3], c[3], p[3];
    at(faces[f], a), at(faces[f + 1], b), at(faces[f + 2], c);
    SolidPlane plane;
    if (!plane_through(a, b, c, &plane)) continue;
    double low = plane.offset, high = plane.offset;
    for (const int i : points) {
      at(i, p);
      const double d = mju_dot3(plane.n, p);
      low = std::min(low, d), high = std::max(high, d);
    }
    if (high - plane.offset > plane.offset - low) {  // wound the other way
      mju_scl3(plane.n, plane.n, -1);
      high = -low;
    }
    plane.offset = high;
    planes.push_back(plane);
  }
  return planes;
}

HeightFieldPrisms::HeightFieldPrisms(const mjModel& m, int id, const float* data)
    : rows_(m.hfield_nrow[id]),
      columns_(m.hfield_ncol[id]),
      size_(m.hfield_size + 4 * id),
      data_(data + m.hfield_adr[id]) {}

void HeightFieldPrisms::point(int column, int row, double* p) const {
  p[0] = size_[0] * (2.0 * column / (columns_ - 1) - 1);
  p[1] = size_[1] * (2.0 * row / (rows_ - 1) - 1);
  p[2] = size_[2] * double{data_[static_cast<size_t>(row) * static_cast<size_t>(columns_) +
                                 static_cast<size_t>(column)]};
}

// MuJoCo's prisms: a cell's square is cut from its lowest to its highest corner.
void HeightFieldPrisms::make_prism(int column, int row, bool second, GridSolid* solid) const {
  double p[3][3];
  point(column, row, p[0]);
  point(column + 1, row + (second ? 1 : 0), p[1]);
  point(column + (second ? 0 : 1), row + 1, p[2]);
  SolidPlane planes[5];
  double low[3], high[3], centre[3], half[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::min({p[0][axis], p[1][axis], p[2][axis]});
    high[axis] = std::max({p[0][axis], p[1][axis], p[2][axis]});
  }
  low[2] = -size_[3];
  for (int axis = 0; axis < 3; ++axis) {
    centre[axis] = (low[axis] + high[axis]) / 2;
    half[axis] = (high[axis] - low[axis]) / 2;
  }
  size_t n = 0;
  planes[n++] = {{0, 0, -1}, size_[3]};
  if (plane_through(p[0], p[1], p[2], &planes[n])) ++n;
  for (int side = 0; side < 3; ++side) {
    const double* a = p[side];
    const double* b = p[(side + 1) % 3];
    const double under[3] = {a[0], a[1], a[2] - 1};
    if (plane_through(a, under, b, &planes[n])) ++n;
  }
  solid->make_polyhedron({planes, n}, centre, half);
}

}  // namespace gloam
