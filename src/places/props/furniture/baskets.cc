// Baskets and boxes.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// A basket woven of round strands: hoops in front of and behind upright stakes in turn.
Solid wicker(float r_low, float r_high, float height, float strand, float squareness) {
  const int rows = std::max(6, int(height / (1.75f * strand))),
            stakes = 2 * std::max(8, int(2 * kPi * r_high / 0.05f) / 2) + 1;
  const auto around = [&](float r, float a) {  // a circle, or a square with round corners
    const float c = std::cos(a), s = std::sin(a), n = 2 + 4 * squareness;
    const float q = std::pow(std::pow(std::fabs(c), n) + std::pow(std::fabs(s), n), -1 / n);
    return Vec2f{r * q * c, r * q * s};
  };
  Solid out;
  for (int k = 0; k < rows; ++k) {
    const float t = (float(k) + 0.5f) / float(rows), z = height * t,
                r = r_low + (r_high - r_low) * std::pow(t, 0.8f);
    Path hoop;
    const int points = 2 * stakes;
    for (int i = 0; i <= points; ++i) {
      const float a = 2 * kPi * float(i) / float(points),
                  wave = 0.55f * strand * std::sin(0.5f * float(stakes) * a + kPi * float(k));
      const Vec2f at = around(r + wave, a);
      hoop.push_back({at.x, at.y, z});
    }
    out += tube(hoop, 0.52f * strand * 0.98f, 5);
  }
  for (int i = 0; i < stakes; ++i) {
    const float a = 2 * kPi * float(i) / float(stakes);
    Path stake;
    for (int k = 0; k <= 4; ++k) {
      const float t = float(k) / 4;
      const Vec2f at = around(r_low + (r_high - r_low) * std::pow(t, 0.8f), a);
      stake.push_back({at.x, at.y, 0.5f * strand + (height - 0.5f * strand) * t});
    }
    out += tube(stake, 0.40f * strand, 5);
  }
  for (int k = 0; k < 2; ++k) {  // the rim, twisted of two
    Path rim;
    for (int i = 0; i <= 120; ++i) {
      const float a = 2 * kPi * float(i) / 120, twist = 30 * a + kPi * float(k);
      const Vec2f at = around(r_high + 0.6f * strand * std::cos(twist), a);
      rim.push_back({at.x, at.y, height + 0.6f * strand * std::sin(twist)});
    }
    out += tube(rim, 0.55f * strand, 5);
  }
  return out;
}

Prop basket(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size =
      limited(shop.size({float(dice.uniform(0.30, 0.40)), 0, float(dice.uniform(0.20, 0.30))}),
              {0.18f, 0, 0.12f}, {0.6f, 10, 0.5f});
  const float r = size.x / 2, h = size.z - 0.006f, low = 0.82f * r;
  Prop p;
  PropPart& b = p.body();
  const std::string willow = shop.wood("pine", Axis::kZ);
  b.show("weave", willow,
         wicker(low - 0.005f, r - 0.008f, h - 0.004f, 0.008f, dice.chance(0.4) ? 0.8f : 0.0f));
  b.show("bottom", willow, cylinder(low - 0.012f, 0, 0.008f, 0.002f, 32));
  for (const float s : {-1.0f, 1.0f})
    b.show("handles", willow,
           tube(smooth_path({{-0.06f, s * (r - 0.008f), h - 0.01f},
                             {-0.045f, s * (r + 0.004f), h + 0.035f},
                             {0.045f, s * (r + 0.004f), h + 0.035f},
                             {0.06f, s * (r - 0.008f), h - 0.01f}}),
                0.006f, 8));
  // A blanket inside, clear of the floor however it is folded.
  const uint64_t folds = dice.seed();
  const Vec3 wool = dice.pick<Vec3>({{0.80, 0.76, 0.68}, shop.style.accent, {0.62, 0.36, 0.28}});
  b.show("blanket", shop.fabric(shop.color(wool), 0.0025),
         cushion({1.35f * low, 1.35f * low, 0.55f * h}, 0.35f, 0.03f, folds, 0.6f, 0.006f)
             .moved(0, 0, 0.62f * h));
  b.collide_cylinder(low, 0, 0.35f * h);
  b.collide_cylinder(0.93f * r, 0.35f * h, 0.92f * h);
  b.mass = 1.1 + 20.0 * double(r * r * h) * M_PI;
  p.loose = true;
  return p;
}

