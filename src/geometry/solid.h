#pragma once
// Solids made by formula: bevelled boxes, turned and extruded profiles, tubes, sheets, cushions.
// Generated environments are built of them. Lengths in metres, Z up, angles in degrees.

#include <span>
#include <utility>
#include <vector>

#include "geometry/mesh/mesh.h"

namespace gloam {

enum class Axis { kX, kY, kZ };

/// A closed or open surface under construction. Each call returns another one.
class Solid {
 public:
  Solid() = default;
  explicit Solid(TriangleMesh mesh) : mesh_(std::move(mesh)) {}

  Solid moved(float x, float y, float z) const;
  Solid moved(Vec3f by) const { return moved(by.x, by.y, by.z); }
  Solid turned(Axis axis, float degrees) const;  ///< counter-clockwise seen against the axis
  Solid scaled(Vec3f by) const;                  ///< all > 0
  Solid mirrored(Axis axis) const;
  Solid& operator+=(const Solid& other);
  friend Solid operator+(Solid a, const Solid& b) { return a += b; }

  const TriangleMesh& mesh() const& { return mesh_; }
  TriangleMesh mesh() && { return std::move(mesh_); }
  /// Corners of its bounding box; zeros when it is empty.
  Vec3f low() const;
  Vec3f high() const;

 private:
  TriangleMesh mesh_;
};

/// Box with rounded edges about the origin; `size` = full extents. `steps` = facets of an edge,
/// `cuts` = further cuts of each face. A radius of zero gives sharp edges.
Solid rounded_box(Vec3f size, float radius, int steps = 1, int cuts = 0);
/// The same between two corners.
Solid slab(Vec3f low, Vec3f high, float radius = 0.003f, int steps = 1);
/// Box with soft, swollen faces, a little uneven; `edge` = thickness at its rim relative to the
/// middle (thrown pillows: thin seams), `seed` = which folds.
Solid cushion(Vec3f size, float bulge, float radius, uint64_t seed, float edge = 1,
              float wrinkle = 0.004f);

using Profile = std::vector<Vec2f>;  ///< (r, z) of lathes, (x, y) of extrusions
using Path = std::vector<Vec3f>;

/// Replaces the inner corners of a polyline by arcs of about that radius.
Profile rounded(const Profile& corners, float radius, int steps = 2);
/// A closed outline with arcs for all its corners.
Profile rounded_outline(const Profile& corners, float radius, int steps = 3);
/// The outline of a rectangle about the origin with rounded corners, counter-clockwise.
Profile rounded_rectangle(float width, float height, float radius, int steps = 3);
Profile circle(float radius, int segments = 24);

/// Turns (r, z), listed from the bottom outwards and up, about z. Smooth along the profile.
Solid lathe(const Profile& profile, int segments = 24);
/// Turns each piece of the profile with edges between them.
Solid sharp_lathe(const Profile& profile, int segments = 24);
/// Round bar along z, or a cone when the radii differ.
Solid cylinder(float radius, float z0, float z1, float bevel = 0.002f, int segments = 20);
Solid cone(float radius_low, float radius_high, float z0, float z1, float bevel = 0.002f,
           int segments = 20);
Solid ball(float radius, int segments = 20);
/// Round bar between two points, tapered when the radii differ.
Solid bar(Vec3f from, Vec3f to, float radius_from, float radius_to, int segments = 12);
/// Round tube along a polyline, its ends closed.
Solid tube(const Path& path, float radius, int segments = 8);
/// Catmull-Rom curve through points.
Path smooth_path(const Path& points, int steps = 6);

/// A simple polygon, counter-clockwise, along z from z0 to z1; smooth where it bends less than 40
/// degrees.
Solid extrude(const Profile& outline, float z0, float z1);
/// Skin over closed rings of equally many points, each counter-clockwise seen from above, listed as
/// a lathe's profile is. Smooth but where a ring is given twice; ends stay open unless they shrink
/// to a point.
Solid loft(const std::vector<Path>& rings);
/// Points of a grid, row by row; its front is on the side of d/dcolumn x d/drow. Coordinates of
/// textures run from 0 to 1 along columns and rows. Seen from both sides if `thickness` > 0.
Solid sheet(std::span<const Vec3f> points, int columns, float thickness = 0);
/// Rectangle in the plane y-z that faces +x, with texture coordinates from 0 to 1 that read upright
/// from there.
Solid panel(float width, float height);

}  // namespace gloam
