// Small machines that stand on worktops.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

std::string black(Workshop& shop) { return shop.plastic({0.045, 0.045, 0.048}, 0.35); }

// Painted in the colour that is asked for, else one of what is sold.
std::string body_of(Workshop& shop, std::initializer_list<Vec3> colors) {
  const Vec3 usual = shop.dice.pick(colors);
  const bool bare = shop.dice.chance(0.4) && shop.color(usual) == usual;
  return bare ? shop.metal("steel") : shop.paint(shop.color(usual), 0.25);
}

const std::initializer_list<Vec3> kSober = {{0.88, 0.87, 0.85}, {0.09, 0.09, 0.095}};
const std::initializer_list<Vec3> kCheerful = {
    {0.88, 0.87, 0.84}, {0.09, 0.09, 0.095}, {0.44, 0.12, 0.10}, {0.58, 0.66, 0.63}};

Prop kettle(Workshop& shop) {
  const std::string body = body_of(shop, kCheerful), dark = black(shop);
  Prop p;
  PropPart& b = p.body();
  b.show("base", dark, cylinder(0.082f, 0, 0.022f, 0.006f, 36));
  b.show("jug", body,
         lathe(rounded({{0, 0.024f},
                        {0.078f, 0.024f},
                        {0.079f, 0.05f},
                        {0.062f, 0.205f},
                        {0.055f, 0.212f},
                        {0, 0.212f}},
                       0.008f),
               40));
  b.show("lid", dark,
         lathe(rounded({{0.052f, 0.210f}, {0.050f, 0.220f}, {0, 0.226f}}, 0.006f), 32));
  b.show("lid", dark, ball(0.010f, 14).moved(0, 0, 0.232f));
  // Spout: a lip that widens upwards, at +x.
  b.show("jug", body,
         loft({ring({0.055f, -0.012f}, {0.068f, 0.012f}, 0.005f, 0.165f),
               ring({0.045f, -0.020f}, {0.086f, 0.020f}, 0.010f, 0.212f),
               ring({0.045f, -0.020f}, {0.086f, 0.020f}, 0.010f, 0.212f),
               ring({0.047f, -0.017f}, {0.082f, 0.017f}, 0.008f, 0.212f),
               ring({0.052f, -0.010f}, {0.066f, 0.010f}, 0.004f, 0.175f)}));
  const Path grip = smooth_path({{-0.058f, 0, 0.207f},
                                 {-0.100f, 0, 0.208f},
                                 {-0.125f, 0, 0.180f},
                                 {-0.122f, 0, 0.110f},
                                 {-0.105f, 0, 0.065f},
                                 {-0.074f, 0, 0.060f}},
                                5);
  b.show("handle", dark, tube(grip, 0.0105f, 12).scaled({1, 1.25f, 1}));
  b.show("window", shop.plastic({0.20, 0.28, 0.33}, 0.08),
         slab({-0.0768f, -0.009f, 0.075f}, {-0.069f, 0.009f, 0.165f}, 0.004f)
             .turned(Axis::kY, 6.2f)
             .moved(-0.0085f, 0, -0.009f));
  b.show("switch", shop.plastic({0.55, 0.10, 0.08}),
         slab({-0.140f, -0.010f, 0.060f}, {-0.112f, 0.010f, 0.068f}, 0.003f)
             .moved(0.020f, 0, -0.010f));
  b.collide_cylinder(0.082f, 0, 0.022f);
  b.collide_cylinder(0.076f, 0.022f, 0.10f);
  b.collide_cylinder(0.068f, 0.10f, 0.225f);
  b.collide_capsule({-0.115f, 0, 0.085f}, {-0.118f, 0, 0.18f}, 0.012f);
  b.mass = 1.1;
  p.loose = true;
  return p;
}

