// Fittings of halls: light, air, doors, columns.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

Prop high_bay_lamp(Workshop& shop) {
  // LED "UFO" on a chain: 18,000 lm, 150 W.
  Prop p;
  PropPart& b = p.body();
  const float drop = std::clamp(shop.size({0.34f, 0.34f, 0.5f}).z, 0.25f, 3.0f), r = 0.165f,
              low = -drop;
  const std::string black = shop.paint({0.045, 0.045, 0.05}, 0.4), steel = shop.metal("galvanised");
  b.show("housing", black,
         lathe(rounded({{0, low + 0.012f},
                        {r - 0.012f, low + 0.012f},
                        {r, low},
                        {r, low + 0.03f},
                        {r * 0.93f, low + 0.045f},
                        {0.08f, low + 0.05f},
                        {0.075f, low + 0.13f},
                        {0.06f, low + 0.14f},
                        {0, low + 0.14f}},
                       0.006f),
               40));
  Solid fins;
  for (int k = 0; k < 24; ++k)
    fins += slab({0.07f, -0.002f, low + 0.045f}, {r * 0.9f, 0.002f, low + 0.095f}, 0)
                .turned(Axis::kZ, 15.0f * float(k));
  b.show("fins", black, fins);
  b.show("lens", shop.glow({1.0, 0.97, 0.92}, 3000),
         cylinder(r - 0.02f, low + 0.004f, low + 0.013f, 0.003f, 40));
  b.show("hook", steel,
         tube(smooth_path({{0, 0, low + 0.135f},
                           {0.018f, 0, low + 0.16f},
                           {0, 0, low + 0.185f},
                           {-0.016f, 0, low + 0.165f}}),
              0.004f, 6));
  const int links = std::max(1, int((drop - 0.19f) / 0.034f));
  for (int k = 0; k < links; ++k) {
    const float z = low + 0.185f + (drop - 0.19f) * (float(k) + 0.5f) / float(links),
                h = 0.6f * (drop - 0.19f) / float(links);
    Path link;
    for (int i = 0; i <= 10; ++i)
      link.push_back(
          {0.007f * std::cos(0.2f * kPi * float(i)), 0, h * std::sin(0.2f * kPi * float(i))});
    b.show("chain", steel,
           tube(link, 0.002f, 4).turned(Axis::kZ, k % 2 == 0 ? 0 : 90).moved(0, 0, z));
  }
  b.show("cable", shop.rubber(),
         tube(smooth_path({{0.04f, 0, low + 0.14f},
                           {0.045f, 0.01f, low + 0.25f},
                           {0.02f, 0.015f, low * 0.5f},
                           {0.02f, 0, -0.01f}}),
              0.004f, 6));
  b.show("plate", steel, cylinder(0.045f, -0.008f, 0, 0.002f, 20));
  b.collide_cylinder(r, low, low + 0.14f);
  b.mass = 3.6;
  LightOptions lamp;
  lamp.type = LightType::kDisk;
  lamp.position = {0, 0, low - 0.002};
  lamp.radius = 0.145;
  lamp.flux = 18000;
  lamp.temperature = 4000;
  p.lights.push_back(lamp);
  return p;
}

