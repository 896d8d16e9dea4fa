#pragma once
// Volume, centre of mass and inertia of closed surfaces.

#include <array>
#include <cmath>

#include "geometry/mesh/mesh.h"

namespace gloam {

using Vec3d = Vec3Of<double>;
inline Vec3d wide(Vec3f p) { return {p.x, p.y, p.z}; }
inline double length_of(Vec3d v) { return std::sqrt(length_squared(v)); }

/// Edges of a mesh whose equal corners are one vertex.
struct EdgeCount {
  uint64_t open = 0;     ///< with one triangle
  uint64_t tangled = 0;  ///< with more than two, or two that disagree on what is outside
  bool is_closed() const { return open == 0 && tangled == 0; }
};
EdgeCount count_edges(const TriangleMesh& welded);

struct MassProperties {
  double volume = 0;                   ///< [m^3]; below 0: the triangles look inwards
  Vec3d center;                        ///< centre of mass [m]
  std::array<double, 6> inertia = {};  ///< xx yy zz xy xz yz about it, of 1 kg/m^3 [m^5]
};
/// Mass properties by the divergence theorem, of a closed surface; pieces that overlap count twice.
MassProperties mass_properties(const TriangleMesh& mesh);

/// True if a rigid body can have them: positive, and no moment above the sum of the other two.
bool is_physical(const MassProperties& mass);

}  // namespace gloam