Prop toaster(Workshop& shop) {
  const std::string body = body_of(shop, kCheerful), dark = black(shop),
                    steel = shop.metal("steel");
  const float x = 0.085f, y = 0.145f, z = 0.19f;  // the lever is at +y, the buttons at +x
  Prop p;
  PropPart& b = p.body();
  b.show("foot", dark,
         loft({ring({-x + 0.006f, -y + 0.006f}, {x - 0.006f, y - 0.006f}, 0.03f, 0),
               ring({-x, -y}, {x, y}, 0.035f, 0.006f), ring({-x, -y}, {x, y}, 0.035f, 0.02f),
               ring({-x + 0.01f, -y + 0.01f}, {x - 0.01f, y - 0.01f}, 0.03f, 0.022f)}));
  std::vector<Path> shell{ring({-x, -y}, {x, y}, 0.036f, 0.022f, 6)};
  for (int i = 0; i <= 5; ++i) {
    const float angle = kPi / 2 * float(i) / 5, r = 0.028f, in = r * (1 - std::cos(angle));
    shell.push_back(
        ring({-x + in, -y + in}, {x - in, y - in}, 0.036f - in, z - r + r * std::sin(angle), 6));
  }
  b.show("shell", body, loft(shell));
  const Vec2f top{x - 0.028f, y - 0.028f};
  for (const float side : {-1.0f, 1.0f}) {
    // Half of the top with a slot in it.
    const Vec2f low{side > 0 ? 0 : -top.x, -top.y}, high{side > 0 ? top.x : 0, top.y};
    const float c = side * 0.029f, w = 0.016f, l = 0.105f;
    const Path rim = ring({c - w - 0.004f, -l - 0.004f}, {c + w + 0.004f, l + 0.004f}, 0.006f, z);
    b.show("shell", body, loft({ring(low, high, 0.008f, z), rim}));
    b.show(
        "rims", steel,
        loft({ring({c - w - 0.005f, -l - 0.005f}, {c + w + 0.005f, l + 0.005f}, 0.006f, z),
              ring({c - w - 0.003f, -l - 0.003f}, {c + w + 0.003f, l + 0.003f}, 0.005f, z + 0.003f),
              ring({c - w, -l}, {c + w, l}, 0.004f, z + 0.001f)}));
    const Path floor = ring({c - w, -l}, {c + w, l}, 0.004f, z - 0.10f);
    b.show("slots", shop.paint({0.06, 0.055, 0.05}, 0.5),
           loft({ring({c - w, -l}, {c + w, l}, 0.004f, z + 0.001f), floor, floor,
                 point_of(floor, {c, 0, z - 0.10f})}));
    for (const float wall : {-0.011f, 0.011f})
      for (int i = -4; i <= 4; ++i)
        b.show("wires", steel,
               bar({c + wall, 0.022f * float(i), z - 0.09f},
                   {c + wall, 0.022f * float(i), z - 0.008f}, 0.001f, 0.001f, 5));
    // Cover of the gap that the round corners of the two halves leave in the top.
  }
  b.show("shell", body, slab({-0.012f, -top.y, z - 0.003f}, {0.012f, top.y, z - 0.0003f}, 0));
  b.show("track", dark, slab({-0.004f, y - 0.004f, 0.05f}, {0.004f, y + 0.0006f, 0.155f}, 0));
  b.show("lever", dark,
         slab({-0.022f, y + 0.004f, 0.135f}, {0.022f, y + 0.024f, 0.148f}, 0.005f, 2));
  b.show("lever", dark, slab({-0.003f, y - 0.002f, 0.139f}, {0.003f, y + 0.008f, 0.144f}, 0));
  b.show("dial", steel, knob(0.016f, 0.012f, {x, 0.075f, 0.06f}));
  for (int i = 0; i < 3; ++i)
    b.show("buttons", steel, knob(0.007f, 0.004f, {x, -0.09f + 0.03f * float(i), 0.06f}));
  b.collide_box({-x, -y, 0}, {x, y, z});
  b.collide_box({-0.022f, y + 0.001f, 0.133f}, {0.022f, y + 0.024f, 0.15f});
  b.mass = 1.6;
  p.loose = true;
  return p;
}