Prop strip_lamp(Workshop& shop) {
  // Weatherproof LED batten: 4,000 lm.
  const Vec3f size = shop.size({0.09f, 1.27f, 0.09f});
  const float y = std::clamp(size.y, 0.5f, 2.0f) / 2, low = -0.085f;
  Prop p;
  PropPart& b = p.body();
  b.show("base", shop.plastic({0.58, 0.59, 0.59}, 0.45),
         slab({-0.043f, -y, -0.05f}, {0.043f, y, -0.012f}, 0.01f, 2));
  b.show("cover", shop.glow({1.0, 0.98, 0.94}, 4000),
         plate_y(rounded_outline({{-0.040f, -0.05f},
                                  {-0.036f, low + 0.012f},
                                  {-0.015f, low + 0.002f},
                                  {0.015f, low + 0.002f},
                                  {0.036f, low + 0.012f},
                                  {0.040f, -0.05f}},
                                 0.01f),
                 -y + 0.012f, y - 0.012f));
  b.show("ends", shop.plastic({0.58, 0.59, 0.59}, 0.45),
         slab({-0.041f, -y, low + 0.003f}, {0.041f, -y + 0.014f, -0.045f}, 0.006f) +
             slab({-0.041f, y - 0.014f, low + 0.003f}, {0.041f, y, -0.045f}, 0.006f));
  for (const float at : {-y * 0.6f, y * 0.6f})
    b.show("clips", shop.metal("steel"),
           slab({-0.02f, at - 0.012f, -0.014f}, {0.02f, at + 0.012f, 0}, 0.002f));
  for (int k = 0; k < 5; ++k)
    for (const float side : {-1.0f, 1.0f}) {
      const float at = -y + 0.1f + (2 * y - 0.2f) * float(k) / 4;
      b.show("clips", shop.metal("steel"),
             slab({side * 0.044f - 0.002f, at - 0.01f, -0.065f},
                  {side * 0.044f + 0.002f, at + 0.01f, -0.035f}, 0.001f));
    }
  b.collide_box({-0.045f, -y, low}, {0.045f, y, 0});
  b.mass = 1.6;
  LightOptions lamp;
  lamp.type = LightType::kRect;
  lamp.position = {0, 0, low};
  lamp.size = {0.05, 2.0 * y - 0.05};
  lamp.flux = 4000;
  lamp.temperature = 4000;
  p.lights.push_back(lamp);
  return p;
}

