// Cloth: rugs, curtains, cushions for the floor.

#include <fmt/format.h>

#include <cmath>

#include "places/props/furniture/art.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

Prop rug(Workshop& shop) {
  Dice& dice = shop.dice;
  const double usual = dice.uniform(1.1, 1.7);
  const Vec3f size = limited(shop.size({float(usual), float(1.4 * usual), 0.007f}),
                             {0.4f, 0.5f, 0.006f}, {4, 6, 0.008f});
  const float x = size.x / 2, y = size.y / 2, z = size.z;
  Prop p;
  PropPart& b = p.body();
  const Vec3 ground = shop.color(dice.pick<Vec3>({{0.62, 0.58, 0.52},
                                                  {0.42, 0.22, 0.18},
                                                  {0.24, 0.32, 0.38},
                                                  {0.55, 0.47, 0.36},
                                                  shop.style.accent}));
  const uint64_t seed = dice.seed();
  const int rows = 360, columns = std::clamp(int(std::lround(360 * size.x / size.y)), 60, 1080);
  // The pile: a sheet that waves by a millimetre, its rim bound.
  constexpr int kCells = 24;
  const float phase = float(dice.uniform(0, 6));
  Path points;
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j) {
      const float u = float(j) / kCells, v = float(i) / kCells,
                  px = -x + 0.006f + (size.x - 0.012f) * u,
                  py = -y + 0.006f + (size.y - 0.012f) * v;
      points.push_back(
          {px, py,
           z - 0.0012f + 0.0011f * std::sin(5 * px + phase) * std::sin(4 * py + 1.7f * phase)});
    }
  b.show("pile",
         shop.picture(
             fmt::format("rug_{:016x}_{}_{:02x}{:02x}{:02x}", seed, columns, int(ground.x * 255),
                         int(ground.y * 255), int(ground.z * 255)),
             [=] { return paint_rug(seed, columns, rows, ground); }, 0.95),
         sheet(points, kCells + 1));
  const std::string edge = shop.fabric({ground.x * 0.5, ground.y * 0.5, ground.z * 0.5}, 0.002);
  for (const float s : {-1.0f, 1.0f}) {
    b.show("binding", edge,
           slab({s * (x - 0.005f) - 0.005f, -y, 0}, {s * (x - 0.005f) + 0.005f, y, z}, 0.003f, 2));
    b.show("binding", edge,
           slab({-x + 0.01f, s * (y - 0.005f) - 0.005f, 0},
                {x - 0.01f, s * (y - 0.005f) + 0.005f, z}, 0.003f, 2));
  }
  if (dice.chance(0.5)) {
    // Fringes at both ends.
    const std::string yarn = shop.fabric({0.80, 0.76, 0.68}, 0.001);
    const int count = int(size.x / 0.016f);
    for (const float s : {-1.0f, 1.0f})
      for (int k = 0; k < count; ++k) {
        const float at = -x + 0.012f + (size.x - 0.024f) * float(k) / float(count - 1),
                    off = float(dice.uniform(-0.006, 0.006));
        b.show("fringes", yarn,
               bar({at, s * (y - 0.002f), 0.003f}, {at + off, s * (y + 0.045f), 0.0022f}, 0.0022f,
                   0.0018f, 5));
      }
  }
  b.collide_box({-x, -y, 0}, {x, y, z});
  b.mass = 2.6 * double(size.x * size.y);  // [kg/m²] of a woven rug
  return p;
}

