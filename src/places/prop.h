#pragma once
// Prop: one thing in a place, as a maker of the catalogue returns it, with looks, colliders, mass
// and lamps.
//
// A prop's frame lies on the floor below its middle; +x is its front, its back is to a wall. What
// hangs on a wall has its origin on the wall, what hangs from a ceiling on the ceiling.

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "geometry/solid.h"
#include "gloam/scene/light.h"
#include "gloam/types.h"

namespace gloam {

enum class ColliderShape { kBox, kCylinder, kCapsule, kSphere, kHull };

struct PropVisual {
  std::string name;
  std::string material;  ///< name in a MaterialSet
  TriangleMesh mesh;     ///< in the part's frame
};

struct PropCollider {
  ColliderShape shape = ColliderShape::kBox;
  Vec3f size;              ///< MuJoCo's: half extents; radius, half length; radius [m]
  Pose X_PG = {};          ///< in the part's frame
  double friction = 0.8;   ///< sliding
  TriangleMesh hull = {};  ///< kHull: a closed mesh; MuJoCo takes its convex hull
};

/// The joint between a part and what it hangs on, through the origin of the part's frame.
struct PropJoint {
  bool slides = false;
  Vec3 axis = {0, 0, 1};
  double low = 0, high = 0;  ///< [rad or m]
  double initial = 0;        ///< position at first, within the range
  double damping = 0;        ///< [N m s/rad or N s/m]
  double friction = 0;       ///< dry [N m or N]
};

/// One rigid body.
struct PropPart {
  std::string name;  ///< "" = the prop itself
  int parent = -1;   ///< part that it hangs on
  Vec3 p_P = {};     ///< origin in the parent's frame, axes parallel, joint at zero [m]
  std::optional<PropJoint> joint = {};
  double mass = 0;  ///< [kg]
  std::vector<PropVisual> visuals = {};
  std::vector<PropCollider> colliders = {};

  /// Adds to the visual of that name; all of one name are of one material.
  PropPart& show(const std::string& name, const std::string& material, const Solid& solid);
  /// Visuals of one material become one, named after the first: each is a geom that MuJoCo moves at
  /// every step, wherever the part stands.
  void join_visuals();
  PropPart& collide_box(Vec3f low, Vec3f high);
  /// About its own centre; `half` = half extents.
  PropPart& collide_box(Vec3f center, Vec3f half, const Quat& q);
  PropPart& collide_cylinder(float radius, float z0, float z1, float x = 0, float y = 0);
  PropPart& collide_cylinder(Vec3f from, Vec3f to, float radius);
  PropPart& collide_capsule(Vec3f from, Vec3f to, float radius);
  PropPart& collide_sphere(Vec3f center, float radius);
  /// The convex hull of a closed mesh.
  PropPart& collide_hull(const Solid& solid, double friction = 0.8);
};

/// A level rectangle of part 0 on which smaller things may stand.
struct PropSurface {
  Vec2f low, high;  ///< [m]
  float z = 0;
  float clearance = 10;  ///< free height above it [m]
};

struct Prop {
  std::string label;                      ///< semantic class, and stem of its name
  std::deque<PropPart> parts{1};          ///< the first is the prop itself; parents before children
  std::vector<LightOptions> lights = {};  ///< in the frame of part 0
  std::vector<PropSurface> surfaces = {};
  float front = 0;     ///< depth that must stay free before it so that it can be used [m]
  bool loose = false;  ///< things of its kind are usually not fixed: balls, boxes, chairs

  PropPart& body() { return parts[0]; }
  const PropPart& body() const { return parts[0]; }
  /// A part that hangs on the joint at p in the frame of `parent`.
  PropPart& hang(const std::string& name, Vec3f p, const PropJoint& joint, int parent = 0);

  struct Box {
    Vec3f low, high;
  };
  /// Bounding box of all visuals and colliders, joints where they stand at first.
  Box bounds() const;
  double mass() const;  ///< mass of all parts [kg]
};

/// About the axis by the angle [rad].
Quat turn(Vec3 axis, double angle);

}  // namespace gloam
