// Drums, tanks and bins.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

Prop drum(Workshop& shop) {
  // ISO 15750: 0.585 m over the hoops, 0.88 m high, 17 … 20 kg of steel.
  const float radius = 0.2925f, height = 0.88f;
  const Vec3 color = shop.color(
      shop.dice.pick({Vec3{0.06, 0.20, 0.48}, Vec3{0.10, 0.10, 0.11}, Vec3{0.60, 0.10, 0.06},
                      Vec3{0.10, 0.34, 0.20}, Vec3{0.82, 0.62, 0.08}}));
  Prop p;
  PropPart& b = p.body();
  add_drum(&b, &shop, {}, radius, height, color);
  if (shop.dice.chance(0.6))
    b.show("label", shop.dice.chance(0.5) ? shipping_label(&shop) : warning_picture(&shop, 0),
           panel(0.15f, 0.15f).moved(radius - 0.0025f, 0, 0.44f));
  const bool full = shop.dice.chance(0.5);
  b.mass = full ? 190 : 18;
  b.collide_cylinder(radius, 0, height);
  p.surfaces.push_back({{-0.19f, -0.19f}, {0.19f, 0.19f}, height});
  p.loose = true;
  return p;
}

Prop ibc_tank(Workshop& shop) {
  // 1,000 l: 1.2 x 1.0 x 1.16 m, about 60 kg empty.
  const float x = 0.6f, y = 0.5f, floor = 0.144f, top = 1.16f;
  Prop p;
  PropPart& b = p.body();
  const std::string steel = shop.metal("galvanised");
  // A steel pallet: plate on three runners and nine feet.
  b.show("pallet", steel, slab({-x, -y, floor - 0.012f}, {x, y, floor}, 0.003f));
  for (const float side : {-1.0f, 0.0f, 1.0f}) {
    const float at = side * (y - 0.05f);
    b.show("pallet", steel, slab({-x, at - 0.045f, 0}, {x, at + 0.045f, 0.015f}, 0.003f));
    for (const float end : {-1.0f, 0.0f, 1.0f})
      b.show("pallet", steel,
             slab({end * (x - 0.06f) - 0.05f, at - 0.04f, 0.012f},
                  {end * (x - 0.06f) + 0.05f, at + 0.04f, floor - 0.012f}, 0.006f));
    b.collide_box({-x, at - 0.05f, 0}, {x, at + 0.05f, floor - 0.012f});
  }
  // The bottle, with a sunk top and a neck; translucent polyethylene.
  const std::string pe = shop.plastic({0.84, 0.85, 0.82}, 0.4);
  b.show("bottle", pe,
         slab({-x + 0.035f, -y + 0.035f, floor}, {x - 0.035f, y - 0.035f, top - 0.05f}, 0.06f, 3));
  b.show("bottle", pe, cylinder(0.085f, top - 0.052f, top - 0.015f, 0.004f, 28));
  b.show("lid", shop.plastic(shop.dice.pick({Vec3{0.10, 0.10, 0.11}, Vec3{0.65, 0.08, 0.07}})),
         cylinder(0.095f, top - 0.04f, top - 0.004f, 0.006f, 16));
  // The cage: tubes all round, four of them level.
  const float r = 0.009f, cx = x - 0.012f, cy = y - 0.012f, cage = top - 0.03f;
  const Profile outline = rounded_rectangle(2 * cx, 2 * cy, 0.06f, 3);
  for (int i = 0; i <= 5; ++i) {
    const float z = floor + 0.02f + (cage - floor - 0.02f) * float(i) / 5;
    Path loop;
    for (const Vec2f q : outline) loop.push_back({q.x, q.y, z});
    loop.push_back(loop.front());
    b.show("cage", steel, tube(loop, r, 6));
  }
  const auto upright = [&](float ux, float uy) {
    b.show("cage", steel, wire({ux, uy, floor}, {ux, uy, cage}, r));
  };
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 0; i < 8; ++i)
      upright(-x + 0.09f + (2 * x - 0.18f) * float(i) / 7, side * (cy - 0.011f));
    for (int i = 0; i < 6; ++i) {
      const float at = -y + 0.09f + (2 * y - 0.18f) * float(i) / 5;
      if (side > 0 && std::fabs(at) < 0.09f) continue;  // room for the tap
      upright(side * (cx - 0.011f), at);
    }
    b.show("straps", steel,
           beam({-cx, side * 0.22f, top - 0.03f}, {cx, side * 0.22f, top - 0.03f}, 0.045f, 0.012f));
    b.show("plates", shop.metal("aluminium"),
           slab({side > 0 ? cx + r : -cx - r - 0.002f, side > 0 ? 0.16f : -0.2f, 0.62f},
                {side > 0 ? cx + r + 0.002f : -cx - r, side > 0 ? 0.42f : 0.2f, 0.92f}, 0.001f));
  }
  b.show("label", shipping_label(&shop), panel(0.2f, 0.14f).moved(cx + r + 0.003f, 0.29f, 0.80f));
  // The tap in its niche above the pallet.
  b.show("tap", shop.plastic({0.12, 0.12, 0.13}),
         bar({x - 0.07f, 0, floor + 0.075f}, {x - 0.012f, 0, floor + 0.075f}, 0.045f, 0.045f, 20));
  b.show("tap", shop.plastic({0.12, 0.12, 0.13}),
         bar({x - 0.02f, 0, floor + 0.075f}, {x + 0.0f, 0, floor + 0.075f}, 0.033f, 0.033f, 12));
  b.show("tap_lever", shop.plastic({0.70, 0.08, 0.07}),
         slab({x - 0.03f, -0.015f, floor + 0.118f}, {x + 0.0f, 0.085f, floor + 0.132f}, 0.004f));
  b.collide_box({-x, -y, floor - 0.012f}, {x, y, top});
  const double fill = shop.dice.chance(0.4) ? 0 : shop.dice.uniform(0.3, 1);
  b.mass = 60 + 1000 * fill;
  return p;
}