// Two cloths pushed aside on a rod; the origin lies on the wall at the rod's height.
Prop curtain(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size = limited(shop.size({0.16f, float(dice.uniform(1.6, 2.2)), 2.3f}),
                             {0.12f, 0.7f, 0.6f}, {0.25f, 5, 3.6f});
  const float y = size.y / 2, drop = size.z - 0.02f, middle = size.x - 0.065f, ends = 0.05f;
  Prop p;
  PropPart& b = p.body();
  const std::string metal = shop.metal(dice.pick<const char*>({"black", "steel", "brass"}));
  b.show("rod", metal, bar({middle, -y + ends, 0}, {middle, y - ends, 0}, 0.011f, 0.011f, 16));
  for (const float s : {-1.0f, 1.0f}) {
    b.show("rod", metal,
           ball(0.020f, 18).moved(middle, s * (y - ends + 0.014f), 0) +
               cylinder(0.014f, -0.006f, 0.006f, 0.003f, 18)
                   .turned(Axis::kX, 90)
                   .moved(middle, s * (y - ends - 0.002f), 0));
    b.show("brackets", metal,
           cylinder(0.024f, 0, 0.006f, 0.002f, 20)
                   .turned(Axis::kY, 90)
                   .moved(0, s * (y - 0.11f), -0.016f) +
               bar({0.003f, s * (y - 0.11f), -0.016f}, {middle, s * (y - 0.11f), -0.016f}, 0.006f,
                   0.006f, 10) +
               cylinder(0.016f, -0.006f, 0.006f, 0.003f, 18)
                   .turned(Axis::kX, 90)
                   .moved(middle, s * (y - 0.11f), -0.003f));
  }
  const std::string cloth = shop.fabric(
      shop.color(dice.pick<Vec3>(
          {{0.80, 0.77, 0.71}, {0.66, 0.67, 0.66}, shop.style.accent, {0.70, 0.60, 0.48}})),
      0.0013);
  const float share = float(dice.uniform(0.20, 0.28));
  for (const float s : {-1.0f, 1.0f}) {
    const float wide = share * size.y, outer = y - ends - 0.02f;
    const int folds = std::max(4, int(std::lround(wide / 0.075f)));
    const int columns = 14 * folds;
    constexpr int kRows = 16;
    const float phase = float(dice.uniform(0, 6)), sway = float(dice.uniform(0.85, 1.1));
    Path points;
    for (int i = 0; i <= kRows; ++i) {
      const float t = float(i) / kRows;  // 0 at the rod
      for (int j = 0; j <= columns; ++j) {
        const float u = float(j) / float(columns),
                    a = 2 * kPi * float(folds) * u + 0.5f * std::sin(4 * kPi * u + phase);
        const float deep =
            (0.026f + 0.012f * t + 0.008f * std::sin(9 * u + phase)) * min(1.0f, 0.55f + 1.5f * t);
        const float at = outer - wide * (1 + 0.05f * t * sway) * (1 - u) +
                         0.010f * std::sin(2 * a) * (0.4f + 0.6f * t);
        points.push_back({middle + deep * std::sin(a + 0.35f * std::sin(5 * t + 3 * u + phase)),
                          s * at, -0.024f - t * (drop - 0.024f)});
      }
    }
    b.show("cloth", cloth, sheet(points, columns + 1, 0.0025f));
    for (int k = 0; k <= folds; ++k) {
      const float at = s * (outer - wide * (1 - float(k) / float(folds)));
      Path ring;
      for (int i = 0; i <= 20; ++i)
        ring.push_back({middle + 0.0165f * std::cos(2 * kPi * float(i) / 20), at,
                        -0.006f + 0.0165f * std::sin(2 * kPi * float(i) / 20)});
      b.show("rings", metal, tube(ring, 0.0016f, 6));
    }
    b.collide_box({middle - 0.04f, min(s * (outer - wide), s * outer), -drop},
                  {middle + 0.04f, max(s * (outer - wide), s * outer), -0.02f});
  }
  b.collide_capsule({middle, -y + 0.03f, 0}, {middle, y - 0.03f, 0}, 0.012f);
  b.mass = 1.2 + 1.4 * double(size.y * size.z);
  return p;
}

Prop floor_cushion(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size =
      limited(shop.size({float(dice.uniform(0.5, 0.65)), 0, float(dice.uniform(0.12, 0.16))}),
              {0.3f, 0, 0.08f}, {0.9f, 10, 0.25f});
  const float e = size.x, z = size.z;
  Prop p;
  PropPart& b = p.body();
  const std::string cloth = shop.fabric(
      shop.color(dice.pick<Vec3>(
          {shop.style.accent, {0.72, 0.52, 0.24}, {0.60, 0.34, 0.26}, {0.66, 0.64, 0.58}})),
      0.0022);
  Solid body = cushion({e, e, 0.80f * z}, 0.25f, 0.05f, dice.seed(), 0.55f, 0.003f);
  const float low = body.low().z, scale = z / (body.high().z - low);
  b.show("cover", cloth, body.moved(0, 0, -low).scaled({1, 1, scale}));
  b.show("button", cloth, ball(0.018f, 14).scaled({1, 1, 0.4f}).moved(0, 0, z - 0.002f));
  b.collide_box({-0.43f * e, -0.43f * e, 0}, {0.43f * e, 0.43f * e, 0.94f * z});
  b.mass = 45.0 * double(e * e * z);
  p.loose = true;
  return p;
}

constexpr PropKind kTextiles[] = {
    {"rug", rug, "woven rug with a pattern"},
    {"curtain", curtain, "pair of curtains on a rod, drawn aside"},
    {"floor_cushion", floor_cushion, "square cushion to sit on the floor"},
};

}  // namespace

PropFamily textiles() { return kTextiles; }

}  // namespace gloam
