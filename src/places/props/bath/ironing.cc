// Drying and ironing.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Prop drying_rack(Workshop& shop) {
  const std::string white = shop.paint({0.88, 0.88, 0.88}, 0.35),
                    grey = shop.plastic({0.35, 0.36, 0.38});
  Prop p;
  PropPart& b = p.body();
  const float x = 0.28f, y = 0.52f, z = 0.95f;
  // Two trestles that cross, the frame on them, and a wing at each end.
  for (const float side : {-1.0f, 1.0f}) {
    const float foot = side * 0.27f, top = -side * 0.25f;
    for (const float end : {-1.0f, 1.0f}) {
      const float at = end * (y - 0.02f - (side > 0 ? 0.016f : 0));
      b.show("legs", white, bar({foot, at, 0.012f}, {top, at, z - 0.02f}, 0.008f, 0.008f, 10));
      b.show("feet", grey, ball(0.012f, 12).moved(foot, at, 0.012f));
      b.collide_capsule({foot * 0.97f, at, 0.05f}, {top, at, z - 0.04f}, 0.008f);
      b.collide_box({foot - 0.01f, at - 0.01f, 0}, {foot + 0.01f, at + 0.01f, 0.03f});
    }
    b.show(
        "legs", white,
        bar({foot * 0.9f, -y + 0.03f, 0.06f}, {foot * 0.9f, y - 0.03f, 0.06f}, 0.006f, 0.006f, 8));
  }
  const auto frame = [&](float x0, float x1, float z0, float z1) {
    b.show("frame", white,
           tube({{x0, -y, z0}, {x1, -y, z1}}, 0.0075f, 8) +
               tube({{x0, y, z0}, {x1, y, z1}}, 0.0075f, 8) +
               tube({{x0, -y - 0.007f, z0}, {x0, y + 0.007f, z0}}, 0.0075f, 8) +
               tube({{x1, -y - 0.007f, z1}, {x1, y + 0.007f, z1}}, 0.0075f, 8));
    for (int i = 1; i < 7; ++i) {
      const float t = float(i) / 7;
      b.show("wires", white,
             bar({x0 + (x1 - x0) * t, -y, z0 + (z1 - z0) * t},
                 {x0 + (x1 - x0) * t, y, z0 + (z1 - z0) * t}, 0.002f, 0.002f, 6));
    }
  };
  frame(-x, x, z, z);
  frame(x + 0.012f, x + 0.30f, z - 0.004f, z + 0.10f);
  frame(-x - 0.012f, -x - 0.30f, z - 0.004f, z + 0.10f);
  b.collide_box({-x, -y, z - 0.008f}, {x, y, z + 0.008f});
  for (const float side : {-1.0f, 1.0f})
    b.collide_box({side * (x + 0.156f), 0, z + 0.048f}, {0.15f, y, 0.008f},
                  turn({0, -side, 0}, 0.346));
  const std::initializer_list<Vec3> dyes = {
      {0.78, 0.76, 0.72}, {0.20, 0.27, 0.40}, {0.48, 0.16, 0.16}, {0.30, 0.36, 0.30},
      {0.62, 0.52, 0.36}, {0.12, 0.12, 0.13}, {0.50, 0.58, 0.66}};
  for (int i = 0; i < 6; ++i) {
    if (i > 2 && shop.dice.chance(0.25)) continue;
    const float at = -x + 2 * x * float(i + 1) / 7;
    const float w = float(shop.dice.uniform(0.30, 0.75)),
                shift = float(shop.dice.uniform(-1, 1)) * (y - 0.05f - w / 2);
    const float drop = float(shop.dice.uniform(0.25, 0.5)),
                behind = drop * float(shop.dice.uniform(0.6, 1));
    const Solid cloth = draped(w, drop, behind, 0.003f, shop.dice.seed(), 0.003f);
    const Vec3 dye = shop.dice.pick(dyes);
    b.show("cloth_" + std::to_string(i), shop.fabric(i == 0 ? shop.color(dye) : dye, 0.0012),
           cloth.moved(at, shift, z));
  }
  b.collide_box({-x + 0.06f, -y + 0.1f, z - 0.38f}, {x - 0.04f, y - 0.1f, z - 0.008f});
  b.mass = 5.5;
  p.loose = true;
  return p;
}

