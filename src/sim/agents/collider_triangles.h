#pragma once
// Surfaces of colliders as triangles: what agents walk on and around.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"

namespace gloam {

/// A convex solid, or ground: triangles of three points each in the world [m].
struct ColliderSurface {
  std::vector<Vec3f> corners;
  bool is_solid = false;  ///< convex and closed: nobody can be inside
  Vec3f low, high;        ///< bounds
};

/// Box that planes, which have no end, are cut off at.
struct NavBounds {
  Vec3f low, high;
};

/// Triangles of one geom at a pose (p [m], R row by row). Round shapes are prisms and lathed hulls
/// of 16 sides, meshes their hulls, height fields of `hfield_data` their surface. Empty for SDFs.
ColliderSurface collider_surface(const mjModel& model, int geom, const mjtNum* p, const mjtNum* R,
                                 const NavBounds& bounds);

}  // namespace gloam