Prop roller_door(Workshop& shop) {
  // Dock door of foam panels in its frame, before the opening; slides up by its open share.
  const Vec3f size = shop.size({0.35f, 3.1f, 3.6f});
  const float y = std::clamp(size.y, 1.5f, 6.0f) / 2 - 0.14f,
              z = std::clamp(size.z, 2.2f, 7.0f) - 0.42f;
  Prop p;
  PropPart& b = p.body();
  const std::string steel = shop.metal("galvanised"), white = shop.paint({0.80, 0.81, 0.81}, 0.4);
  const float face = 0.06f;
  for (const float s : {-1.0f, 1.0f}) {
    const auto part = [&](float a0, float a1, float x0, float x1, float z1) {
      return slab({x0, s > 0 ? y + a0 : -y - a1, 0}, {x1, s > 0 ? y + a1 : -y - a0, z1}, 0.003f);
    };
    b.show("tracks", steel,
           part(0.0f, 0.14f, 0, 0.004f, z + 0.42f) + part(0.085f, 0.09f, 0, 0.15f, z + 0.1f) +
               part(0.02f, 0.09f, 0.145f, 0.15f, z + 0.1f));
    b.show("guards", stripes(&shop, kSafetyYellow, {0.04, 0.04, 0.04}),
           panel(1.2f, 0.13f).turned(Axis::kX, 90).moved(0.1512f, s * (y + 0.055f), 0.65f));
    b.show("guards_back", shop.paint(kSafetyYellow, 0.4),
           part(-0.012f, 0.122f, 0.146f, 0.1508f, 1.25f));
    b.show("seal", shop.rubber(), part(-0.02f, 0.0f, 0.035f, 0.06f, z));
    b.collide_box({0, s > 0 ? y : -y - 0.14f, 0}, {0.151f, s > 0 ? y + 0.14f : -y, z + 0.42f});
  }
  // Shaft with springs and drums above, and a drive at its end.
  const float shaft = z + 0.22f;
  b.show("shaft", steel,
         bar({0.14f, -y - 0.12f, shaft}, {0.14f, y + 0.12f, shaft}, 0.0135f, 0.0135f, 12));
  for (const float s : {-1.0f, 1.0f}) {
    b.show(
        "drums", shop.metal("aluminium"),
        bar({0.14f, s * (y + 0.02f), shaft}, {0.14f, s * (y + 0.09f), shaft}, 0.075f, 0.08f, 24));
    Path spring;
    for (int k = 0; k <= 16 * 14; ++k) {
      const float a = 2 * kPi * float(k) / 14;
      spring.push_back({0.14f + 0.042f * std::cos(a),
                        s * (0.12f + (y - 0.25f) * float(k) / (16 * 14)),
                        shaft + 0.042f * std::sin(a)});
    }
    b.show("springs", shop.metal("black"), tube(spring, 0.006f, 4));
    b.show("springs", shop.metal("black"),
           bar({0.14f, s * 0.12f, shaft}, {0.14f, s * (y - 0.13f), shaft}, 0.037f, 0.037f, 16));
    b.show("brackets", steel,
           slab({0, s * 0.06f - 0.003f, shaft - 0.09f}, {0.19f, s * 0.06f + 0.003f, shaft + 0.09f},
                0.002f) +
               slab({0, s * (y + 0.11f) - 0.003f, shaft - 0.09f},
                    {0.19f, s * (y + 0.11f) + 0.003f, shaft + 0.09f}, 0.002f));
  }
  b.show("lintel", white, slab({0, -y - 0.14f, z + 0.02f}, {0.03f, y + 0.14f, z + 0.42f}, 0.004f));
  b.show("drive", shop.paint({0.10, 0.22, 0.38}, 0.4),
         slab({0.06f, y + 0.0f, shaft - 0.30f}, {0.20f, y + 0.12f, shaft - 0.09f}, 0.015f, 2));
  b.collide_box({0, -y - 0.14f, z + 0.02f}, {0.2f, y + 0.14f, z + 0.42f});
  b.mass = 70 + 18 * y * z;
  // The leaf: what is above the lintel has rolled away behind it, so that only the rest is drawn.
  const double share = shop.dice.pick({0.0, 0.0, 0.45, 0.9});
  const float shut = z * float(1 - share);
  const int panels = std::max(1, int(shut / 0.5f + 0.5f));
  const std::string leaf = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.78, 0.79, 0.80}, Vec3{0.08, 0.22, 0.42}, Vec3{0.52, 0.54, 0.55}})),
      0.4);
  const float bottom = z - shut + 0.012f;
  for (int i = 0; i < panels; ++i) {
    const float h = (shut - 0.012f) / float(panels), z0 = bottom + h * float(i),
                z1 = z0 + h - 0.004f;
    b.show("leaf", leaf, slab({face, -y - 0.02f, z0}, {face + 0.042f, y + 0.02f, z1}, 0.006f, 2));
    for (int k = 1; k < 4; ++k)  // beads along the sheet
      b.show("leaf", leaf,
             slab({face + 0.040f, -y - 0.015f, z0 + h * float(k) / 4 - 0.008f},
                  {face + 0.0455f, y + 0.015f, z0 + h * float(k) / 4 + 0.008f}, 0.003f));
    for (const float s : {-1.0f, 0.0f, 1.0f})
      b.show("hinges", steel,
             slab({face + 0.041f, s * (y - 0.03f) - 0.025f, z0 - 0.03f * float(i > 0)},
                  {face + 0.049f, s * (y - 0.03f) + 0.025f, z0 + 0.04f}, 0.002f));
    if (i == 2 && panels > 3)
      for (const float s : {-0.5f, 0.5f}) {
        b.show("window_frames", shop.plastic(kSafetyBlack, 0.45),
               slab({face - 0.002f, s * y - 0.3f, z0 + 0.1f},
                    {face + 0.047f, s * y + 0.3f, z0 + h - 0.12f}, 0.02f, 2));
        b.show("panes", shop.plastic({0.35, 0.40, 0.44}, 0.05),
               slab({face + 0.044f, s * y - 0.26f, z0 + 0.14f},
                    {face + 0.0485f, s * y + 0.26f, z0 + h - 0.16f}, 0.012f, 2));
      }
  }
  b.show("edge", shop.rubber(),
         slab({face + 0.004f, -y, bottom - 0.012f}, {face + 0.038f, y, bottom + 0.002f}, 0.005f));
  b.show(
      "handle", shop.plastic(kSafetyBlack, 0.45),
      slab({face + 0.042f, -0.09f, bottom + 0.12f}, {face + 0.07f, 0.09f, bottom + 0.15f}, 0.006f));
  b.collide_box({face, -y, bottom - 0.012f}, {face + 0.046f, y, z + 0.02f});
  b.mass += 12 * 2 * y * z;
  p.front = 1.5f;
  return p;
}