Prop ironing_board(Workshop& shop) {
  const std::string white = shop.paint({0.86, 0.86, 0.86}, 0.3),
                    cover = shop.fabric(
                        shop.color(shop.dice.pick<Vec3>(
                            {{0.35, 0.45, 0.55}, {0.62, 0.58, 0.50}, {0.50, 0.56, 0.48}})),
                        0.0012);
  Prop p;
  PropPart& b = p.body();
  const float x = 0.19f, y = 0.62f, z = 0.88f;
  // Outline: blunt at -y, a round nose at +y.
  Path plate;
  for (int i = 0; i < 48; ++i) {
    const float angle = 2 * kPi * float(i) / 48, c = std::cos(angle), s = std::sin(angle);
    const float full = s > 0 ? 1.3f : 0.35f;  // exponent across
    plate.push_back({x * std::copysign(std::pow(std::fabs(c), full), c),
                     y * std::copysign(std::pow(std::fabs(s), 0.9f), s), 0});
  }
  const auto at = [&](float scale, float h) {
    Path out = plate;
    for (Vec3f& v : out) v = {v.x * scale, v.y * (1 - (1 - scale) * x / y), h};
    return out;
  };
  b.show("cover", cover,
         loft({point_of(plate, {0, 0, z - 0.028f}), at(0.93f, z - 0.028f), at(0.985f, z - 0.024f),
               at(1, z - 0.012f), at(0.99f, z - 0.003f), at(0.96f, z),
               point_of(plate, {0, 0, z + 0.001f})}));
  for (const float side : {-1.0f, 1.0f}) {
    const float foot = side * 0.42f, top = -side * 0.30f, wide = side > 0 ? 0.16f : 0.11f;
    for (const float across : {-1.0f, 1.0f}) {
      b.show("legs", white,
             tube({{across * wide, foot, 0.012f}, {across * wide * 0.35f, top, z - 0.035f}}, 0.011f,
                  10));
      b.collide_capsule({across * wide * 0.98f, foot * 0.97f, 0.04f},
                        {across * wide * 0.36f, top, z - 0.05f}, 0.011f);
      b.show("caps", shop.rubber(),
             ball(0.0155f, 14).moved(across * (wide + 0.035f), foot, 0.0155f));
      b.collide_box({across * (wide + 0.035f) - 0.012f, foot - 0.012f, 0},
                    {across * (wide + 0.035f) + 0.012f, foot + 0.012f, 0.026f});
    }
    b.show(
        "legs", white,
        bar({-wide - 0.035f, foot, 0.0155f}, {wide + 0.035f, foot, 0.0155f}, 0.011f, 0.011f, 12));
    b.show(
        "legs", white,
        bar({-wide * 0.36f, top, z - 0.035f}, {wide * 0.36f, top, z - 0.035f}, 0.009f, 0.009f, 10));
  }
  b.show("pivot", shop.metal("chrome"),
         bar({-0.11f, 0.06f, 0.455f}, {0.11f, 0.06f, 0.455f}, 0.006f, 0.006f, 10));
  // Rest for the iron, and the iron.
  for (const float side : {-0.09f, 0.09f})
    b.show("rest", shop.metal("chrome"),
           tube({{side, -y + 0.05f, z - 0.02f}, {side, -y - 0.16f, z - 0.004f}}, 0.005f, 8));
  for (int i = 0; i < 5; ++i)
    b.show("rest", shop.metal("chrome"),
           bar({-0.09f, -y - 0.03f * float(i) - 0.035f, z - 0.008f},
               {0.09f, -y - 0.03f * float(i) - 0.035f, z - 0.008f}, 0.003f, 0.003f, 8));
  const auto sole = [&](float scale, float lift, float h) {
    Path out;
    for (const Vec3f v : plate)
      out.push_back({v.x * 0.30f * scale, v.y * 0.20f * scale + 0.25f + lift, z + h});
    return out;
  };
  b.show("sole", shop.metal("steel"),
         loft({point_of(plate, {0, 0.25f, z + 0.001f}), sole(0.98f, 0, 0.001f), sole(1, 0, 0.004f),
               sole(1, 0, 0.009f)}));
  b.show("iron", shop.plastic(shop.style.accent, 0.25),
         loft({sole(0.98f, 0, 0.009f), sole(0.96f, 0, 0.03f), sole(0.78f, -0.012f, 0.055f),
               sole(0.5f, -0.03f, 0.072f), point_of(plate, {0, 0.22f, z + 0.076f})}));
  b.show("handle", shop.plastic({0.10, 0.10, 0.11}),
         tube(smooth_path({{0, 0.315f, z + 0.045f},
                           {0, 0.31f, z + 0.09f},
                           {0, 0.28f, z + 0.118f},
                           {0, 0.19f, z + 0.122f},
                           {0, 0.15f, z + 0.10f},
                           {0, 0.145f, z + 0.05f}},
                          5),
              0.013f, 12));
  b.collide_box({-x, -y, z - 0.028f}, {x, 0.25f, z});
  b.collide_box({-x * 0.7f, 0.25f, z - 0.028f}, {x * 0.7f, 0.52f, z});
  b.collide_box({-0.05f, 0.14f, z}, {0.05f, 0.36f, z + 0.125f});
  b.collide_box({-0.095f, -y - 0.16f, z - 0.02f}, {0.095f, -y, z});
  b.mass = 7;
  p.loose = true;
  return p;
}

constexpr PropKind kIroning[] = {
    {"drying_rack", drying_rack, "folding rack with laundry"},
    {"ironing_board", ironing_board, "ironing board with an iron"},
};

}  // namespace

PropFamily ironing() { return kIroning; }

}  // namespace gloam
