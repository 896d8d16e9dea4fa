// Pans, boards and racks.

#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Prop pan(Workshop& shop) {
  const float r = float(shop.dice.uniform(0.10, 0.14)), h = 0.045f;
  const std::string iron = shop.paint(shop.color({0.05, 0.05, 0.052}), 0.45);
  Prop p;
  PropPart& b = p.body();
  b.show("pan", iron,
         lathe(rounded({{0, 0},
                        {r * 0.76f, 0},
                        {r, h},
                        {r - 0.003f, h + 0.001f},
                        {r * 0.75f, 0.004f},
                        {0, 0.004f}},
                       0.010f, 3),
               44));
  const Path grip = smooth_path({{-r + 0.008f, 0, h - 0.012f},
                                 {-r - 0.03f, 0, h + 0.004f},
                                 {-r - 0.10f, 0, h + 0.022f},
                                 {-r - 0.18f, 0, h + 0.026f}},
                                5);
  b.show("stem", shop.metal("steel"),
         tube(Path(grip.begin(), grip.begin() + 7), 0.006f, 10).scaled({1, 1.7f, 1}));
  b.show("handle", shop.plastic({0.04, 0.04, 0.042}, 0.5),
         tube(Path(grip.begin() + 5, grip.end()), 0.0095f, 12).scaled({1, 1.35f, 1}));
  for (const float y : {-0.012f, 0.012f})
    b.show("rivets", shop.metal("steel"), ball(0.004f, 10).moved(-r + 0.010f, y, h - 0.012f));
  b.collide_cylinder(r * 0.78f, 0, 0.005f);
  constexpr int kSides = 8;  // sides of the rim
  for (int i = 0; i < kSides; ++i) {
    const float angle = 2 * kPi * float(i) / kSides, at = r * 0.90f;
    b.collide_box({at * std::cos(angle), at * std::sin(angle), h / 2 + 0.002f},
                  {0.004f, at * std::tan(kPi / kSides), h / 2 - 0.002f}, turn({0, 0, 1}, angle));
  }
  b.collide_capsule({-r - 0.01f, 0, h}, {-r - 0.17f, 0, h + 0.025f}, 0.011f);
  b.mass = 40.0 * r * r + 0.5;
  p.loose = true;
  return p;
}

Prop pot(Workshop& shop) {
  const Vec3f size = shop.size({0.22f, 0.22f, float(shop.dice.uniform(0.12, 0.2))});
  const float r = max(0.07f, min(0.18f, size.y / 2)), h = max(0.08f, min(0.30f, size.z));
  const Vec3 red{0.45, 0.07, 0.05};
  const bool enamelled = shop.dice.chance(0.4) || !(shop.color(red) == red);
  const std::string painted = shop.paint(shop.color(red), 0.15), steel = shop.metal("steel");
  Prop p;
  PropPart& b = p.body();
  b.show("pot", enamelled ? painted : steel,
         lathe(rounded({{0, 0},
                        {r - 0.004f, 0},
                        {r, 0.012f},
                        {r, h},
                        {r + 0.004f, h + 0.002f},
                        {r - 0.002f, h + 0.002f},
                        {r - 0.003f, h - 0.01f}},
                       0.004f),
               44));
  const float lid = h + 0.003f;
  b.show("lid", enamelled ? painted : steel,
         lathe(rounded({{r + 0.002f, lid},
                        {r + 0.002f, lid + 0.003f},
                        {r * 0.85f, lid + 0.012f},
                        {r * 0.4f, lid + 0.022f},
                        {0, lid + 0.025f}},
                       0.01f, 3),
               44));
  const std::string grip = enamelled ? shop.metal("steel") : shop.plastic({0.04, 0.04, 0.042}, 0.4);
  b.show("knob", grip,
         lathe(rounded({{0.007f, lid + 0.022f},
                        {0.007f, lid + 0.034f},
                        {0.018f, lid + 0.040f},
                        {0.016f, lid + 0.050f},
                        {0, lid + 0.052f}},
                       0.004f),
               20));
  for (const float side : {-1.0f, 1.0f}) {
    b.show("handles", grip,
           tube(smooth_path({{-0.042f, side * (r - 0.002f), h * 0.8f},
                             {-0.038f, side * (r + 0.026f), h * 0.8f + 0.005f},
                             {0, side * (r + 0.036f), h * 0.8f + 0.006f},
                             {0.038f, side * (r + 0.026f), h * 0.8f + 0.005f},
                             {0.042f, side * (r - 0.002f), h * 0.8f}},
                            5),
                0.0055f, 10));
    b.collide_capsule({-0.03f, side * (r + 0.028f), h * 0.8f + 0.005f},
                      {0.03f, side * (r + 0.028f), h * 0.8f + 0.005f}, 0.007f);
  }
  b.collide_cylinder(r, 0, lid + 0.006f);
  b.collide_cylinder(0.018f, lid + 0.006f, lid + 0.052f);
  b.mass = 8000.0 * 0.0025 * (2 * kPi * r * h + 2 * kPi * r * r);  // steel, 2.5 mm on average
  p.loose = true;
  return p;
}