Prop dock_leveller(Workshop& shop) {
  // Its plate lies level with the floor, the lip at its back over the edge; frame, bumpers.
  const Vec3f size = shop.size({2.5f, 2.0f, 0.02f});
  const float x = std::clamp(size.x, 1.5f, 4.0f) / 2, y = std::clamp(size.y, 1.5f, 2.5f) / 2,
              top = 0.012f;
  Prop p;
  PropPart& b = p.body();
  const std::string steel = shop.paint(shop.color({0.30, 0.31, 0.32}), 0.5),
                    dark = shop.paint({0.02, 0.02, 0.02}, 0.8);
  b.show("pit", dark, slab({-x, -y, 0}, {x, y, 0.003f}, 0));
  b.show("plate", steel, slab({-x + 0.40f, -y + 0.07f, 0}, {x - 0.06f, y - 0.07f, top}, 0.003f));
  b.show("lip", steel, slab({-x + 0.01f, -y + 0.12f, 0}, {-x + 0.385f, y - 0.12f, top}, 0.004f));
  b.show(
      "hinge", shop.metal("steel"),
      bar({-x + 0.392f, -y + 0.1f, 0.006f}, {-x + 0.392f, y - 0.1f, 0.006f}, 0.0055f, 0.0055f, 8));
  // Tear pattern.
  Solid tears;
  for (int i = 0; i < int((2 * x - 0.6f) / 0.12f); ++i)
    for (int j = 0; j < int((2 * y - 0.3f) / 0.12f); ++j)
      tears += slab({-0.02f, -0.004f, 0}, {0.02f, 0.004f, 0.0018f}, 0)
                   .turned(Axis::kZ, (i + j) % 2 == 0 ? 45 : -45)
                   .moved(-x + 0.48f + 0.12f * float(i), -y + 0.18f + 0.12f * float(j), top);
  b.show("tears", steel, tears);
  for (const float s : {-1.0f, 1.0f}) {
    b.show("frame", shop.paint(kSafetyYellow, 0.45),
           slab({-x, s * (y - 0.03f) - 0.03f, 0}, {x, s * (y - 0.03f) + 0.03f, top}, 0.002f));
    b.show("bands", stripes(&shop, kSafetyYellow, {0.04, 0.04, 0.04}),
           panel(2 * x - 0.5f, 0.055f)
               .turned(Axis::kY, -90)
               .turned(Axis::kZ, 90)
               .moved(0.17f, s * (y - 0.03f), top + 0.0006f));
  }
  b.show("frame", shop.paint(kSafetyYellow, 0.45), slab({x - 0.05f, -y, 0}, {x, y, top}, 0.002f));
  b.collide_box({-x, -y, 0}, {x, y, top});
  b.mass = 7850 * 0.004 * 4 * x * y;  // the sheet; beams lie in the pit
  return p;
}

Prop column(Workshop& shop) {
  const Vec3f size = shop.size({0.3f, 0.3f, 6.0f});
  const float x = std::clamp(size.x, 0.15f, 0.8f) / 2, y = std::clamp(size.y, 0.15f, 0.8f) / 2,
              z = std::clamp(size.z, 2.0f, 20.0f);
  Prop p;
  PropPart& b = p.body();
  if (shop.dice.chance(0.5)) {
    b.show("column", shop.concrete(), rounded_box({2 * x, 2 * y, z}, 0.015f).moved(0, 0, z / 2));
    b.mass = 2400.0 * 4 * x * y * z;
  } else {  // rolled H section on a foot plate
    const float web = 0.009f, flange = 0.015f, w = y;
    const Profile h{{-x, -w},
                    {-x + flange, -w},
                    {-x + flange, -web / 2},
                    {x - flange, -web / 2},
                    {x - flange, -w},
                    {x, -w},
                    {x, w},
                    {x - flange, w},
                    {x - flange, web / 2},
                    {-x + flange, web / 2},
                    {-x + flange, w},
                    {-x, w}};
    b.show("column", shop.paint(shop.color({0.42, 0.45, 0.47}), 0.4), extrude(h, 0.02f, z));
    b.show("foot", shop.paint({0.42, 0.45, 0.47}, 0.4),
           slab({-x - 0.06f, -y - 0.06f, 0}, {x + 0.06f, y + 0.06f, 0.02f}, 0.002f));
    for (const float sx : {-1.0f, 1.0f})
      for (const float sy : {-1.0f, 1.0f})
        b.show(
            "bolts", shop.metal("galvanised"),
            (cylinder(0.02f, 0.02f, 0.04f, 0.002f, 6) + cylinder(0.011f, 0.04f, 0.07f, 0.002f, 10))
                .moved(sx * (x + 0.03f), sy * (y + 0.03f), 0));
    b.collide_box({-x - 0.06f, -y - 0.06f, 0}, {x + 0.06f, y + 0.06f, 0.02f});
    b.mass = 7850 * (4 * flange * w + web * 2 * x) * z;
  }
  b.collide_box({-x, -y, 0}, {x, y, z});
  if (shop.dice.chance(0.7)) {  // protector: two shells of foamed plastic with straps
    const Profile outer = rounded_rectangle(2 * x + 0.10f, 2 * y + 0.10f, 0.05f, 4);
    const float h = min(1.1f, z - 0.3f);
    b.show("protector", shop.plastic(kSafetyYellow, 0.45), extrude(outer, 0.04f, 0.04f + h));
    for (const float at : {0.25f, 0.75f}) {
      Path strap;
      for (const Vec2f q : rounded_rectangle(2 * x + 0.104f, 2 * y + 0.104f, 0.052f, 4))
        strap.push_back({q.x, q.y, 0.04f + h * at});
      strap.push_back(strap.front());
      for (const float dz : {-0.015f, 0.0f, 0.015f})
        b.show("straps", shop.plastic(kSafetyBlack, 0.5), tube(strap, 0.008f, 6).moved(0, 0, dz));
    }
    b.collide_box({-x - 0.05f, -y - 0.05f, 0.04f}, {x + 0.05f, y + 0.05f, 0.04f + h});
    b.mass += 12;
  }
  return p;
}

