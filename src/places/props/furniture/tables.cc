// Things to put things on.

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

Prop dining_table(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.85f, float(shop.dice.uniform(1.2, 1.9)), 0.745f}),
                             {0.6f, 0.6f, 0.6f}, {1.4f, 3.5f, 0.9f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, top = 0.028f;
  Prop p;
  PropPart& b = p.body();
  b.show("top", shop.wood(Axis::kY), slab({-x, -y, z - top}, {x, y, z}, 0.008f, 2));
  for (const float side : {-1.0f, 1.0f}) {
    b.show("apron", shop.wood(Axis::kY),
           slab({side * (x - 0.065f) - 0.01f, -y + 0.08f, z - 0.105f},
                {side * (x - 0.065f) + 0.01f, y - 0.08f, z - top}, 0.002f));
    b.show("ends", shop.wood(Axis::kX),
           slab({-x + 0.065f, side * (y - 0.07f) - 0.01f, z - 0.105f},
                {x - 0.065f, side * (y - 0.07f) + 0.01f, z - top}, 0.002f));
    for (const float end : {-1.0f, 1.0f}) {
      b.show("legs", shop.wood(Axis::kZ),
             standing(bar({side * (x - 0.05f), end * (y - 0.055f), 0},
                          {side * (x - 0.075f), end * (y - 0.08f), z - top}, 0.017f, 0.030f, 16)));
      b.collide_cylinder(0.026f, 0, z - 0.105f, side * (x - 0.062f), end * (y - 0.067f));
    }
  }
  b.collide_box({-x, -y, z - 0.105f}, {x, y, z});
  b.mass = 45.0 * size.x * size.y;  // oak of 700 kg/m³: top and frame are worth 65 mm
  p.surfaces.push_back({{-x + 0.02f, -y + 0.02f}, {x - 0.02f, y - 0.02f}, z});
  return p;
}

constexpr PropKind kTables[] = {
    {"dining_table", dining_table, "table with four tapered legs"},
};

}  // namespace

PropFamily tables() { return kTables; }

}  // namespace gloam