Prop laundry_basket(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size = limited(shop.size({0.40f, 0.40f, float(dice.uniform(0.50, 0.62))}),
                             {0.28f, 0, 0.35f}, {0.55f, 10, 0.8f});
  const float r = size.x / 2, h = size.z, low = 0.84f * r;
  Prop p;
  PropPart& b = p.body();
  if (dice.chance(0.5)) {
    b.show("weave", shop.wood("pine", Axis::kZ),
           wicker(low - 0.006f, r - 0.010f, h - 0.01f, 0.013f, 0.0f));
    b.show("bottom", shop.wood("pine", Axis::kX), cylinder(low - 0.014f, 0, 0.010f, 0.002f, 32));
    b.show("lining", shop.fabric({0.80, 0.78, 0.73}, 0.0014),
           sharp_lathe({{low - 0.022f, 0.02f}, {r - 0.025f, h - 0.02f}}, 36) +
               sharp_lathe({{r - 0.027f, h - 0.02f}, {low - 0.024f, 0.02f}}, 36));
  } else {
    // Moulded plastic with slots: rings and staves about an open body.
    const std::string plastic = shop.plastic(
        shop.color(dice.pick<Vec3>({{0.82, 0.82, 0.80}, {0.42, 0.52, 0.56}, {0.30, 0.31, 0.33}})),
        0.45);
    const auto radius = [&](float z) { return low + (r - 0.006f - low) * z / h; };
    const auto ring = [&](float z0, float z1) {
      return sharp_lathe({{radius(z0) - 0.003f, z0},
                          {radius(z0), z0},
                          {radius(z1), z1},
                          {radius(z1) - 0.003f, z1},
                          {radius(z0) - 0.003f, z0}},
                         48);
    };
    b.show("body", plastic,
           ring(0, 0.06f) + ring(0.47f * h, 0.53f * h) + ring(0.85f * h, h - 0.004f) +
               cylinder(low - 0.001f, 0, 0.004f, 0.001f, 48));
    b.show("body", plastic,
           lathe(rounded({{r - 0.009f, h - 0.012f}, {r, h - 0.012f}, {r, h}, {r - 0.010f, h}},
                         0.003f, 2),
                 48));
    for (int k = 0; k < 30; ++k) {
      const float a = 2 * kPi * float(k) / 30, c = std::cos(a), s = std::sin(a);
      for (const auto& [z0, z1] : {std::pair{0.055f, 0.475f * h}, std::pair{0.525f * h, 0.86f * h}})
        b.show(
            "body", plastic,
            bar({(radius(z0) - 0.002f) * c, (radius(z0) - 0.002f) * s, z0},
                {(radius(z1) - 0.002f) * c, (radius(z1) - 0.002f) * s, z1}, 0.0075f, 0.0075f, 6));
    }
  }
  const Vec3 tints[] = {{0.80, 0.79, 0.77}, {0.22, 0.28, 0.40}, {0.55, 0.22, 0.20}};
  for (int k = 0; k < 3; ++k)
    b.show(k == 0   ? "towel"
           : k == 1 ? "shirt"
                    : "sock",
           shop.fabric(tints[k], 0.0016),
           cushion({1.25f * low, (k == 2 ? 0.8f : 1.2f) * low, 0.26f * h}, 0.4f, 0.03f, dice.seed(),
                   0.55f, 0.02f)
               .turned(Axis::kZ, 50.0f * float(k) + float(dice.uniform(0, 40)))
               .turned(Axis::kX, float(dice.uniform(-9, 9)))
               .moved(0.05f * float(k - 1), 0.04f * float(1 - k), (0.38f + 0.16f * float(k)) * h));
  b.collide_cylinder(low, 0, 0.3f * h);
  b.collide_cylinder((low + r) / 2, 0.3f * h, 0.7f * h);
  b.collide_cylinder(0.985f * r, 0.7f * h, h);
  b.mass = 3.2;
  p.loose = true;
  return p;
}

