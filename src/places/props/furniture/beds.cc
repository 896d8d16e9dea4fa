// Beds.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// A quilt over the mattress: from `head` to `foot` along x, falling over both sides and the foot
// (if `over_foot`) with soft folds. `top` = height of the mattress, `drop` = how far it hangs down.
Solid quilt(float head, float foot, float y, float top, float drop, uint64_t seed, float thickness,
            bool over_foot = false) {
  constexpr int kAlong = 44, kAcross = 52;
  Dice dice(seed, "quilt");
  float phase[8];
  for (float& p : phase) p = float(dice.uniform(0, 2 * M_PI));
  const float reach = y + drop, flat_x = foot + 0.012f - head,
              far = flat_x + (over_foot ? 0.7f * drop : 0);
  Path points;
  for (int i = 0; i <= kAlong; ++i) {
    for (int j = kAcross; j >= 0; --j) {
      // Lengths along the cloth, from its head end and from the middle.
      const float s = far * float(i) / kAlong, t = reach * (2 * float(j) / kAcross - 1);
      const float over_x = max(0.0f, s - flat_x), over_y = max(0.0f, std::fabs(t) - y);
      const auto bend = [](float over) { return 0.05f * (1 - std::exp(-over / 0.05f)); };
      const auto fall = [](float over) { return over - 0.05f * (1 - std::exp(-over / 0.05f)); };
      const float flat = std::exp(-14 * max(over_x, over_y));
      float px = head + min(s, flat_x) + bend(over_x);
      float py = (t < 0 ? -1.0f : 1.0f) * (min(std::fabs(t), y) + bend(over_y));
      float pz = top - max(fall(over_x), fall(over_y));
      // Swells of the filling, and folds that deepen where it hangs.
      pz += flat * (0.012f * std::sin(9 * px + phase[0]) * std::sin(7 * py + phase[1]) +
                    0.006f * std::sin(21 * px + 13 * py + phase[2]) + 0.012f);
      const float hang = 1 - std::exp(-9 * max(over_x, over_y));
      py += (t < 0 ? -1.0f : 1.0f) * (over_y > 0
                                          ? hang * (0.012f + 0.014f * std::sin(19 * px + phase[3]) +
                                                    0.006f * std::sin(41 * px + phase[4]))
                                          : 0);
      px += over_x > 0 ? hang * (0.008f + 0.012f * std::sin(17 * py + phase[5]) +
                                 0.005f * std::sin(37 * py + phase[6]))
                       : 0;
      points.push_back({px, py, pz});
    }
  }
  return sheet(points, kAcross + 1, thickness);
}

