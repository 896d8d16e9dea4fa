// Seats of kitchens: at a bar, and for children.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Prop bar_stool(Workshop& shop) {
  const Vec3f size = shop.size({0.42f, 0.42f, float(shop.dice.uniform(0.65, 0.76))});
  const float z = std::clamp(size.z, 0.55f, 0.85f), r = std::clamp(size.y, 0.34f, 0.5f) / 2 - 0.01f;
  const std::string frame = shop.dice.chance(0.5) ? shop.wood(Axis::kZ) : shop.metal("black");
  const float top = r * 0.72f, foot = r;
  Prop p;
  PropPart& b = p.body();
  Path loop;
  for (const float sx : {-1.0f, 1.0f}) {
    for (const float sy : {-1.0f, 1.0f}) {
      const float a = 0.70711f;
      b.show("legs", frame,
             bar({sx * foot * a, sy * foot * a, 0.004f}, {sx * top * a, sy * top * a, z - 0.035f},
                 0.011f, 0.015f, 14));
      b.show("pads", shop.rubber(),
             cylinder(0.012f, 0, 0.006f, 0.001f, 12).moved(sx * foot * a, sy * foot * a, 0));
      b.collide_capsule({sx * foot * a * 0.98f, sy * foot * a * 0.98f, 0.05f},
                        {sx * top * a, sy * top * a, z - 0.06f}, 0.013f);
      b.collide_cylinder(0.013f, 0, 0.04f, sx * foot * a, sy * foot * a);
    }
  }
  const float at = 0.24f, out = foot + (top - foot) * at / (z - 0.035f);
  for (int i = 0; i <= 32; ++i) {
    const float angle = 2 * kPi * float(i) / 32;
    loop.push_back({out * 0.985f * std::cos(angle), out * 0.985f * std::sin(angle), at});
  }
  b.show("ring", shop.metal(), tube(loop, 0.008f, 10));
  const bool padded = shop.dice.chance(0.5);
  const std::string hide = shop.leather(shop.color({0.30, 0.19, 0.12})), wood = shop.wood(Axis::kX);
  b.show("seat", wood,
         lathe(rounded({{0, z - 0.045f},
                        {r * 0.88f, z - 0.045f},
                        {r * 0.98f, z - 0.025f},
                        {r * 0.98f, z - 0.012f},
                        {r * 0.7f, z - 0.014f},
                        {0, z - 0.019f}},
                       0.009f, 3),
               44));
  if (padded)
    b.show(
        "pad", hide,
        lathe(
            rounded(
                {{r * 0.97f, z - 0.022f}, {r, z - 0.010f}, {r * 0.9f, z + 0.022f}, {0, z + 0.030f}},
                0.02f, 4),
            44));
  b.collide_cylinder(r, z - 0.045f, padded ? z + 0.022f : z - 0.014f);
  b.mass = 5.5;
  p.loose = true;
  return p;
}

