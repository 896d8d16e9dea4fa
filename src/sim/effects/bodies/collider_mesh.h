#pragma once
// Solids that MuJoCo collides meshes and height fields as: hulls and prisms, as planes.

#include <span>
#include <vector>

#include "sim/effects/bodies/grid_solid.h"

namespace gloam {

/// Flags of the geoms that can be in contact.
std::vector<bool> colliders(const mjModel& model);

/// Numbers of vertices, three for each face of the convex hull that a mesh collides as.
std::span<const int> hull_faces(const mjModel& model, int mesh);

/// The planes of the convex hull that a mesh collides as, in the mesh's frame [m].
std::vector<SolidPlane> hull_planes(const mjModel& model, int mesh);

/// One height field: two prisms a cell, from its base to its surface. Refers to the model.
class HeightFieldPrisms {
 public:
  /// `data`: of all height fields of the model, 0 … 1, as hfield_data.
  HeightFieldPrisms(const mjModel& model, int id, const float* data);
  int rows() const { return rows_; }
  int columns() const { return columns_; }
  /// Makes one of the two prisms of the cell from (column, row) to the next, at the solid's pose.
  void make_prism(int column, int row, bool second, GridSolid* solid) const;

 private:
  void point(int column, int row, double* p) const;
  int rows_, columns_;
  const mjtNum* size_;  // x, y, above, below [m]
  const float* data_;
};

}  // namespace gloam
