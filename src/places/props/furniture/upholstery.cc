// Sofas and armchairs, poufs.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// A frame with arms and a back, `seats` loose cushions, pillows.
Prop upholstered(Workshop& shop, Vec3f size, int seats, int pillows) {
  Dice& dice = shop.dice;
  const float x = size.x / 2, y = size.y / 2, arm = float(dice.uniform(0.13, 0.20));
  const float foot = float(dice.uniform(0.10, 0.15)), base = foot + 0.17f, seat = 0.45f;
  const float arm_top = float(dice.uniform(0.56, 0.64));
  const std::string cloth =
      dice.chance(0.2) ? shop.leather(shop.color({0.30, 0.17, 0.10}))
                       : shop.fabric(shop.color(shop.style.fabric), dice.uniform(0.0012, 0.002));
  Prop p;
  PropPart& b = p.body();
  b.show("frame", cloth,
         slab({-x + 0.03f, -y + 0.02f, foot}, {x - 0.03f, y - 0.02f, base}, 0.025f, 2));
  const float back_tall = size.z - foot - 0.10f;
  b.show("frame", cloth,
         rounded_box({0.17f, size.y - 2 * arm + 0.10f, back_tall}, 0.055f, 3, 2)
             .turned(Axis::kY, -6)
             .moved(-x + 0.085f + 0.053f * back_tall, 0, foot + 0.02f + back_tall / 2));
  for (const float side : {-1.0f, 1.0f})
    b.show("arms", cloth,
           rounded_box({size.x - 0.02f, arm, arm_top - foot}, min(0.06f, 0.42f * arm), 3, 2)
               .moved(0, side * (y - arm / 2), (arm_top + foot) / 2));
  const float inner = size.y - 2 * arm, each = inner / float(seats), deep = size.x - 0.20f;
  for (int k = 0; k < seats; ++k) {
    const float at = -inner / 2 + each * (float(k) + 0.5f);
    b.show("seat_cushions", cloth,
           cushion({deep, each - 0.008f, seat - base}, 0.13f, 0.045f, dice.seed(), 1, 0.003f)
               .moved(x - deep / 2 - 0.005f, at, (seat + base) / 2));
    const float tall = size.z - seat - 0.01f + 0.05f;
    b.show("back_cushions", cloth,
           cushion({0.17f, each - 0.02f, tall}, 0.28f, 0.05f, dice.seed())
               .turned(Axis::kY, -12)
               .moved(-x + 0.28f, at, seat + tall / 2 - 0.025f));
  }
  for (int k = 0; k < pillows; ++k) {
    const float side = k % 2 == 0 ? -1.0f : 1.0f, edge = float(dice.uniform(0.40, 0.48));
    const Vec3 tints[] = {
        shop.style.accent, {0.78, 0.57, 0.24}, {0.62, 0.33, 0.24}, {0.86, 0.80, 0.70}};
    const Solid pillow = cushion({0.14f, edge, edge}, 0.25f, 0.03f, dice.seed(), 0.12f, 0.006f)
                             .turned(Axis::kX, float(dice.uniform(-8, 8)))
                             .turned(Axis::kY, -22)
                             .turned(Axis::kZ, side * -float(dice.uniform(8, 22)));
    b.show(k == 0 ? "pillow" : "pillow_2", shop.fabric(tints[dice.integer(0, 3)], 0.0013),
           pillow.moved(-x + 0.45f, side * (inner / 2 - edge * 0.46f), seat + edge / 2 + 0.005f));
  }
  b.show("legs", dice.chance(0.7) ? shop.wood(Axis::kZ) : shop.metal("black"),
         round_legs(x - 0.10f, y - 0.10f, foot + 0.01f, 0.014f, 0.023f));
  const float top = size.z - 0.02f;
  b.collide_box({-x + 0.02f, -y + 0.01f, foot}, {x - 0.01f, y - 0.01f, base + 0.01f});
  b.collide_box({-x + 0.06f, -inner / 2, base + 0.01f}, {x - 0.01f, inner / 2, seat});
  b.collide_box({-x + 0.03f, -inner / 2, seat}, {-x + 0.34f, inner / 2, top});
  for (const float side : {-1.0f, 1.0f})
    b.collide_box({-x + 0.02f, side * (y - arm / 2) - arm / 2, base + 0.01f},
                  {x - 0.02f, side * (y - arm / 2) + arm / 2, arm_top});
  collide_legs(&b, x - 0.09f, y - 0.09f, foot, 0.020f);
  b.mass = 22.0 + 18.0 * double(size.x * size.y) * (seats > 1 ? 1 : 0.5);
  p.front = 0.6f;
  return p;
}