Prop high_chair(Workshop& shop) {
  const std::string wood = shop.wood("birch", Axis::kZ), across = shop.wood("birch", Axis::kY);
  const std::string white = shop.plastic({0.88, 0.88, 0.86}, 0.3),
                    soft = shop.fabric(shop.color(shop.style.accent));
  Prop p;
  PropPart& b = p.body();
  const float seat = 0.56f;
  for (const float side : {-1.0f, 1.0f}) {
    const float y = side * 0.20f, foot = side * 0.26f;
    b.show("legs", wood, bar({0.26f, foot, 0.0035f}, {0.11f, y, seat + 0.01f}, 0.013f, 0.017f, 14));
    b.show("legs", wood,
           bar({-0.27f, foot, 0.0035f}, {-0.13f, y, seat + 0.01f}, 0.013f, 0.017f, 14));
    b.show("rails", across,
           bar({0.21f, side * 0.24f, 0.18f}, {-0.225f, side * 0.242f, 0.18f}, 0.009f, 0.009f, 10));
    b.collide_capsule({0.25f, foot * 0.99f, 0.05f}, {0.11f, y, seat - 0.02f}, 0.015f);
    b.collide_capsule({-0.26f, foot * 0.99f, 0.05f}, {-0.13f, y, seat - 0.02f}, 0.015f);
    b.collide_cylinder(0.013f, 0, 0.04f, 0.257f, foot);
    b.collide_cylinder(0.013f, 0, 0.04f, -0.267f, foot);
  }
  b.show("rails", across,
         bar({-0.225f, -0.242f, 0.18f}, {-0.225f, 0.242f, 0.18f}, 0.009f, 0.009f, 10));
  b.show("footrest", across, slab({0.165f, -0.225f, 0.28f}, {0.245f, 0.225f, 0.296f}, 0.006f, 2));
  // Shell: seat, sides and back in one piece.
  const auto section = [&](float in, float z, float lean) {
    return ring({-0.17f + in - lean, -0.19f + in}, {0.15f - in, 0.19f - in}, 0.06f, z, 5);
  };
  b.show(
      "shell", white,
      loft({point_of(section(0, 0, 0), {0, 0, seat}), section(0.03f, seat, 0),
            section(0.008f, seat + 0.012f, 0), section(0, seat + 0.05f, 0.005f),
            section(-0.004f, seat + 0.15f, 0.02f), section(0.001f, seat + 0.154f, 0.02f),
            section(0.004f, seat + 0.15f, 0.02f), section(0.012f, seat + 0.05f, 0.005f),
            section(0.03f, seat + 0.022f, 0), point_of(section(0, 0, 0), {0, 0, seat + 0.018f})}));
  b.show("back", white,
         rounded_box({0.022f, 0.34f, 0.36f}, 0.010f, 3)
             .turned(Axis::kY, -12)
             .moved(-0.205f, 0, seat + 0.29f));
  b.show("pad", soft,
         cushion({0.25f, 0.31f, 0.035f}, 0.25f, 0.014f, shop.dice.seed(), 1, 0.001f)
             .moved(-0.015f, 0, seat + 0.04f));
  b.show("back_pad", soft,
         cushion({0.03f, 0.29f, 0.32f}, 0.25f, 0.012f, shop.dice.seed(), 1, 0.001f)
             .turned(Axis::kY, -12)
             .moved(-0.180f, 0, seat + 0.285f));
  // Tray with a rim, on two arms.
  const float tray = seat + 0.20f;
  const auto edge = [&](float in, float z) {
    return ring({0.055f + in, -0.23f + in}, {0.345f - in, 0.23f - in}, 0.07f, z, 5);
  };
  b.show("tray", white,
         loft({point_of(edge(0, 0), {0.2f, 0, tray}), edge(0.012f, tray),
               edge(0.002f, tray + 0.008f), edge(0, tray + 0.028f), edge(0.004f, tray + 0.031f),
               edge(0.009f, tray + 0.027f), edge(0.018f, tray + 0.012f), edge(0.03f, tray + 0.009f),
               point_of(edge(0, 0), {0.2f, 0, tray + 0.009f})}));
  for (const float side : {-1.0f, 1.0f})
    b.show("arms", white,
           slab({-0.13f, side * 0.195f - 0.012f, tray - 0.035f},
                {0.25f, side * 0.195f + 0.012f, tray + 0.002f}, 0.008f, 2));
  b.collide_box({-0.18f, -0.19f, seat - 0.005f}, {0.15f, 0.19f, seat + 0.03f});
  b.collide_box({-0.205f, 0, seat + 0.29f}, {0.02f, 0.17f, 0.18f},
                turn({0, 1, 0}, -12 * M_PI / 180));
  b.collide_box({0.055f, -0.23f, tray}, {0.345f, 0.23f, tray + 0.03f});
  for (const float side : {-1.0f, 1.0f})
    b.collide_box({-0.19f, side * 0.195f - 0.012f, seat + 0.03f},
                  {0.16f, side * 0.195f + 0.012f, tray + 0.002f});
  b.mass = 6.5;
  p.loose = true;
  return p;
}

constexpr PropKind kKitchenSeats[] = {
    {"bar_stool", bar_stool, "stool for a bar, with a ring for the feet"},
    {"high_chair", high_chair, "child's chair with a tray"},
};

}  // namespace

PropFamily kitchen_seats() { return kKitchenSeats; }

}  // namespace gloam