Prop cardboard_box(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size =
      limited(shop.size({float(dice.uniform(0.28, 0.42)), float(dice.uniform(0.32, 0.55)),
                         float(dice.uniform(0.22, 0.38))}),
              {0.1f, 0.1f, 0.06f}, {0.9f, 1.2f, 1.0f});
  const float w = size.x / 2, d = size.y / 2, h = size.z, t = 0.004f;
  const bool open = dice.chance(0.45);
  const std::string board = shop.cardboard(), tape = shop.plastic({0.60, 0.45, 0.26}, 0.25);
  Prop p;
  PropPart& b = p.body();
  for (const float s : {-1.0f, 1.0f}) {
    b.show("board", board,
           slab({-w, s * (d - t / 2) - t / 2, 0}, {w, s * (d - t / 2) + t / 2, h}, 0.0012f));
    b.show(
        "board", board,
        slab({s * (w - t / 2) - t / 2, -d + t, 0}, {s * (w - t / 2) + t / 2, d - t, h}, 0.0012f));
  }
  b.show("board", board, slab({-w + t, -d + t, 0.0005f}, {w - t, d - t, t}, 0));
  if (open) {
    for (const float s : {-1.0f, 1.0f}) {
      const float flap = min(0.9f * w, 0.16f);
      const Solid side = slab({-w + 0.002f, 0, -t / 2}, {w - 0.002f, flap, t / 2}, 0.0012f)
                             .turned(Axis::kX, -float(dice.uniform(20, 62)));
      b.show("board", board,
             (s > 0 ? side : side.turned(Axis::kZ, 180)).moved(0, s * d, h - t / 2));
      const Solid end = slab({0, -d + 0.004f, -t / 2}, {flap, d - 0.004f, t / 2}, 0.0012f)
                            .turned(Axis::kY, float(dice.uniform(20, 66)));
      b.show("board", board, (s > 0 ? end : end.turned(Axis::kZ, 180)).moved(s * w, 0, h - t / 2));
    }
    b.collide_box({-w, -d, 0}, {w, d, t});
    for (const float s : {-1.0f, 1.0f}) {
      b.collide_box({-w, s * (d - t / 2) - t / 2, t}, {w, s * (d - t / 2) + t / 2, h});
      b.collide_box({s * (w - t / 2) - t / 2, -d + t, t}, {s * (w - t / 2) + t / 2, d - t, h});
    }
    b.mass = 0.9 * double(w * d / 0.035f);
  } else {
    // Both flaps meet in the middle under a strip of tape.
    for (const float s : {-1.0f, 1.0f})
      b.show("board", board,
             slab({min(0.001f * s, s * w), -d, h - t}, {max(0.001f * s, s * w), d, h}, 0.0012f));
    b.show("tape", tape, slab({-0.025f, -d, h - 0.0002f}, {0.025f, d, h + 0.0004f}, 0));
    for (const float s : {-1.0f, 1.0f})
      b.show("tape", tape,
             slab({-0.025f, s * (d + 0.0001f) - 0.0003f, h - 0.07f},
                  {0.025f, s * (d + 0.0001f) + 0.0003f, h + 0.0004f}, 0));
    b.collide_box({-w, -d, 0}, {w, d, h});
    b.mass = 1.2 + 90.0 * double(size.x * size.y * size.z);
    p.surfaces.push_back({{-w + 0.02f, -d + 0.02f}, {w - 0.02f, d - 0.02f}, h});
  }
  // A label on one side, and marks for "this way up" on another.
  b.show(
      "label", shop.paper({0.86, 0.86, 0.84}),
      slab({w - 0.0001f, -0.62f * d, 0.52f * h},
           {w + 0.0005f, -0.62f * d + min(0.14f, 0.8f * d), 0.52f * h + min(0.10f, 0.4f * h)}, 0));
  for (int k = 0; k < 9; ++k) {
    const float y = -0.62f * d + min(0.14f, 0.8f * d) * (0.10f + 0.09f * float(k));
    b.show(
        "print", shop.plastic({0.125, 0.125, 0.125}, 0.7),
        slab({w, y, 0.54f * h},
             {w + 0.0007f, y + (k % 3 == 0 ? 0.006f : 0.003f), 0.54f * h + min(0.03f, 0.12f * h)},
             0));
  }
  for (const float y : {0.18f * d, 0.48f * d})
    b.show("print", shop.plastic({0.125, 0.125, 0.125}, 0.7),
           extrude({{-0.004f, 0},
                    {0.004f, 0},
                    {0.004f, 0.03f},
                    {0.014f, 0.03f},
                    {0, 0.05f},
                    {-0.014f, 0.03f},
                    {-0.004f, 0.03f}},
                   0, 0.0006f)
               .turned(Axis::kX, 90)
               .turned(Axis::kZ, 90)
               .moved(w, y, 0.62f * h));
  p.loose = true;
  return p;
}

constexpr PropKind kBaskets[] = {
    {"basket", basket, "wicker basket with handles and a blanket"},
    {"laundry_basket", laundry_basket, "tall basket of wicker or plastic with clothes"},
    {"cardboard_box", cardboard_box, "cardboard box, open or taped"},
};

}  // namespace

PropFamily baskets() { return kBaskets; }

}  // namespace gloam