Prop bed(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size = limited(
      shop.size({2.10f, float(dice.pick({0.98, 1.46, 1.66, 1.86})), float(dice.uniform(0.9, 1.1))}),
      {1.7f, 0.8f, 0.6f}, {2.4f, 2.2f, 1.4f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, board = 0.04f, deck = 0.30f, lie = 0.50f;
  const bool padded = dice.chance(0.4), twin = size.y > 1.3f;
  Prop p;
  PropPart& b = p.body();
  const Vec3 cloth = shop.style.fabric;
  const float thick = padded ? 0.08f : board, inside = -x + thick;
  if (padded) {
    const int count = std::max(3, int(std::lround(size.y / 0.22f)));
    for (int k = 0; k < count; ++k) {
      const float w = size.y / float(count), at = -y + w * (float(k) + 0.5f);
      b.show("headboard", shop.fabric(cloth, 0.0016),
             rounded_box({thick, w - 0.001f, z - 0.10f}, 0.025f, 3, 2)
                 .moved(-x + thick / 2, at, 0.10f + (z - 0.10f) / 2));
    }
  } else {
    b.show("headboard", shop.wood(Axis::kY),
           slab({-x, -y, 0.28f}, {-x + 0.022f, y, z - 0.012f}, 0.003f) +
               slab({-x, -y, z - 0.05f}, {-x + board, y, z}, 0.008f, 2));
    for (const float j : {-1.0f, 1.0f})
      b.show("posts", shop.wood(Axis::kZ),
             slab({-x, j * (y - 0.025f) - 0.025f, 0},
                  {-x + board, j * (y - 0.025f) + 0.025f, z - 0.05f}, 0.005f, 2));
  }
  b.collide_box({-x, -y, padded ? 0.10f : 0.28f}, {inside, y, z});
  for (const float j : {-1.0f, 1.0f})
    b.show("rails", shop.wood(Axis::kX),
           slab({inside, j * (y - 0.0125f) - 0.0125f, 0.16f},
                {x - 0.025f, j * (y - 0.0125f) + 0.0125f, deck + 0.02f}, 0.004f, 2));
  b.show("foot_rail", shop.wood(Axis::kY),
         slab({x - 0.025f, -y, 0.16f}, {x, y, deck + 0.02f}, 0.004f, 2));
  b.show("slats", shop.wood("birch", Axis::kY),
         slab({inside, -y + 0.025f, deck - 0.035f}, {x - 0.025f, y - 0.025f, deck - 0.015f}, 0));
  b.show("legs", shop.wood(Axis::kZ), round_legs(x - 0.07f, y - 0.07f, 0.165f, 0.020f, 0.028f, 0));
  collide_legs(&b, x - 0.07f, y - 0.07f, 0.165f, 0.026f);
  const float m0 = inside + 0.01f, m1 = x - 0.035f, my = y - 0.035f;
  b.show("mattress", shop.fabric({0.86, 0.85, 0.83}, 0.0012),
         rounded_box({m1 - m0, 2 * my, lie - deck + 0.015f}, 0.035f, 3, 1)
             .moved((m0 + m1) / 2, 0, (lie + deck - 0.015f) / 2));
  const Vec3 linen = dice.pick<Vec3>({{0.88, 0.87, 0.84}, {0.80, 0.78, 0.73}, {0.88, 0.88, 0.89}});
  const Vec3 cover = shop.color(dice.pick<Vec3>(
      {linen, shop.style.accent, {0.55, 0.60, 0.64}, {0.62, 0.50, 0.42}, {0.33, 0.36, 0.42}}));
  const float head = inside + 0.58f;
  const uint64_t folds = dice.seed();  // folds of all layers
  b.show("duvet", shop.fabric(cover, 0.0011),
         quilt(head, m1 + 0.012f, my + 0.01f, lie + 0.030f, 0.22f, folds, 0.028f, true));
  // Turned back at the head: a band of the lining.
  b.show("lining", shop.fabric(linen, 0.0011),
         quilt(head - 0.03f, head + 0.20f, my + 0.012f, lie + 0.042f, 0.21f, folds, 0.020f));
  const int across = twin ? 2 : 1;
  for (int k = 0; k < across; ++k) {
    const float wide = min(0.72f, (2 * my - 0.04f) / float(across)),
                at = twin ? (k == 0 ? -1.0f : 1.0f) * my * 0.5f : 0.0f;
    b.show("pillows", shop.fabric(linen, 0.001),
           cushion({0.46f, wide, 0.16f}, 0.15f, 0.05f, dice.seed(), 0.20f, 0.008f)
               .turned(Axis::kY, 11)
               .turned(Axis::kZ, float(dice.uniform(-3, 3)))
               .moved(inside + 0.29f, at, lie + 0.085f));
    if (twin && dice.chance(0.6))
      b.show("pillows_small", shop.fabric(shop.style.accent, 0.0013),
             cushion({0.12f, 0.42f, 0.42f}, 0.25f, 0.03f, dice.seed(), 0.12f, 0.006f)
                 .turned(Axis::kY, -38)
                 .turned(Axis::kZ, float(dice.uniform(-10, 10)))
                 .moved(inside + 0.47f, at * 0.9f, lie + 0.23f));
  }
  if (dice.chance(0.45)) {
    // A throw across the foot.
    b.show("throw",
           shop.fabric(dice.pick<Vec3>({shop.style.accent, {0.74, 0.57, 0.30}, {0.30, 0.31, 0.33}}),
                       0.003),
           quilt(x - 0.75f, x - 0.30f, my + 0.024f, lie + 0.042f, 0.17f, folds, 0.007f));
  }
  b.collide_box({inside, -y, 0.165f}, {x, y, deck});
  b.collide_box({m0, -my - 0.02f, deck}, {x, my + 0.02f, lie + 0.03f});
  b.collide_box({inside + 0.06f, -my + 0.03f, lie + 0.03f},
                {inside + 0.52f, my - 0.03f, lie + 0.14f});
  b.mass = 22 + 24.0 * double(size.x * size.y);  // mattress of 60 kg/m³ and 0.2 m, frame, bedding
  p.front = 0.5f;
  return p;
}

constexpr PropKind kBeds[] = {
    {"bed", bed, "bed, single to double by its width, made up"},
};

}  // namespace

PropFamily beds() { return kBeds; }

}  // namespace gloam