Prop microwave(Workshop& shop) {
  const std::string shell = body_of(shop, kSober), dark = black(shop), steel = shop.metal("steel");
  const Vec3f size = shop.size({0.36f, 0.48f, 0.28f});
  const float x = std::clamp(size.x, 0.30f, 0.50f) / 2, y = std::clamp(size.y, 0.42f, 0.62f) / 2,
              z = std::clamp(size.z, 0.24f, 0.40f);
  const float body = x - 0.034f, wide = 2 * y - 0.11f;  // size of the door, at -y
  const float split = -y + wide;
  Prop p;
  PropPart& b = p.body();
  const auto block = [&](Vec3f low, Vec3f high) {
    b.show("case", shell, slab(low, high, 0.002f));
    b.collide_box(low, high);
  };
  block({-x, -y, 0.012f}, {body, -y + 0.03f, z});
  block({-x, split - 0.02f, 0.012f}, {body, y, z});
  block({-x, -y + 0.03f, 0.012f}, {body, split - 0.02f, 0.04f});
  block({-x, -y + 0.03f, z - 0.035f}, {body, split - 0.02f, z});
  block({-x, -y + 0.03f, 0.04f}, {-x + 0.02f, split - 0.02f, z - 0.035f});
  const std::string liner = shop.paint({0.80, 0.80, 0.79}, 0.35);
  b.show("liner", liner,
         slab({-x + 0.02f, -y + 0.03f, 0.04f}, {-x + 0.022f, split - 0.02f, z - 0.035f}, 0));
  b.show("liner", liner,
         slab({-x + 0.02f, -y + 0.03f, 0.04f}, {body + 0.001f, -y + 0.032f, z - 0.035f}, 0));
  b.show("liner", liner,
         slab({-x + 0.02f, split - 0.022f, 0.04f}, {body + 0.001f, split - 0.02f, z - 0.035f}, 0));
  b.show("liner", liner,
         slab({-x + 0.02f, -y + 0.03f, 0.04f}, {body + 0.001f, split - 0.02f, 0.042f}, 0));
  b.show("turntable", shop.glass(),
         cylinder(min(0.135f, wide / 2 - 0.04f), 0.052f, 0.058f, 0.002f, 40)
             .moved(-0.01f, (-y + split) / 2, 0));
  b.show("panel", dark, slab({body, split + 0.002f, 0.014f}, {x, y, z - 0.001f}, 0.003f));
  b.collide_box({body, split + 0.002f, 0.012f}, {x, y, z});
  const float yp = (split + y) / 2;
  b.show("display", shop.glow({0.25, 0.85, 0.75}, 40),
         slab({x - 0.001f, yp - 0.034f, z - 0.062f}, {x + 0.0005f, yp + 0.034f, z - 0.038f}, 0));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column) {
      const float ky = yp - 0.034f + 0.025f * float(column), kz = z - 0.10f - 0.020f * float(row);
      b.show("keys", shop.plastic({0.32, 0.32, 0.33}),
             slab({x - 0.001f, ky, kz}, {x + 0.0012f, ky + 0.018f, kz + 0.012f}, 0.0008f));
    }
  b.show("knob", steel, knob(0.022f, 0.016f, {x, yp, 0.06f}));
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f}) {
      b.show("feet", shop.rubber(),
             cylinder(0.014f, 0, 0.014f, 0.002f, 14).moved(sx * (x - 0.03f), sy * (y - 0.03f), 0));
      b.collide_cylinder(0.014f, 0, 0.012f, sx * (x - 0.03f), sy * (y - 0.03f));
    }
  b.mass = 10.5;
  PropPart& door = p.hang("door", {x, -y, 0.014f}, upright_hinge(1, 1.8, 0.1));
  const float tall = z - 0.015f;
  door.show("frame", dark, slab({-0.030f, 0, 0}, {0, wide, tall}, 0.003f));
  door.show("window", shop.plastic({0.015, 0.015, 0.016}, 0.05),
            slab({-0.002f, 0.035f, 0.035f}, {0.0008f, wide - 0.05f, tall - 0.035f}, 0.0005f));
  door.show("handle", steel,
            bar({0.028f, wide - 0.022f, 0.03f}, {0.028f, wide - 0.022f, tall - 0.03f}, 0.007f,
                0.007f, 12));
  for (const float at : {0.045f, tall - 0.045f})
    door.show("handle", steel,
              bar({-0.002f, wide - 0.022f, at}, {0.028f, wide - 0.022f, at}, 0.005f, 0.005f, 8));
  door.collide_box({-0.030f, 0, 0}, {0, wide, tall});
  door.collide_capsule({0.028f, wide - 0.022f, 0.03f}, {0.028f, wide - 0.022f, tall - 0.03f},
                       0.007f);
  door.mass = 1.5;
  p.loose = true;
  p.front = 0.5f;
  return p;
}

