// Seats without arms or with castors.

#include <cmath>

#include "places/props/parts/hardware.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

Prop stool(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.38f, 0.38f, float(shop.dice.pick({0.45, 0.46, 0.65}))}),
                             {0.28f, 0.28f, 0.25f}, {0.5f, 0.5f, 0.8f});
  const float r = 0.46f * min(size.x, size.y), z = size.z, top = 0.032f;
  Prop p;
  PropPart& b = p.body();
  b.show("seat", shop.wood(Axis::kX),
         lathe(rounded({{0, z - top},
                        {0.92f * r, z - top},
                        {r, z - 0.014f},
                        {0.97f * r, z},
                        {0.72f * r, z - 0.004f},
                        {0, z - 0.008f}},
                       0.008f, 3),
               44));
  const float in = 0.62f * r, out = 0.98f * r;
  for (int k = 0; k < 4; ++k) {
    const float a = kPi / 4 + kPi / 2 * float(k), c = std::cos(a), s = std::sin(a);
    const Solid leg =
        bar({out * c, out * s, 0}, {in * c, in * s, z - top + 0.004f}, 0.012f, 0.017f, 14);
    b.show("legs", shop.wood(Axis::kZ), standing(leg));
    b.collide_cylinder({(0.93f * out + 0.07f * in) * c, (0.93f * out + 0.07f * in) * s, 0.06f},
                       {in * c, in * s, z - top}, 0.015f);
    const float fx = 0.96f * out * c, fy = 0.96f * out * s;
    b.collide_capsule({fx, fy, 0.013f}, {fx, fy, 0.057f}, 0.013f);
    // Rungs, two by two at different heights.
    const float h = z * (k % 2 ? 0.34f : 0.40f), q = out + (in - out) * h / (z - top),
                c2 = std::cos(a + kPi / 2), s2 = std::sin(a + kPi / 2);
    b.show("rungs", shop.wood(Axis::kX),
           bar({q * c, q * s, h}, {q * c2, q * s2, h}, 0.008f, 0.008f, 10));
  }
  b.collide_cylinder(r, z - top, z - 0.002f);
  b.mass = 1.4 + 3.2 * double(z);
  p.surfaces.push_back({{-0.6f * r, -0.6f * r}, {0.6f * r, 0.6f * r}, z - 0.002f});
  p.loose = true;
  return p;
}

Prop bench(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.38f, float(shop.dice.uniform(0.95, 1.35)), 0.46f}),
                             {0.25f, 0.6f, 0.35f}, {0.6f, 2.2f, 0.55f});
  const float x = size.x / 2, y = size.y / 2, z = size.z;
  const bool soft = shop.dice.chance(0.5);
  const float seat = soft ? z - 0.055f : z, t = 0.03f;
  Prop p;
  PropPart& b = p.body();
  if (soft) {
    b.show(
        "cushion", shop.fabric(shop.color(shop.style.accent), 0.0016),
        cushion({size.x - 0.01f, size.y - 0.01f, 0.062f}, 0.08f, 0.02f, shop.dice.seed(), 1, 0.001f)
            .moved(0, 0, z - 0.031f));
    b.show("seat", shop.wood(Axis::kY), slab({-x, -y, seat - t}, {x, y, seat}, 0.005f, 2));
  } else {
    // Three boards with gaps.
    for (int k = 0; k < 3; ++k) {
      const float w = (size.x - 0.016f) / 3, x0 = -x + (w + 0.008f) * float(k);
      b.show("seat", shop.wood(Axis::kY), slab({x0, -y, seat - t}, {x0 + w, y, seat}, 0.005f, 2));
    }
  }
  b.show("legs", shop.wood(Axis::kZ),
         round_legs(x - 0.055f, y - 0.12f, seat - t, 0.015f, 0.023f, 0.025f));
  for (const float side : {-1.0f, 1.0f})
    b.show("bearers", shop.wood(Axis::kX),
           slab({-x + 0.03f, side * (y - 0.12f) - 0.018f, seat - t - 0.03f},
                {x - 0.03f, side * (y - 0.12f) + 0.018f, seat - t}, 0.003f));
  b.show("stretcher", shop.wood(Axis::kY),
         slab({-0.012f, -y + 0.12f, seat - t - 0.028f}, {0.012f, y - 0.12f, seat - t - 0.003f},
              0.002f));
  collide_legs(&b, x - 0.043f, y - 0.108f, seat - t, 0.021f);
  b.collide_box({-x, -y, seat - t}, {x, y, z});
  b.mass = 3 + 24.0 * double(size.x * size.y);
  p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {x - 0.03f, y - 0.03f}, z});
  p.loose = true;
  p.front = 0.3f;
  return p;
}

