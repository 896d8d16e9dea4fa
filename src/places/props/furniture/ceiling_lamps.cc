// Lamps of ceilings.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

Prop pendant_lamp(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size =
      limited(shop.size({float(dice.uniform(0.38, 0.54)), 0, float(dice.uniform(0.6, 0.9))}),
              {0.2f, 0, 0.35f}, {0.8f, 10, 1.8f});
  const float r = size.x / 2, drop = size.z;
  Prop p;
  PropPart& b = p.body();
  const std::string white = shop.plastic({0.84, 0.83, 0.80});
  b.show("rose", white, cylinder(0.05f, -0.028f, 0, 0.006f, 28));
  if (dice.chance(0.5)) {
    // A paper lantern: the sphere of light itself, with rings of bamboo.
    const float c = -drop + r;
    b.show("cord", white, cylinder(0.003f, c + r, -0.02f, 0.001f, 8));
    add_bulb(&p, {0, 0, c}, 1100, 2900, 0.98 * double(r));
    for (int k = -6; k <= 6; ++k) {
      const float h = 0.14f * r * float(k), q = std::sqrt(r * r - h * h) - 0.0025f;
      Path ring;
      for (int i = 0; i <= 40; ++i)
        ring.push_back(
            {q * std::cos(2 * kPi * float(i) / 40), q * std::sin(2 * kPi * float(i) / 40), c + h});
      b.show("rings", shop.wood("pine", Axis::kX), tube(ring, 0.0012f, 5));
    }
    for (const float end : {-1.0f, 1.0f})
      b.show("collar", white,
             cylinder(0.26f * r, c + end * 0.965f * r - 0.006f, c + end * 0.965f * r + 0.006f,
                      0.003f, 28));
    b.collide_sphere({0, 0, c}, 0.98f * r);
    b.mass = 0.9;
  } else {
    // A spun metal bell.
    const std::string metal = dice.chance(0.3)
                                  ? shop.metal("brass")
                                  : shop.paint(shop.color(dice.pick<Vec3>({{0.10, 0.10, 0.105},
                                                                           {0.84, 0.83, 0.80},
                                                                           {0.16, 0.30, 0.32},
                                                                           {0.66, 0.42, 0.16}})),
                                               0.4);
    const float h = 0.95f * r, z0 = -drop;
    b.show("cord", shop.plastic({0.125, 0.125, 0.127}),
           cylinder(0.003f, z0 + h + 0.03f, -0.02f, 0.001f, 8));
    b.show("bell", metal,
           lathe(rounded({{r, z0},
                          {0.86f * r, z0 + 0.42f * h},
                          {0.28f * r, z0 + 0.82f * h},
                          {0.20f * r, z0 + h},
                          {0, z0 + h}},
                         0.12f * r, 4),
                 48));
    b.show("inside", shop.paint({0.88, 0.87, 0.85}, 0.5),
           lathe(rounded({{0, z0 + h - 0.004f},
                          {0.19f * r, z0 + h - 0.004f},
                          {0.27f * r, z0 + 0.81f * h},
                          {0.85f * r, z0 + 0.41f * h},
                          {r - 0.003f, z0},
                          {r, z0}},
                         0.12f * r, 4),
                 48));
    b.show("socket", shop.metal("brass"), cylinder(0.021f, z0 + h, z0 + h + 0.035f, 0.003f, 20));
    b.show("socket_inside", shop.plastic({0.125, 0.125, 0.127}),
           cylinder(0.02f, z0 + 0.62f * h, z0 + h, 0.003f, 18));
    add_bulb(&p, {0, 0, z0 + 0.62f * h - 0.035f}, 1055, 2700, 0.034);
    b.collide_cylinder(0.95f * r, z0, z0 + 0.45f * h);
    b.collide_cylinder(0.55f * r, z0 + 0.45f * h, z0 + h);
    b.mass = 1.8;
  }
  b.collide_capsule({0, 0, -drop + 2 * r}, {0, 0, -0.02f}, 0.006f);
  return p;
}

Prop ceiling_lamp(Workshop& shop) {
  const Vec3f size = limited(shop.size({float(shop.dice.uniform(0.30, 0.42)), 0, 0.085f}),
                             {0.2f, 0, 0.06f}, {0.7f, 10, 0.15f});
  const float r = size.x / 2, h = size.z;
  const double flux = 1800;
  Prop p;
  PropPart& b = p.body();
  b.show("rim", shop.dice.chance(0.5) ? shop.metal("steel") : shop.paint({0.84, 0.83, 0.80}),
         sharp_lathe({{r, -0.30f * h}, {r, 0}}, 48) +
             lathe(rounded({{0.94f * r, -0.30f * h},
                            {0.95f * r, -0.36f * h},
                            {r, -0.36f * h},
                            {r, -0.29f * h}},
                           0.004f, 3),
                   48) +
             sharp_lathe({{r, 0}, {0, 0}}, 48));
  // Opal glass: its middle is the lamp, the rest glows as bright.
  b.show(
      "opal",
      shop.glow({0.95, 0.94, 0.91}, std::round(flux / (M_PI * M_PI * double(r * r) * 1.15))),
      lathe(rounded({{0, -h}, {0.72f * r, -0.86f * h}, {0.95f * r, -0.34f * h}}, 0.3f * r, 6), 48));
  LightOptions light;
  light.type = LightType::kDisk;
  light.position = {0, 0, double(-h) - 0.0005};
  light.radius = 0.7 * double(r);
  light.flux = 0.55 * flux;
  light.temperature = 4000;
  p.lights.push_back(std::move(light));
  b.collide_cylinder(0.98f * r, -0.4f * h, 0);
  b.collide_cylinder(0.75f * r, -h, -0.4f * h);
  b.mass = 1.6;
  return p;
}

constexpr PropKind kCeilingLamps[] = {
    {"pendant_lamp", pendant_lamp, "paper lantern or metal bell on a cord from the ceiling"},
    {"ceiling_lamp", ceiling_lamp, "flat opal lamp at the ceiling"},
};

}  // namespace

PropFamily ceiling_lamps() { return kCeilingLamps; }

}  // namespace gloam