Prop plastic_bin(Workshop& shop) {
  // Euro container: walls of 3 mm, a rim, ribs, hand holes at its ends; it is open above.
  const float heights[] = {0.12f, 0.17f, 0.22f, 0.32f};
  const Vec3f size = shop.size({0.4f, 0.6f, heights[shop.dice.integer(0, 3)]});
  const float x = std::clamp(size.x, 0.15f, 0.8f) / 2, y = std::clamp(size.y, 0.2f, 1.2f) / 2,
              z = std::clamp(size.z, 0.075f, 0.5f), wall = 0.003f, in = 0.018f;
  const Vec3 color = shop.color(shop.dice.pick({Vec3{0.42, 0.43, 0.45}, Vec3{0.05, 0.22, 0.55},
                                                Vec3{0.65, 0.10, 0.08}, Vec3{0.82, 0.62, 0.08}}));
  Prop p;
  PropPart& b = p.body();
  const std::string pp = shop.plastic(color, 0.38);
  const float bx = x - in, by = y - in;
  b.show("bin", pp, slab({-bx, -by, 0}, {bx, by, 0.004f}, 0.0015f));
  b.show("bin", pp,
         slab({-bx + 0.02f, -by + 0.02f, 0.0035f}, {bx - 0.02f, by - 0.02f, 0.006f}, 0.001f));
  for (const float s : {-1.0f, 1.0f}) {
    const auto along = [&](float half, float out, bool ends) {
      // One wall in the frame of its own: y across, outer face at x = out.
      Solid side;
      if (ends && z > 0.15f) {
        const float hole = 0.055f, low = z - 0.075f, high = z - 0.04f;
        side += slab({out - wall, -half, 0}, {out, half, low}, 0.001f);
        side += slab({out - wall, -half, low}, {out, -hole, high}, 0.001f);
        side += slab({out - wall, hole, low}, {out, half, high}, 0.001f);
        side += slab({out - wall, -half, high}, {out, half, z}, 0.001f);
        side += slab({out - 0.001f, -hole - 0.008f, low - 0.008f},
                     {out + 0.012f, hole + 0.008f, low}, 0.002f);
      } else {
        side += slab({out - wall, -half, 0}, {out, half, z}, 0.001f);
      }
      side += slab({out - wall, -half - in, z - 0.008f}, {out + in, half + in, z}, 0.002f);
      side += slab({out - 0.001f, -half - in + 0.004f, z - 0.035f},
                   {out + in - 0.004f, half + in - 0.004f, z - 0.03f}, 0.001f);
      const int ribs = std::max(2, int(half / 0.07f));
      for (int i = 0; i <= ribs; ++i) {
        const float at = -half + 0.02f + (2 * half - 0.04f) * float(i) / float(ribs);
        if (ends && std::fabs(at) < 0.07f && z > 0.15f) continue;
        side += slab({out - 0.001f, at - 0.0015f, z - 0.034f},
                     {out + in - 0.004f, at + 0.0015f, z - 0.006f}, 0);
        side += slab({out - 0.001f, at - 0.002f, 0.03f}, {out + 0.004f, at + 0.002f, z - 0.034f},
                     0.001f);
      }
      return side;
    };
    b.show("bin", pp, along(bx, by, true).turned(Axis::kZ, s * 90));
    b.show("bin", pp, along(by, bx, false).turned(Axis::kZ, s > 0 ? 0 : 180));
  }
  b.show("label", place_label(&shop), panel(0.1f, 0.025f).moved(bx + 0.0045f, 0, z * 0.45f));
  // Four walls and a floor, so that things can lie in it.
  b.collide_box({-bx, -by, 0}, {bx, by, 0.006f});
  for (const float s : {-1.0f, 1.0f}) {
    b.collide_box({s > 0 ? bx - wall : -x, -y, 0.006f}, {s > 0 ? x : -bx + wall, y, z});
    b.collide_box({-bx + wall, s > 0 ? by - wall : -y, 0.006f},
                  {bx - wall, s > 0 ? y : -by + wall, z});
  }
  b.mass = 905 * 0.0032 * (4 * x * y + 4 * (x + y) * z) * 1.3;  // polypropylene; rim and ribs
  p.surfaces.push_back({{-bx + 0.01f, -by + 0.01f}, {bx - 0.01f, by - 0.01f}, 0.006f, z});
  p.loose = true;
  return p;
}