// A swivel chair on five castors; heights [m].
struct OfficeChair {
  explicit OfficeChair(Workshop& maker) : shop(maker) {
    seat = float(dice.uniform(0.45, 0.52)), top = seat + 0.52f;
    black = shop.plastic({0.11, 0.11, 0.113}, 0.45);
    pale = dice.chance(0.3);
    shell = pale ? shop.plastic({0.72, 0.72, 0.71}, 0.4) : black;
    cloth = shop.fabric(
        shop.color(dice.pick<Vec3>(
            {{0.145, 0.145, 0.15}, {0.20, 0.22, 0.25}, shop.style.accent, {0.34, 0.10, 0.09}})),
        0.0014);
  }

  void show_castor_arm(PropPart& b, int k) const;
  void show_seat(PropPart& b) const;
  void show_back(PropPart& b) const;
  void show_arm_rests(PropPart& b) const;

  Workshop& shop;
  Dice& dice = shop.dice;
  float seat = 0, top = 0;
  std::string black, shell, cloth;
  bool pale = false;
};

// One of five arms, each on a twin castor.
void OfficeChair::show_castor_arm(PropPart& b, int k) const {
  const float a = 2 * kPi * float(k) / 5, degrees = 72.0f * float(k), c = std::cos(a),
              s = std::sin(a), r = 0.29f;
  b.show(
      "base", pale ? shop.metal("aluminium") : shell,
      extrude(
          rounded_outline(
              {{0.02f, -0.028f}, {0.30f, -0.015f}, {0.312f, 0}, {0.30f, 0.015f}, {0.02f, 0.028f}},
              0.006f, 2),
          0.065f, 0.090f)
          .turned(Axis::kY, 2)
          .turned(Axis::kZ, degrees)
          .moved(0, 0, 0.010f));
  const float twist = float(dice.uniform(0, 360));
  for (const float side : {-1.0f, 1.0f})
    b.show("castors", black,
           cylinder(0.028f, -0.009f, 0.009f, 0.005f, 20)
               .moved(0, 0, side * 0.014f)
               .turned(Axis::kX, 90)
               .turned(Axis::kZ, twist)
               .moved(r * c, r * s, 0.028f));
  b.show("castors", black,
         cylinder(0.008f, 0.03f, 0.07f, 0.002f, 12).moved(r * c, r * s, 0) +
             rounded_box({0.042f, 0.012f, 0.026f}, 0.005f, 2)
                 .moved(0.004f, 0, 0.042f)
                 .turned(Axis::kZ, twist)
                 .moved(r * c, r * s, 0));
  b.collide_box({0.16f * c, 0.16f * s, 0.084f}, {0.145f, 0.022f, 0.016f},
                turn({0, 0, 1}, double(a)));
  b.collide_capsule({r * c, r * s, 0.027f}, {r * c, r * s, 0.041f}, 0.027f);
  b.colliders.back().friction = 0.15;  // castors roll
}

