// The large machines of a kitchen. Cooker and dishwasher stand in the row of the base units.

#include <algorithm>

#include "places/props/parts/kitchen_unit.h"

namespace gloam {
namespace {

std::string enamel(Workshop& shop) { return shop.paint({0.09, 0.09, 0.10}, 0.25); }
std::string dark_glass(Workshop& shop) { return shop.plastic({0.02, 0.02, 0.022}, 0.04); }

// A leaf that falls open about its lower edge; damped as by springs.
PropJoint flap_hinge(double friction) {
  return {.axis = {0, 1, 0}, .low = 0, .high = 1.5, .damping = 3, .friction = friction};
}

void show_plates(Workshop& shop, PropPart* b, float z) {
  const bool iron = shop.dice.chance(0.4);
  const Vec3f spots[4] = {{-0.13f, -0.14f, 0.072f},
                          {-0.13f, 0.14f, 0.09f},
                          {0.12f, -0.14f, 0.09f},
                          {0.12f, 0.14f, 0.072f}};
  for (const Vec3f spot : spots) {  // z holds the radius
    const float r = spot.z;
    if (iron) {
      b->show("plates", shop.paint({0.07, 0.07, 0.072}, 0.6),
              lathe(rounded({{r, z},
                             {r * 0.97f, z + 0.009f},
                             {r * 0.27f, z + 0.009f},
                             {r * 0.25f, z + 0.007f},
                             {0, z + 0.007f}},
                            0.002f),
                    32)
                  .moved(spot.x, spot.y, 0));
      b->show("rims", shop.metal("steel"),
              cylinder(r + 0.006f, z - 0.001f, z + 0.002f, 0.001f, 32).moved(spot.x, spot.y, 0));
    } else {
      for (const float at : {r, r * 0.6f})
        b->show("zones", shop.paint({0.42, 0.42, 0.43}, 0.3),
                sharp_lathe({{at, z + 0.0003f}, {at - 0.002f, z + 0.0003f}}, 40)
                    .moved(spot.x, spot.y, 0));
    }
  }
}

Prop cooker(Workshop& shop) {
  KitchenUnit u = kitchen_unit(shop, 0.60f);
  u.y = std::clamp(u.y, 0.25f, 0.45f);
  const std::string shell = appliance_casing(shop), black = enamel(shop);
  Prop p;
  PropPart& b = p.body();
  const float face = u.front(), body = face - 0.045f, y = u.y - 0.002f, inner = y - 0.05f;
  const float low = 0.30f, high = u.z - 0.17f;  // ends of the oven
  b.show("feet", shop.paint({0.05, 0.05, 0.05}),
         slab({-u.x + 0.03f, -y + 0.01f, 0}, {face - 0.06f, y - 0.01f, 0.09f}, 0.002f));
  for (const float side : {-1.0f, 1.0f}) {
    const float y0 = side > 0 ? inner : -y, y1 = side > 0 ? y : -inner;
    b.show("case", shell, slab({-u.x, y0, 0.085f}, {body, y1, u.z - 0.03f}, 0.002f));
    b.collide_box({-u.x, y0, low}, {body, y1, high});
  }
  b.show("case", shell, slab({-u.x, -inner, 0.085f}, {body, inner, low}, 0));
  b.show("case", shell, slab({-u.x, -inner, high}, {body, inner, u.z - 0.03f}, 0));
  b.show("case", shell, slab({-u.x, -inner, low}, {-u.x + 0.05f, inner, high}, 0));
  b.show("panel", shell,
         slab({body - 0.01f, -y, u.z - 0.125f}, {face, y, u.z - 0.034f}, 0.004f, 2));
  b.show("panel", shell, slab({body - 0.01f, -y, 0.095f}, {face, y, 0.243f}, 0.004f, 2));
  b.show("grip", shop.paint({0.03, 0.03, 0.03}),
         slab({body, -y * 0.7f, 0.243f}, {face - 0.012f, y * 0.7f, 0.252f}, 0));
  // Oven: enamelled, with a shelf of wire.
  const float back = -u.x + 0.05f, t = 0.002f;
  b.show("oven", black, slab({back, -inner, low}, {body, -inner + t, high}, 0));
  b.show("oven", black, slab({back, inner - t, low}, {body, inner, high}, 0));
  b.show("oven", black, slab({back, -inner, low}, {body, inner, low + t}, 0));
  b.show("oven", black, slab({back, -inner, high - t}, {body, inner, high}, 0));
  b.show("oven", black, slab({back, -inner, low}, {back + t, inner, high}, 0));
  const float shelf = (low + high) / 2 - 0.05f;
  for (int i = 0; i <= 12; ++i) {
    const float at = -inner + 0.02f + (2 * inner - 0.04f) * float(i) / 12;
    b.show("shelf", shop.metal("chrome"),
           bar({back + 0.02f, at, shelf}, {body - 0.03f, at, shelf}, 0.002f, 0.002f, 6));
  }
  for (const float x : {back + 0.02f, body - 0.03f})
    b.show("shelf", shop.metal("chrome"),
           bar({x, -inner + 0.004f, shelf}, {x, inner - 0.004f, shelf}, 0.003f, 0.003f, 8));
  // Hob
  b.show("rim", shop.metal("steel"),
         slab({-u.x, -u.y, u.z - 0.03f}, {u.x, u.y, u.z - 0.002f}, 0.002f));
  b.show("hob", dark_glass(shop),
         slab({-u.x + 0.012f, -u.y + 0.012f, u.z - 0.004f}, {u.x - 0.012f, u.y - 0.012f, u.z},
              0.002f));
  show_plates(shop, &b, u.z);
  const float zk = u.z - 0.08f;
  for (int i = 0; i < 6; ++i) {
    const float at = (float(i < 3 ? i : i + 2) / 7 - 0.5f) * 2 * (y - 0.06f);
    b.show("knobs", shop.metal("steel"), knob(0.019f, 0.022f, {face, at, zk}));
    b.show("dials", black, knob(0.023f, 0.002f, {face - 0.0005f, at, zk}));
  }
  b.show("display", dark_glass(shop),
         slab({face - 0.004f, -0.055f, zk - 0.02f}, {face + 0.0012f, 0.055f, zk + 0.02f}, 0.001f));
  b.collide_box({-u.x + 0.03f, -y + 0.01f, 0}, {face - 0.06f, y - 0.01f, 0.085f});
  b.collide_box({-u.x, -y, 0.085f}, {face, y, 0.25f});
  b.collide_box({-u.x, -inner, 0.25f}, {body, inner, low});
  b.collide_box({-u.x, -u.y, high}, {body, u.y, u.z});
  b.collide_box({body, -u.y, u.z - 0.125f}, {u.x, u.y, u.z});
  b.collide_box({-u.x, -inner, low}, {back, inner, high});
  b.mass = 42;

  const float z0 = 0.256f, tall = u.z - 0.129f - z0;
  PropPart& door = p.hang("door", {face, 0, z0}, flap_hinge(5));
  door.show("frame", shell, slab({-0.042f, -y, 0}, {-0.003f, y, tall}, 0.004f, 2));
  door.show("glass", dark_glass(shop),
            slab({-0.006f, -y + 0.004f, 0.004f}, {0, y - 0.004f, tall - 0.004f}, 0.002f));
  door.show("liner", black, slab({-0.044f, -inner, 0.03f}, {-0.04f, inner, tall - 0.04f}, 0.002f));
  door.show("window", shop.plastic({0.06, 0.06, 0.062}, 0.12),
            slab({-0.003f, -y + 0.09f, 0.07f}, {0.0004f, y - 0.09f, tall - 0.14f}, 0));
  const std::string steel = shop.metal("steel");
  const float zh = tall - 0.055f, yh = y - 0.05f;
  door.show("handle", steel, bar({0.045f, -yh, zh}, {0.045f, yh, zh}, 0.009f, 0.009f, 16));
  for (const float side : {-1.0f, 1.0f})
    door.show("handle", steel,
              slab({0, side * (yh - 0.03f) - 0.008f, zh - 0.007f},
                   {0.046f, side * (yh - 0.03f) + 0.008f, zh + 0.007f}, 0.003f));
  door.collide_box({-0.042f, -y, 0}, {0, y, tall});
  door.collide_capsule({0.045f, -yh, zh}, {0.045f, yh, zh}, 0.009f);
  door.mass = 6;
  p.front = 0.9f;
  return p;
}

Prop dishwasher(Workshop& shop) {
  KitchenUnit u = kitchen_unit(shop, 0.60f);
  u.y = std::clamp(u.y, 0.22f, 0.32f);
  const std::string steel = shop.metal("steel");
  Prop p;
  PropPart& b = p.body();
  add_plinth(shop, &b, u);
  add_worktop(shop, &p, u);
  const float face = u.front(), z0 = kPlinth + 0.003f, z1 = u.top() - 0.003f;
  add_carcass(&b, "tub", steel, {-u.x + 0.02f, -u.y + 0.004f, kPlinth},
              {face - 0.055f, u.y - 0.004f, u.top()}, 0.03f);
  b.mass = 34;
  const float in = u.y - 0.045f;
  for (const float z : {0.19f, 0.50f}) {  // racks of coated wire, with plates in the lower one
    const std::string wire = shop.plastic({0.62, 0.64, 0.66}, 0.4);
    for (const float h : {0.0f, 0.09f}) {
      b.show("racks", wire,
             tube({{-u.x + 0.07f, -in, z + h},
                   {face - 0.07f, -in, z + h},
                   {face - 0.07f, in, z + h},
                   {-u.x + 0.07f, in, z + h},
                   {-u.x + 0.07f, -in, z + h}},
                  0.003f, 6));
    }
    for (int i = 0; i <= 10; ++i) {
      const float y = -in + 2 * in * float(i) / 10;
      b.show("racks", wire,
             tube({{-u.x + 0.07f, y, z + 0.09f},
                   {-u.x + 0.07f, y, z},
                   {face - 0.07f, y, z},
                   {face - 0.07f, y, z + 0.09f}},
                  0.002f, 5));
    }
    if (z > 0.3f) continue;
    for (int i = 0; i < 8; ++i)
      b.show(
          "plates", shop.ceramic({0.90, 0.89, 0.86}),
          lathe(
              {{0, 0}, {0.06f, 0}, {0.12f, 0.018f}, {0.121f, 0.021f}, {0.06f, 0.005f}, {0, 0.005f}},
              28)
              .turned(Axis::kX, 80)
              .moved(-0.02f, -0.16f + 0.032f * float(i), z + 0.13f));
  }
  PropPart& door = p.hang("door", {face, 0, z0}, flap_hinge(5));
  const float y = u.y - kGap, tall = z1 - z0;
  show_front(shop, &door, {-y, 0}, {y, tall});
  door.show(
      "liner", steel,
      slab({-0.052f, -y + 0.012f, 0.004f}, {-kFrontBoard, y - 0.012f, tall - 0.002f}, 0.004f));
  door.show("controls", dark_glass(shop),
            slab({-0.046f, -y + 0.03f, tall - 0.004f},
                 {-kFrontBoard - 0.006f, y - 0.03f, tall - 0.001f}, 0));
  add_handle(shop, &door, {0, 0, tall - 0.05f}, Axis::kY, 0.30f);
  door.collide_box({-0.052f, -y, 0}, {0, y, tall});
  door.mass = 7;
  p.front = 0.9f;
  return p;
}

Prop range_hood(Workshop& shop) {
  const Vec3f size = shop.size({0.48f, 0.60f, 0.80f});
  const float x = std::clamp(size.x, 0.35f, 0.60f), y = std::clamp(size.y, 0.5f, 1.0f) / 2,
              z = std::clamp(size.z, 0.5f, 1.2f) / 2;
  const std::string steel = shop.metal("steel");
  Prop p;
  PropPart& b = p.body();
  const float lip = -z + 0.055f, neck = -z + 0.27f;
  const Vec2f low{0, -y}, high{x, y}, c_low{0, -0.15f}, c_high{0.27f, 0.15f};
  const Vec2f in{0.015f, 0.015f};
  b.show("canopy", steel,
         loft({ring(low + in, high - in, 0, -z + 0.02f, 1), ring(low + in, high - in, 0, -z, 1),
               ring(low + in, high - in, 0, -z, 1), ring(low, high, 0.002f, -z, 1),
               ring(low, high, 0.002f, -z, 1), ring(low, high, 0.002f, lip, 1),
               ring(low, high, 0.002f, lip, 1), ring(c_low, c_high, 0.002f, neck, 1)}));
  b.show("chimney", steel, slab({0, -0.148f, neck - 0.01f}, {0.268f, 0.148f, z}, 0.001f));
  b.show("chimney", steel, slab({0, -0.145f, neck - 0.01f}, {0.265f, 0.145f, z - 0.1f}, 0.001f));
  for (const float side : {-1.0f, 1.0f}) {
    const float y0 = side > 0 ? 0.004f : -y + 0.06f, y1 = side > 0 ? y - 0.06f : -0.004f;
    b.show("filters", shop.metal("aluminium"),
           slab({0.05f, y0, -z + 0.010f}, {x - 0.11f, y1, -z + 0.02f}, 0.002f));
    for (int i = 0; i < 12; ++i) {
      const float at = 0.06f + (x - 0.18f) * float(i) / 11;
      b.show("filters", shop.metal("aluminium"),
             slab({at, y0 + 0.008f, -z + 0.006f}, {at + 0.006f, y1 - 0.008f, -z + 0.012f}, 0));
    }
    b.show("grips", shop.metal("black"),
           slab({x - 0.14f, (y0 + y1) / 2 - 0.03f, -z + 0.003f},
                {x - 0.12f, (y0 + y1) / 2 + 0.03f, -z + 0.011f}, 0.002f));
    b.show("lamps", shop.glow({1, 0.93, 0.82}, 4000),
           cylinder(0.028f, -z + 0.012f, -z + 0.018f).moved(x - 0.06f, side * y * 0.6f, 0));
    LightOptions lamp;
    lamp.name = side > 0 ? "right" : "left";
    lamp.type = LightType::kSpot;
    lamp.position = {x - 0.06, side * y * 0.6, -z + 0.008};
    lamp.flux = 180;
    lamp.temperature = 3000;
    lamp.radius = 0.02;
    lamp.angle = 60;
    lamp.softness = 0.5;
    p.lights.push_back(lamp);
  }
  b.show("roof", steel,
         slab({0.02f, -y + 0.02f, -z + 0.019f}, {x - 0.016f, y - 0.016f, -z + 0.022f}, 0));
  for (int i = 0; i < 4; ++i)
    b.show("buttons", shop.metal("chrome"),
           knob(0.008f, 0.004f, {x, -0.045f + 0.03f * float(i), -z + 0.028f}));
  b.collide_box({0, -y, -z}, {x, y, lip});
  b.collide_box({0, -y * 0.75f, lip}, {x * 0.8f, y * 0.75f, (lip + neck) / 2});
  b.collide_box({0, -0.15f, lip}, {0.27f, 0.15f, z});
  b.mass = 14;
  return p;
}

constexpr PropKind kKitchenAppliances[] = {
    {"cooker", cooker, "hob with four plates over an oven"},
    {"dishwasher", dishwasher, "dishwasher in the row of a kitchen, with worktop"},
    {"range_hood", range_hood, "hood over a cooker, on the wall, with two lamps"},
};

}  // namespace

PropFamily kitchen_appliances() { return kKitchenAppliances; }

}  // namespace gloam