Prop cable_reel(Workshop& shop) {
  // A wooden drum that stands on its flange: boards, bolts and the rest of a cable.
  const float radius = std::clamp(shop.size({1.0f, 1.0f, 0.62f}).x, 0.4f, 2.0f) / 2;
  const float height = radius * 1.24f, flange = 0.05f * radius / 0.5f, core = radius * 0.48f;
  Prop p;
  PropPart& b = p.body();
  const int boards = 7;
  for (const float z : {0.0f, height - flange}) {
    for (int i = 0; i < boards; ++i) {  // chords of a circle
      const float y0 = radius * (2 * float(i) / boards - 1) + 0.002f,
                  y1 = radius * (2 * float(i + 1) / boards - 1) - 0.002f;
      Profile outline;
      const int steps = 6;
      for (int k = 0; k <= steps; ++k) {
        const float y = y0 + (y1 - y0) * float(k) / steps;
        outline.push_back({std::sqrt(std::max(0.0f, radius * radius - y * y)), y});
      }
      for (int k = steps; k >= 0; --k) {
        const float y = y0 + (y1 - y0) * float(k) / steps;
        outline.push_back({-std::sqrt(std::max(0.0f, radius * radius - y * y)), y});
      }
      b.show("flanges", shop.rough_wood(Axis::kX),
             extrude(outline, z + flange * 0.5f * (z > 0), z + flange * (z > 0 ? 1 : 0.5f)));
    }
    const float under = z > 0 ? z : z + flange / 2;
    b.show("rings", shop.rough_wood(Axis::kY),
           ring(radius * 0.5f, radius * 0.985f, under, under + flange / 2, 36));
  }
  b.show("core", shop.rough_wood(Axis::kZ), ring(core - 0.03f, core, flange, height - flange, 28));
  b.show("hole", shop.metal("black"),
         cylinder(radius * 0.09f, height, height + 0.002f, 0.0005f, 20));
  b.show("bushing", shop.metal("steel"),
         ring(radius * 0.09f, radius * 0.16f, height, height + 0.003f, 20));
  for (int k = 0; k < 6; ++k) {
    const float a = kPi * float(k) / 3 + 0.2f, at = core * 0.86f;
    b.show("bolts", shop.metal("galvanised"),
           cylinder(0.018f, height, height + 0.012f, 0.002f, 6)
               .moved(at * std::cos(a), at * std::sin(a), 0));
  }
  // Windings.
  const float wound = core + (radius - core) * float(shop.dice.uniform(0.2, 0.8)),
              r = 0.022f * radius / 0.5f;
  Path coil;
  const int turns = int((height - 2 * flange - 2 * r) / (2.02f * r));
  const Vec3 color = shop.color(
      shop.dice.pick({Vec3{0.03, 0.03, 0.03}, Vec3{0.75, 0.30, 0.04}, Vec3{0.12, 0.12, 0.14}}));
  for (int k = 0; k <= turns * 28; ++k) {
    const float a = 2 * kPi * float(k) / 28;
    coil.push_back({(wound - r) * std::cos(a), (wound - r) * std::sin(a),
                    flange + r + 2.02f * r * float(k) / 28});
  }
  b.show("cable", shop.rubber(color), tube(coil, r, 6));
  b.show("cable", shop.rubber(color),
         ring(wound - 3 * r, wound - r, flange + 0.001f, height - flange - 0.001f, 28));
  b.collide_cylinder(radius, 0, flange)
      .collide_cylinder(radius, height - flange, height)
      .collide_cylinder(wound, flange, height - flange);
  b.mass = 600 * M_PI * radius * radius * flange * 2 +
           900 * M_PI * (wound * wound - core * core) * height;
  p.surfaces.push_back(
      {{-radius * 0.65f, -radius * 0.65f}, {radius * 0.65f, radius * 0.65f}, height + 0.003f});
  return p;
}

