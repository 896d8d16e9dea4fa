// Things to sit on.

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

Prop chair(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.48f, 0.44f, float(shop.dice.uniform(0.80, 0.92))}),
                             {0.38f, 0.36f, 0.7f}, {0.6f, 0.6f, 1.2f});
  const float x = size.x / 2, y = size.y / 2, seat = 0.45f;
  Prop p;
  PropPart& b = p.body();
  const std::string wood = shop.wood(Axis::kZ);
  for (const float side : {-1.0f, 1.0f}) {
    b.show("frame", wood,
           standing(bar({x - 0.05f, side * (y - 0.035f), 0}, {x - 0.07f, side * (y - 0.05f), seat},
                        0.013f, 0.019f)));
    const Path back = smooth_path({{-x + 0.01f, side * (y - 0.035f), 0},
                                   {-x + 0.055f, side * (y - 0.045f), seat},
                                   {-x + 0.015f, side * (y - 0.045f), size.z}});
    b.show("frame", wood, standing(tube(back, 0.016f, 10)));
    b.show("frame", wood,
           bar({x - 0.06f, side * (y - 0.042f), 0.22f}, {-x + 0.04f, side * (y - 0.04f), 0.22f},
               0.009f, 0.009f));
  }
  b.show("frame", wood, bar({0, y - 0.045f, 0.22f}, {0, -y + 0.045f, 0.22f}, 0.009f, 0.009f));
  b.show("rails", shop.wood(Axis::kY),
         slab({-x + 0.035f, -y + 0.03f, seat - 0.055f}, {x - 0.055f, y - 0.03f, seat - 0.012f},
              0.004f));
  const int slats = shop.dice.integer(1, 3);
  for (int i = 0; i < slats; ++i) {
    const float z = size.z - 0.05f - 0.11f * float(i), lean = 0.04f * (z - seat) / (size.z - seat);
    b.show("slats", shop.wood(Axis::kY),
           slab({-x + 0.045f - lean, -y + 0.045f, z - 0.035f},
                {-x + 0.062f - lean, y - 0.045f, z + 0.035f}, 0.006f));
  }
  if (shop.dice.chance(0.6)) {
    b.show(
        "seat", shop.fabric(shop.color(shop.style.accent)),
        cushion({size.x - 0.06f, size.y - 0.05f, 0.05f}, 0.25f, 0.018f, shop.dice.seed(), 1, 0.001f)
            .moved(0.012f, 0, seat + 0.012f));
  } else {
    b.show("seat", shop.wood(Axis::kX),
           slab({-x + 0.03f, -y + 0.02f, seat - 0.012f}, {x - 0.03f, y - 0.02f, seat + 0.012f},
                0.008f, 2));
  }
  b.mass = 5;
  b.collide_box({-x + 0.02f, -y + 0.02f, seat - 0.05f}, {x - 0.03f, y - 0.02f, seat + 0.02f});
  b.collide_box({-x, -y + 0.03f, seat + 0.02f}, {-x + 0.06f, y - 0.03f, size.z});
  for (const float side : {-1.0f, 1.0f}) {
    // With round ends, which touch the floor once each, not four times.
    const float r = 0.018f, left = side * (y - 0.04f), top = seat - 0.05f - r;
    for (const float at : {x - 0.055f, -x + 0.03f})
      b.collide_capsule({at, left, r}, {at, left, top}, r);
  }
  p.loose = true;
  return p;
}

constexpr PropKind kSeating[] = {
    {"chair", chair, "wooden chair with slats, plain or with a cushion"},
};

}  // namespace

PropFamily seating() { return kSeating; }

}  // namespace gloam
