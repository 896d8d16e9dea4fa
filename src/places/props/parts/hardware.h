#pragma once
// Shapes and pieces that many props of halls and yards are made of.

#include "places/prop.h"
#include "places/workshop.h"

namespace gloam {

// Reflectances, linear.
inline constexpr Vec3 kSafetyYellow{0.90, 0.62, 0.02}, kSafetyBlack{0.03, 0.03, 0.032};
inline constexpr Vec3 kBlackPlastic{0.105, 0.105, 0.107}, kSilver{0.70, 0.70, 0.71};
inline std::string screen_glass(Workshop& shop) {
  return shop.plastic({0.012, 0.012, 0.014}, 0.07);
}

/// Box between two points, `width` wide and, across both, `height` high.
Solid beam(Vec3f from, Vec3f to, float width, float height, float radius = 0.002f);
/// Outline (x, z), counter-clockwise, from y0 to y1.
Solid plate_y(const Profile& outline, float y0, float y1);
/// Outline (y, z), counter-clockwise, from x0 to x1.
Solid plate_x(const Profile& outline, float x0, float x1);
/// Thin rod without bevels.
Solid wire(Vec3f from, Vec3f to, float radius);
/// A polyline with arcs for its inner corners.
Path rounded_path(const Path& corners, float radius, int steps = 4);
/// Hexagon head that looks along +x.
Solid bolt(Vec3f at, float size);
/// Open ring about z: a rectangle (radii r0 … r1, z0 … z1) that is turned.
Solid ring(float r0, float r1, float z0, float z1, int segments = 24);

/// Tyre ("tyres") and hub ("hubs") about an axle along y.
void add_wheel(PropPart* part, Workshop* shop, Vec3f center, float radius, float width, Vec3 tyre,
               Vec3 hub);
/// Swivelling or fixed roller below a plate at `top`; touches z = 0 below.
void add_caster(PropPart* part, Workshop* shop, float x, float y, float top, float radius);

// Flat loads and what lies on them; all add to a part.
/// Adds a pallet of EUR build with its colliders; its own frame: length along x.
void add_pallet(PropPart* part, Workshop* shop, Vec3f size);
/// Fills the box with cartons in layers, all of one size.
void add_cartons(PropPart* part, Workshop* shop, Vec3f low, Vec3f high);
/// Fills the box with sacks in layers.
void add_sacks(PropPart* part, Workshop* shop, Vec3f low, Vec3f high);
/// Steel or plastic drum; `style` shared by drums that stand together.
void add_drum(PropPart* part, Workshop* shop, Vec3f foot, float radius, float height, Vec3 color);
}  // namespace gloam