Prop knife_block(Workshop& shop) {
  const std::string wood = shop.wood(Axis::kZ), dark = shop.plastic({0.04, 0.04, 0.042}, 0.4),
                    steel = shop.metal("steel");
  Prop p;
  PropPart& b = p.body();
  // Side view; leans back, so that the handles point up and to the front.
  const Profile outline{{-0.08f, 0},      {0.07f, 0},        {0.075f, 0.005f}, {0.095f, 0.115f},
                        {0.005f, 0.220f}, {-0.010f, 0.222f}, {-0.078f, 0.03f}};
  b.show("block", wood, extrude(outline, -0.05f, 0.05f).turned(Axis::kX, 90));
  const Vec2f along{0.65f, 0.76f};  // into the knives' direction
  for (int i = 0; i < 6; ++i) {
    const int row = i / 2;
    const float u = 0.2f + 0.28f * float(row), y = i % 2 ? 0.024f : -0.024f,
                l = 0.115f - 0.012f * float(row);
    const Vec2f slot{0.005f + 0.090f * u, 0.220f - 0.105f * u};
    const float w = 0.009f;
    const Solid grip = slab({-w, -0.0085f, 0.012f}, {w * 1.3f, 0.0085f, l}, 0.006f, 2);
    const auto place = [&](const Solid& s) {
      return s.turned(Axis::kY, std::atan2(along.x, along.y) * 180 / kPi).moved(slot.x, y, slot.y);
    };
    b.show("bolsters", steel, place(slab({-w, -0.0065f, -0.012f}, {w, 0.0065f, 0.014f}, 0.003f)));
    b.show("grips", dark, place(grip));
    for (const float at : {0.03f, 0.055f, 0.08f})
      b.show("bolsters", steel,
             place(bar({0.001f, -0.0088f, at}, {0.001f, 0.0088f, at}, 0.0025f, 0.0025f, 8)));
  }
  b.collide_box({-0.078f, -0.05f, 0}, {0.08f, 0.05f, 0.06f});
  b.collide_box({-0.055f, -0.05f, 0.06f}, {0.088f, 0.05f, 0.12f});
  b.collide_box({-0.035f, -0.05f, 0.12f}, {0.07f, 0.05f, 0.17f});
  b.collide_box({-0.015f, -0.05f, 0.17f}, {0.03f, 0.05f, 0.22f});
  b.collide_box({0.075f, 0, 0.215f}, {0.033f, 0.04f, 0.055f},
                turn({0, 1, 0}, std::atan2(along.x, along.y)));
  b.mass = 2.4;
  p.loose = true;
  return p;
}

Prop cutting_board(Workshop& shop) {
  const Vec3f size = shop.size({0.25f, 0.38f, 0.022f});
  const float x = max(0.08f, min(0.3f, size.x / 2)), y = max(0.1f, min(0.4f, size.y / 2)),
              z = max(0.01f, min(0.05f, size.z));
  const std::string wood = shop.dice.pick<std::string>({"birch", "oak", "walnut"});
  Prop p;
  PropPart& b = p.body();
  const Vec2f low{-x, -y}, high{x, y}, hole{0.030f, 0.011f};
  const Vec2f c{0, y - 0.035f};
  const auto outer = [&](float in, float at) {
    return ring(low + Vec2f{in, in}, high - Vec2f{in, in}, 0.02f - in, at);
  };
  const auto inner = [&](float out, float at) {
    return ring(c - hole - Vec2f{out, out}, c + hole + Vec2f{out, out}, 0.0105f + out, at);
  };
  b.show("board", shop.wood(wood, Axis::kY),
         loft({inner(0.002f, 0), outer(0.003f, 0), outer(0.003f, 0), outer(0, 0.003f),
               outer(0, 0.003f), outer(0, z - 0.003f), outer(0, z - 0.003f), outer(0.003f, z),
               outer(0.003f, z), inner(0.002f, z), inner(0.002f, z), inner(0, z - 0.002f),
               inner(0, 0.002f), inner(0.002f, 0)}));
  b.collide_box({-x, -y, 0}, {x, y, z});
  b.mass = 680.0 * 4 * x * y * z;
  p.loose = true;
  return p;
}