Prop coffee_machine(Workshop& shop) {
  const std::string shell = body_of(shop, kSober), dark = black(shop), steel = shop.metal("steel");
  Prop p;
  PropPart& b = p.body();
  b.show("base", shell,
         loft({ring({-0.11f, -0.085f}, {0.12f, 0.085f}, 0.03f, 0),
               ring({-0.115f, -0.09f}, {0.125f, 0.09f}, 0.035f, 0.005f),
               ring({-0.115f, -0.09f}, {0.125f, 0.09f}, 0.035f, 0.032f),
               ring({-0.11f, -0.085f}, {0.12f, 0.085f}, 0.03f, 0.037f),
               point_of(ring({0, 0}, {1, 1}, 0.03f, 0), {0, 0, 0.037f})}));
  b.show("plate", steel, cylinder(0.066f, 0.036f, 0.041f, 0.001f, 36).moved(0.05f, 0, 0));
  b.show("tower", shell, slab({-0.115f, -0.085f, 0.03f}, {-0.035f, 0.085f, 0.335f}, 0.02f, 3));
  b.show("tower", shell, slab({-0.10f, -0.085f, 0.215f}, {0.115f, 0.085f, 0.335f}, 0.02f, 3));
  b.show("lid", dark, slab({-0.105f, -0.078f, 0.333f}, {0.105f, 0.078f, 0.342f}, 0.004f, 2));
  b.show("funnel", dark, cone(0.03f, 0.055f, 0.185f, 0.22f, 0.003f, 28).moved(0.05f, 0, 0));
  b.show("gauge", shop.plastic({0.25, 0.33, 0.38}, 0.08),
         slab({-0.085f, 0.083f, 0.08f}, {-0.065f, 0.0865f, 0.20f}, 0.001f));
  b.show("switch", dark, slab({0.122f, -0.014f, 0.012f}, {0.128f, 0.014f, 0.028f}, 0.002f));
  b.show("switch_lamp", shop.glow({1, 0.25, 0.1}, 150),
         slab({0.127f, -0.004f, 0.018f}, {0.1285f, 0.004f, 0.022f}, 0));
  // Jug of glass, with coffee.
  const float c = 0.05f;
  b.show("jug", shop.glass(),
         lathe(rounded({{0, 0.042f},
                        {0.050f, 0.042f},
                        {0.064f, 0.075f},
                        {0.060f, 0.115f},
                        {0.045f, 0.155f},
                        {0.048f, 0.168f}},
                       0.02f, 4),
               36)
             .moved(c, 0, 0));
  b.show("coffee", shop.plastic({0.06, 0.03, 0.015}, 0.1),
         lathe(rounded({{0, 0.044f},
                        {0.048f, 0.044f},
                        {0.0615f, 0.075f},
                        {0.060f, 0.098f},
                        {0.059f, 0.100f},
                        {0, 0.100f}},
                       0.008f, 4),
               32)
             .moved(c, 0, 0));
  b.show(
      "collar", dark,
      lathe({{0.0455f, 0.150f}, {0.049f, 0.152f}, {0.050f, 0.170f}, {0.046f, 0.176f}, {0, 0.180f}},
            32)
          .moved(c, 0, 0));
  b.show("grip", dark,
         tube(smooth_path({{c + 0.047f, 0, 0.164f},
                           {c + 0.085f, 0, 0.165f},
                           {c + 0.095f, 0, 0.13f},
                           {c + 0.088f, 0, 0.085f}},
                          5),
              0.008f, 10)
             .scaled({1, 1.3f, 1}));
  b.collide_box({-0.115f, -0.09f, 0}, {0.125f, 0.09f, 0.04f});
  b.collide_box({-0.115f, -0.085f, 0.04f}, {-0.03f, 0.085f, 0.34f});
  b.collide_box({-0.03f, -0.085f, 0.21f}, {0.115f, 0.085f, 0.34f});
  b.collide_cylinder(0.062f, 0.042f, 0.18f, c, 0);
  b.mass = 2.6;
  p.loose = true;
  return p;
}

constexpr PropKind kKitchenMachines[] = {
    {"kettle", kettle, "electric kettle"},
    {"toaster", toaster, "toaster with two slots"},
    {"microwave", microwave, "microwave oven with a hinged door"},
    {"coffee_machine", coffee_machine, "filter coffee machine with its jug"},
};

}  // namespace

PropFamily kitchen_machines() { return kKitchenMachines; }

}  // namespace gloam