void OfficeChair::show_seat(PropPart& b) const {
  b.show("base_hub", pale ? shop.metal("aluminium") : shell,
         cylinder(0.038f, 0.062f, 0.118f, 0.006f, 28));
  b.show("gas_lift", black, cylinder(0.026f, 0.11f, 0.25f, 0.004f, 24));
  b.show("piston", shop.metal("chrome"), cylinder(0.014f, 0.24f, seat - 0.10f, 0.001f, 20));
  b.show("mechanism", black,
         slab({-0.13f, -0.08f, seat - 0.115f}, {0.09f, 0.08f, seat - 0.075f}, 0.012f, 2) +
             bar({0.0f, 0.07f, seat - 0.10f}, {0.03f, 0.24f, seat - 0.095f}, 0.005f, 0.005f, 8) +
             slab({0.01f, 0.22f, seat - 0.104f}, {0.05f, 0.28f, seat - 0.09f}, 0.005f, 2));
  b.show("seat_pan", shell,
         rounded_box({0.47f, 0.47f, 0.03f}, 0.014f, 2).moved(0.02f, 0, seat - 0.062f));
  b.show("seat", cloth,
         cushion({0.49f, 0.49f, 0.065f}, 0.25f, 0.03f, dice.seed(), 1, 0.001f)
             .moved(0.02f, 0, seat - 0.030f));
}

// An upholstered or netted shell, curved to the sitter, on a spine.
void OfficeChair::show_back(PropPart& b) const {
  constexpr int kAcross = 16, kUp = 14;
  Path points;
  for (int i = 0; i <= kUp; ++i) {
    const float v = float(i) / kUp, h = seat + 0.06f + (top - seat - 0.06f) * v,
                w = 0.23f * (1 - 0.16f * v) *
                    (0.70f +
                     0.30f * std::pow(max(0.0f, 1 - std::pow(std::fabs(2 * v - 1), 7.0f)), 0.5f));
    for (int j = 0; j <= kAcross; ++j) {
      const float u = 2 * float(j) / kAcross - 1;
      points.push_back(
          {-0.235f - 0.05f * v + 0.045f * u * u + 0.022f * std::sin(3.1f * v), w * u, h});
    }
  }
  b.show("back", cloth, sheet(points, kAcross + 1, 0.034f));
  b.show("spine", shell,
         tube(smooth_path({{-0.10f, 0, seat - 0.095f},
                           {-0.25f, 0, seat - 0.085f},
                           {-0.300f, 0, seat + 0.06f},
                           {-0.305f, 0, seat + 0.26f}}),
              0.019f, 12));
}

void OfficeChair::show_arm_rests(PropPart& b) const {
  for (const float side : {-1.0f, 1.0f}) {
    b.show("arms", shell,
           tube(smooth_path({{0.0f, side * 0.20f, seat - 0.06f},
                             {0.0f, side * 0.285f, seat - 0.035f},
                             {-0.01f, side * 0.295f, seat + 0.10f},
                             {-0.01f, side * 0.285f, seat + 0.205f}}),
                0.014f, 10));
    b.show("arm_pads", black,
           slab({-0.11f, side * 0.285f - 0.042f, seat + 0.20f},
                {0.13f, side * 0.285f + 0.042f, seat + 0.228f}, 0.012f, 3));
    b.collide_box({-0.11f, side * 0.285f - 0.042f, seat + 0.05f},
                  {0.13f, side * 0.285f + 0.042f, seat + 0.228f});
  }
}

Prop office_chair(Workshop& shop) {
  const OfficeChair c(shop);
  Prop p;
  PropPart& b = p.body();
  for (int k = 0; k < 5; ++k) c.show_castor_arm(b, k);
  c.show_seat(b);
  c.show_back(b);
  if (shop.dice.chance(0.7)) c.show_arm_rests(b);
  b.collide_cylinder(0.03f, 0.10f, c.seat - 0.11f);
  b.collide_box({-0.225f, -0.24f, c.seat - 0.11f}, {0.265f, 0.24f, c.seat});
  b.collide_box({-0.292f, 0, (c.seat + 0.03f + c.top) / 2},
                {0.026f, 0.225f, (c.top - c.seat - 0.03f) / 2}, turn({0, 1, 0}, -0.08));
  b.mass = 13;
  p.loose = true;
  return p;
}

constexpr PropKind kSeats[] = {
    {"stool", stool, "round wooden stool"},
    {"bench", bench, "wooden bench, plain or with a cushion"},
    {"office_chair", office_chair, "swivel chair on five castors"},
};

}  // namespace

PropFamily seats() { return kSeats; }

}  // namespace gloam
