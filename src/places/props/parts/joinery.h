#pragma once
// Parts that makers of furniture have in common: legs, pulls, drawers, hinged doors, shades, books.

#include "places/catalogue.h"

namespace gloam {

/// Each edge within its limits.
Vec3f limited(Vec3f size, Vec3f low, Vec3f high);

/// Moved so that it touches the floor: a leaning bar's foot is round and dips below its end.
Solid standing(const Solid& solid);

/// Four round legs below a rectangle of half extents x, y, from the floor to `height`; their feet
/// stand outside by `splay`.
Solid round_legs(float x, float y, float height, float radius_foot, float radius_top,
                 float splay = 0.02f);
/// Their colliders.
void collide_legs(PropPart* part, float x, float y, float height, float radius, float middle = 0);

/// Pulls that stand off a front at x = 0: a bow of that length along y (or z), a turned knob.
Solid bow_pull(float length, bool upright);
Solid knob_pull(float radius);

/// Look of the fronts of a piece of furniture.
struct FrontLook {
  std::string material;
  std::string pull_material;
  int pull = 0;  ///< 0 bow, 1 knob, 2 grip cut into the upper edge
};
FrontLook front_look(Workshop& shop, const std::string& material);

/// A drawer whose front fills the rectangle low … high (y, z) of the plane x = `face`, `depth`
/// deep behind it. Slides out along +x.
PropPart& add_drawer(Prop* p, Workshop& shop, const std::string& name, float face, Vec2f low,
                     Vec2f high, float depth, const FrontLook& look);
/// A door leaf in front of the plane x = `face`, turning about an upright axis at its outer edge.
PropPart& add_door(Prop* p, const std::string& name, float face, Vec2f low, Vec2f high,
                   bool hinge_at_low_y, const FrontLook& look, float thickness = 0.018f);

/// A lamp's shade about z: thin cloth, open at both ends.
Solid shade(float radius_low, float radius_high, float z0, float z1);
/// A bulb that shines: a sphere of that radius [m], `flux` in lm, `temperature` in K.
void add_bulb(Prop* p, Vec3f at, double flux, double temperature, double radius = 0.028);

/// One closed book that stands on z = 0, its spine at +x; shown on the part in a cover of one of
/// its colours. `size` = depth, thickness, height.
void show_book(PropPart* part, Workshop& shop, Vec3f size, Vec3f at, float lean_degrees,
               float turn_degrees, int tint, bool lying = false);
/// Fills a shelf's bay with books from low.y on, up to a fraction of its width; returns where they
/// end. low = the bay's left front corner on its floor.
float show_books(PropPart* part, Workshop& shop, Vec3f low, float width, float height, float depth,
                 float share);
constexpr int kBookTints = 10;

}  // namespace gloam
