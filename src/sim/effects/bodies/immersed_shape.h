#pragma once
// Volume elements of a collider, and the coefficients of a fluid for a shape of its kind: water
// uses all of it, air its drag. Supported: boxes, ellipsoids, spheres, cylinders, capsules, and the
// convex hulls of meshes.

#include <mujoco/mujoco.h>

#include <optional>
#include <vector>

namespace gloam {

/// Coefficient of drag of a box from each side: Hoerner 1965, "Fluid-Dynamic Drag", chapter 3.
inline constexpr double kBoxDrag = 1.05;

/// In the geom's frame.
struct VolumeElement {
  double p[3];    ///< middle of its volume [m]
  double volume;  ///< [m³]
};

/// Elements that lie together, side by side, as many as make vector code; what is missing of the
/// last has no volume. In the geom's frame.
struct ElementCluster {
  static constexpr size_t kSide = 8;
  double x[kSide] = {}, y[kSide] = {}, z[kSide] = {}, volume[kSide] = {};
  double centre[3] = {}, half[3] = {};  ///< box around their middles [m]
};

struct ImmersedShape {
  int geom = 0, body = 0;
  std::vector<VolumeElement> elements;
  std::vector<ElementCluster> clusters;  ///< clusters of elements
  double volume = 0;                     ///< volume of all [m³]
  double centre[3] = {};                 ///< bounding box, in the geom's frame [m]
  double half[3] = {};                   ///< its half edges [m]
  double cell[3] = {};                   ///< edges of an element [m]
  double area[3] = {};                   ///< seen along each axis [m²]
  double drag[3] = {};                   ///< coefficients of drag along each axis
  bool is_round = false;                 ///< a long solid of revolution about its z axis
  double added[3] = {};                  ///< added mass over that of the water displaced
  double added_inertia[3] = {};          ///< over the water's density [m⁵]
  double radius = 0;                     ///< radius of the sphere of the same volume [m]
};

/// Sorts elements and makes clusters of them; `low`: corner of the bounding box.
void make_clusters(const double* low, ImmersedShape* shape);

/// Nothing for planes, height fields and SDFs. `elements`: about how many are wanted.
std::optional<ImmersedShape> immersed_shape(const mjModel& model, int geom, int elements = 216);

/// Shapes of every collider of a body that is not fixed to the world.
std::vector<ImmersedShape> immersed_shapes(const mjModel& model);

}  // namespace gloam