Prop dish_rack(Workshop& shop) {
  const std::string wire = shop.metal("chrome");
  const std::string china = shop.ceramic(shop.color({0.88, 0.87, 0.84}));
  const float x = 0.16f, y = 0.22f;
  Prop p;
  PropPart& b = p.body();
  b.show("tray", shop.plastic({0.16, 0.17, 0.18}, 0.4),
         loft({point_of(ring({0, 0}, {1, 1}, 0.1f, 0), {0, 0, 0}), ring({-x, -y}, {x, y}, 0.02f, 0),
               ring({-x - 0.01f, -y - 0.01f}, {x + 0.01f, y + 0.01f}, 0.03f, 0.018f),
               ring({-x - 0.007f, -y - 0.007f}, {x + 0.007f, y + 0.007f}, 0.03f, 0.018f),
               ring({-x + 0.004f, -y + 0.004f}, {x - 0.004f, y - 0.004f}, 0.02f, 0.005f),
               point_of(ring({0, 0}, {1, 1}, 0.1f, 0), {0, 0, 0.004f})}));
  for (const float z : {0.035f, 0.125f}) {
    Path loop = ring({-x, -y}, {x, y}, 0.03f, z);
    loop.push_back(loop.front());
    b.show("rack", wire, tube(loop, 0.003f, 8));
  }
  for (int i = 0; i <= 16; ++i) {
    const float at = -y + 0.03f + (2 * y - 0.06f) * float(i) / 16;
    b.show(
        "rack", wire,
        tube({{-x, at, 0.125f}, {-x, at, 0.035f}, {x, at, 0.035f}, {x, at, 0.125f}}, 0.0018f, 6));
  }
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f}) {
      b.show("rack", wire,
             bar({sx * (x - 0.02f), sy * (y - 0.04f), 0.004f},
                 {sx * (x - 0.02f), sy * (y - 0.04f), 0.036f}, 0.003f, 0.003f, 8));
    }
  const int plates = shop.dice.integer(3, 6);
  for (int i = 0; i < plates; ++i)
    b.show("plates", china,
           lathe({{0, 0},
                  {0.055f, 0},
                  {0.07f, 0.002f},
                  {0.12f, 0.018f},
                  {0.1215f, 0.0195f},
                  {0.12f, 0.021f},
                  {0.07f, 0.006f},
                  {0.055f, 0.004f},
                  {0, 0.004f}},
                 30)
               .turned(Axis::kX, 78)
               .moved(-0.02f, -0.16f + 0.0388f * float(i), 0.150f));
  for (int i = 0; i < 2; ++i)
    b.show("cups", shop.ceramic(shop.style.accent),
           lathe(rounded({{0.0365f, 0}, {0.040f, 0}, {0.034f, 0.088f}, {0, 0.088f}}, 0.006f, 3), 28)
                   .moved(0.06f - 0.10f * float(i), 0.165f, 0.040f) +
               tube(smooth_path({{0.096f - 0.10f * float(i), 0.165f, 0.115f},
                                 {0.118f - 0.10f * float(i), 0.165f, 0.11f},
                                 {0.12f - 0.10f * float(i), 0.165f, 0.08f},
                                 {0.0975f - 0.10f * float(i), 0.165f, 0.065f}},
                                4),
                    0.004f, 8));
  b.collide_box({-x - 0.008f, -y - 0.008f, 0}, {x + 0.008f, y + 0.008f, 0.125f});
  b.collide_box({-0.12f, -0.17f, 0.125f}, {0.09f, -0.13f + 0.0388f * float(plates - 1), 0.26f});
  b.mass = 1.3 + 0.45 * plates + 0.6;
  p.loose = true;
  return p;
}

constexpr PropKind kKitchenware[] = {
    {"pan", pan, "frying pan"},
    {"pot", pot, "cooking pot with lid"},
    {"knife_block", knife_block, "wooden block with six knives"},
    {"cutting_board", cutting_board, "wooden board with a grip"},
    {"dish_rack", dish_rack, "draining rack with plates and cups"},
};

}  // namespace

PropFamily kitchenware() { return kKitchenware; }

}  // namespace gloam