Prop air_duct(Workshop& shop) {
  // Spiral duct below the ceiling along y, with joints, hangers and grilles.
  const Vec3f size = shop.size({0.5f, 3.0f, 0.8f});
  const float r = std::clamp(size.x, 0.15f, 1.2f) / 2, y = std::clamp(size.y, 0.5f, 30.0f) / 2,
              axis = -std::max(size.z - r, r + 0.05f);
  Prop p;
  PropPart& b = p.body();
  const std::string steel = shop.metal("galvanised");
  const auto on_y = [&](const Solid& s) { return s.turned(Axis::kX, 90).moved(0, 0, axis); };
  b.show("duct", steel,
         on_y(lathe({{r - 0.004f, -y}, {r - 0.004f, y}}, 40) +
              ring(r - 0.006f, r - 0.004f, -y, -y + 0.001f, 40) +
              ring(r - 0.006f, r - 0.004f, y - 0.001f, y, 40) +
              lathe({{r - 0.006f, y}, {r - 0.006f, -y}}, 40)));
  Path seam;
  const int turns = int(2 * y / 0.13f);
  for (int k = 0; k <= turns * 24; ++k) {
    const float a = 2 * kPi * float(k) / 24;
    seam.push_back({(r - 0.003f) * std::cos(a),
                    -y + 0.01f + (2 * y - 0.02f) * float(k) / float(turns * 24),
                    axis + (r - 0.003f) * std::sin(a)});
  }
  b.show("seam", steel, tube(seam, 0.003f, 4));
  for (float at = -y; at <= y + 0.01f; at += std::min(3.0f, 2 * y))
    b.show("joints", steel,
           on_y(ring(r - 0.006f, r + 0.018f, -0.02f, 0.02f, 40)
                    .moved(0, 0, -std::clamp(at, -y + 0.02f, y - 0.02f))));
  for (const float at : {-y * 0.5f, y * 0.5f}) {
    b.show("hangers", steel, on_y(ring(r, r + 0.003f, -0.015f, 0.015f, 40).moved(0, 0, at)));
    for (const float s : {-1.0f, 1.0f})
      b.show("hangers", steel,
             bar({s * (r + 0.006f), -at, axis}, {s * (r + 0.006f), -at, 0}, 0.005f, 0.005f, 6));
    Solid blades;
    for (int k = 0; k < 9; ++k)
      blades += rounded_box({0.02f, 0.38f, 0.003f}, 0)
                    .turned(Axis::kY, 30)
                    .moved(r + 0.004f, 0, -0.052f + 0.013f * float(k));
    const Solid grille = slab({r - 0.02f, -0.22f, -0.085f}, {r + 0.008f, 0.22f, -0.062f}, 0.003f) +
                         slab({r - 0.02f, -0.22f, 0.062f}, {r + 0.008f, 0.22f, 0.085f}, 0.003f) +
                         slab({r - 0.02f, -0.22f, -0.085f}, {r + 0.008f, -0.19f, 0.085f}, 0.003f) +
                         slab({r - 0.02f, 0.19f, -0.085f}, {r + 0.008f, 0.22f, 0.085f}, 0.003f) +
                         blades;
    b.show("grilles", shop.metal("aluminium"),
           grille.turned(Axis::kY, 35).moved(0, at * 0.4f, axis));
    b.show("grille_holes", shop.paint({0.02, 0.02, 0.02}, 0.9),
           rounded_box({0.01f, 0.39f, 0.13f}, 0)
               .turned(Axis::kY, 35)
               .moved((r - 0.005f) * 0.819f, at * 0.4f, axis - (r - 0.005f) * 0.574f));
  }
  b.collide_cylinder(Vec3f{0, -y, axis}, Vec3f{0, y, axis}, r);
  b.mass = 7850 * 0.0008 * 2 * M_PI * r * 2 * y * 1.2;
  return p;
}