Prop sofa(Workshop& shop) {
  const Vec3f size = limited(
      shop.size({float(shop.dice.uniform(0.84, 0.94)), float(shop.dice.uniform(1.6, 2.3)), 0.82f}),
      {0.75f, 1.3f, 0.72f}, {1.1f, 3.4f, 1.0f});
  return upholstered(shop, size, std::max(2, int(std::lround((size.y - 0.33f) / 0.72f))),
                     shop.dice.integer(0, 2));
}

Prop armchair(Workshop& shop) {
  const Vec3f size = limited(shop.size({float(shop.dice.uniform(0.80, 0.88)),
                                        float(shop.dice.uniform(0.78, 0.92)), 0.84f}),
                             {0.7f, 0.7f, 0.72f}, {1.0f, 1.1f, 1.05f});
  return upholstered(shop, size, 1, shop.dice.chance(0.4) ? 1 : 0);
}

Prop pouf(Workshop& shop) {
  const Vec3f size = limited(
      shop.size({float(shop.dice.uniform(0.42, 0.56)), 0, float(shop.dice.uniform(0.32, 0.42))}),
      {0.35f, 0, 0.25f}, {0.8f, 10, 0.5f});
  const float r = size.x / 2, h = size.z;
  const Profile outline = rounded(
      {{0, 0}, {0.80f * r, 0}, {r, 0.48f * h}, {0.82f * r, 0.985f * h}, {0, h}}, 0.40f * h, 5);
  constexpr int kAround = 96, kRibs = 12;
  Path points;
  for (const Vec2f at : outline) {
    for (int k = 0; k <= kAround; ++k) {
      // Twelve wedges of cloth with seams between them.
      const float a = 2 * kPi * float(k) / kAround,
                  rib = 1 - 0.035f * std::pow(1 - std::fabs(std::sin(0.5f * kRibs * a)), 3.0f);
      points.push_back({at.x * rib * std::cos(a), at.x * rib * std::sin(a), at.y});
    }
  }
  Prop p;
  PropPart& b = p.body();
  const Vec3 color = shop.color(shop.dice.pick<Vec3>(
      {shop.style.accent, {0.62, 0.33, 0.24}, {0.74, 0.70, 0.63}, {0.24, 0.27, 0.34}}));
  b.show("cover", shop.fabric(color, 0.0025), sheet(points, kAround + 1));
  b.show("button", shop.fabric(color, 0.0025),
         ball(0.022f, 14).scaled({1, 1, 0.4f}).moved(0, 0, h - 0.003f));
  b.collide_cylinder(0.82f * r, 0, h);
  b.collide_cylinder(0.97f * r, 0.25f * h, 0.75f * h);
  b.mass = 60.0 * M_PI * double(r * r * h);  // loose filling, 60 kg/m³
  p.surfaces.push_back({{-0.4f * r, -0.4f * r}, {0.4f * r, 0.4f * r}, h});
  p.loose = true;
  return p;
}

constexpr PropKind kUpholstery[] = {
    {"sofa", sofa, "sofa of two to four seats with loose cushions and pillows"},
    {"armchair", armchair, "upholstered chair with arms"},
    {"pouf", pouf, "round stuffed seat with ribs"},
};

}  // namespace

PropFamily upholstery() { return kUpholstery; }

}  // namespace gloam
