#pragma once
// Fittings of kitchens, bathrooms and utility rooms: boxes of board, fronts that open, handles,
// taps, basins.

#include "places/catalogue.h"

namespace gloam {

/// Rounded rectangle as a level ring of a loft, counter-clockwise from above.
Path ring(Vec2f low, Vec2f high, float radius, float z, int steps = 4);
/// An oval ring about (x, 0): the half at +x is `front` long, the other `back`; `square` > 2 makes
/// it fuller than an ellipse.
Path oval(float x, float front, float back, float half_width, float z, float square = 2);
/// All points of a ring at one.
Path point_of(const Path& ring, Vec3f p);

/// Open at the front (+x): sides, floor, roof and back of board.
void add_carcass(PropPart* part, const std::string& name, const std::string& material, Vec3f low,
                 Vec3f high, float thickness = 0.016f);
/// Sticks out towards +x from `middle`. Which handle follows from the place's style, so that all
/// of a kitchen match.
void add_handle(Workshop& shop, PropPart* part, Vec3f middle, Axis along, float length);
/// Cabinet front between two corners (y, z); its face is the plane x = 0, its back x =
/// -kFrontBoard.
void show_front(Workshop& shop, PropPart* part, Vec2f low, Vec2f high);
constexpr float kFrontBoard = 0.019f;  ///< thickness [m]

/// Joint of a leaf that turns on an upright hinge. `side` = where the leaf is from it, +1 = +y.
PropJoint upright_hinge(float side, double high = 1.57, double damping = 0.3);
/// Door whose lower corner of the hinged side is `corner` (on its face); `width` < 0 extends to -y.
/// Its handle's middle is `handle` above the corner.
PropPart& hang_door(Workshop& shop, Prop* prop, const std::string& name, Vec3f corner, float width,
                    float height, float handle);
/// Drawer whose face has its lower corner at -y at `corner`; its box is `depth` long.
PropPart& hang_drawer(Workshop& shop, Prop* prop, const std::string& name, Vec3f corner,
                      float width, float height, float depth);

/// Casing of large machines: white, black or bare steel.
std::string appliance_casing(Workshop& shop);
/// Metal of taps and rails.
std::string bright_metal(Workshop& shop);
Vec3 towel_color(Workshop& shop);
/// Mixer with a swan's neck that reaches over to +x.
void show_tap(Workshop& shop, PropPart* part, Vec3f foot, float height, float reach);
/// Round knob with a mark, on a front that faces +x.
Solid knob(float radius, float height, Vec3f at);
/// Cloth laid over a bar along y through the origin; hangs down `front` at +x and `back` at -x.
Solid draped(float width, float front, float back, float bar_radius, uint64_t seed,
             float thickness = 0.004f);

}  // namespace gloam