Prop sprinkler_pipe(Workshop& shop) {
  const Vec3f size = shop.size({0.1f, 3.0f, 0.35f});
  const float y = std::clamp(size.y, 0.5f, 30.0f) / 2,
              axis = -std::clamp(size.z - 0.1f, 0.12f, 2.0f), r = 0.021f;
  Prop p;
  PropPart& b = p.body();
  const std::string red = shop.paint(shop.color({0.62, 0.06, 0.05}), 0.38),
                    brass = shop.metal("brass"), steel = shop.metal("galvanised");
  b.show("pipe", red, bar({0, -y, axis}, {0, y, axis}, r, r, 16));
  const int heads = std::max(1, int(2 * y / 2.8f + 0.5f));
  for (int i = 0; i < heads; ++i) {
    const float at = -y + 2 * y * (float(i) + 0.5f) / float(heads), low = axis - r;
    b.show("tees", red,
           bar({0, at - 0.035f, axis}, {0, at + 0.035f, axis}, 0.028f, 0.028f, 16) +
               bar({0, at, axis}, {0, at, low - 0.02f}, 0.017f, 0.017f, 12));
    b.show("heads", brass,
           (cylinder(0.012f, -0.04f, -0.018f, 0.002f, 6) +
            cylinder(0.018f, -0.077f, -0.074f, 0.0005f, 16) +
            bar({0.009f, 0, -0.04f}, {0.003f, 0, -0.073f}, 0.002f, 0.002f, 6) +
            bar({-0.009f, 0, -0.04f}, {-0.003f, 0, -0.073f}, 0.002f, 0.002f, 6))
               .moved(0, at, low));
    b.show("bulbs", shop.plastic({0.75, 0.05, 0.04}, 0.05),
           cylinder(0.0022f, -0.068f, -0.04f, 0.001f, 8).moved(0, at, low));
    const float hang = at + 0.35f;
    b.show("hangers", steel,
           bar({0, hang, axis + r}, {0, hang, 0}, 0.005f, 0.005f, 6) +
               ring(r, r + 0.003f, -0.012f, 0.012f, 20).turned(Axis::kX, 90).moved(0, hang, axis));
  }
  b.collide_capsule({0, -y + r, axis}, {0, y - r, axis}, r + 0.003f);
  b.mass = 4.5 * 2 * y;  // 42.4 mm tube and its water
  return p;
}

constexpr PropKind kHalls[] = {
    {"high_bay_lamp", high_bay_lamp, "LED lamp of 18,000 lm on a chain; under the ceiling"},
    {"strip_lamp", strip_lamp, "LED batten of 4,000 lm; under the ceiling"},
    {"roller_door", roller_door, "dock door in its frame, shut or partly open; before a wall"},
    {"dock_leveller", dock_leveller, "plate of a loading dock, level with the floor"},
    {"column", column, "concrete or steel column, most with a protector"},
    {"air_duct", air_duct, "spiral duct along y; under the ceiling"},
    {"sprinkler_pipe", sprinkler_pipe, "red pipe along y with sprinklers; under the ceiling"},
};

}  // namespace

PropFamily halls() { return kHalls; }

}  // namespace gloam