Prop gas_cylinder(Workshop& shop) {
  // 50 l steel bottle: 229 mm, 1.64 m with its cap, 65 kg; EN 1089-3 colours its shoulder.
  const float r = 0.1145f, shoulder = 1.36f, neck = 1.50f;
  const Vec3 body = shop.color(
      shop.dice.pick({Vec3{0.35, 0.36, 0.37}, Vec3{0.10, 0.22, 0.42}, Vec3{0.52, 0.10, 0.08}}));
  const Vec3 top = shop.dice.pick({Vec3{0.88, 0.88, 0.86}, Vec3{0.10, 0.10, 0.10},
                                   Vec3{0.08, 0.32, 0.14}, Vec3{0.60, 0.08, 0.06}});
  Prop p;
  PropPart& b = p.body();
  b.show("body", shop.paint(body, 0.38),
         lathe(rounded({{0, 0.02f}, {r * 0.8f, 0.02f}, {r * 0.93f, 0}, {r, 0.03f}, {r, shoulder}},
                       0.012f),
               32));
  Profile dome{{r, shoulder}};
  for (int k = 1; k <= 6; ++k) {
    const float a = kPi / 2 * float(k) / 7;
    dome.push_back({0.032f + (r - 0.032f) * std::cos(a), shoulder + 0.11f * std::sin(a)});
  }
  dome.insert(dome.end(), {{0.036f, neck - 0.02f}, {0.036f, neck}, {0, neck}});
  b.show("shoulder", shop.paint(top, 0.38), lathe(dome, 32));
  if (shop.dice.chance(0.5)) {  // cap with windows
    b.show("cap", shop.paint(body, 0.45),
           lathe(rounded({{0.043f, neck - 0.03f},
                          {0.043f, neck + 0.09f},
                          {0.03f, neck + 0.135f},
                          {0, neck + 0.14f}},
                         0.02f, 3),
                 24));
    for (const float side : {-1.0f, 1.0f})
      b.show("windows", shop.metal("black"),
             slab({-0.013f, side * 0.0425f - 0.002f, neck + 0.01f},
                  {0.013f, side * 0.0425f + 0.002f, neck + 0.07f}, 0.001f));
  } else {
    const std::string brass = shop.metal("brass");
    b.show("valve", brass,
           cylinder(0.016f, neck, neck + 0.07f, 0.002f, 16) +
               bar({0, 0, neck + 0.035f}, {0.045f, 0, neck + 0.035f}, 0.013f, 0.012f, 16));
    b.show("wheel", shop.paint({0.12, 0.12, 0.12}),
           ring(0.022f, 0.032f, neck + 0.085f, neck + 0.097f, 20) +
               slab({-0.026f, -0.004f, neck + 0.087f}, {0.026f, 0.004f, neck + 0.095f}, 0.001f) +
               slab({-0.004f, -0.026f, neck + 0.087f}, {0.004f, 0.026f, neck + 0.095f}, 0.001f));
    b.show("valve", brass, cylinder(0.007f, neck + 0.07f, neck + 0.1f, 0.001f, 10));
  }
  // A label that lies around the wall.
  std::vector<Vec3f> points;
  for (const float z : {1.10f, 1.24f})
    for (int k = 0; k <= 8; ++k) {
      const float a = -0.8f + 1.6f * float(k) / 8;
      points.push_back({(r + 0.0006f) * std::cos(a), (r + 0.0006f) * std::sin(a), z});
    }
  b.show("label", shipping_label(&shop), sheet(points, 9));
  b.collide_cylinder(r, 0, shoulder + 0.03f)
      .collide_cylinder(0.06f, shoulder + 0.03f, neck)
      .collide_cylinder(0.043f, neck, neck + 0.12f);
  b.mass = 65;
  return p;
}

constexpr PropKind kContainers[] = {
    {"drum", drum, "steel barrel of 200 l"},
    {"ibc_tank", ibc_tank, "tank of 1,000 l in its cage on a pallet"},
    {"plastic_bin", plastic_bin, "open euro container"},
    {"cable_reel", cable_reel, "wooden reel with a cable, lying on its flange"},
    {"gas_cylinder", gas_cylinder, "steel bottle of 50 l with cap or valve"},
};

}  // namespace

PropFamily containers() { return kContainers; }

}  // namespace gloam
