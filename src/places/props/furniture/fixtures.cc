// Things fixed to walls and piped or wired: radiators, sockets.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// Stands off the wall by its brackets; its origin lies on the floor, its back plane is the wall.
Prop radiator(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size = limited(shop.size({0.13f, float(dice.uniform(0.8, 1.3)), 0.66f}),
                             {0.09f, 0.4f, 0.4f}, {0.2f, 2.4f, 1.2f});
  const float x = size.x / 2, y = size.y / 2, top = size.z, low = 0.12f;
  const std::string white = shop.paint(shop.color({0.86, 0.85, 0.83}), 0.3);
  Prop p;
  PropPart& b = p.body();
  const float c0 = 0.012f;  // middle, in front of the brackets
  if (dice.chance(0.5)) {
    const int count = std::max(5, int(size.y / 0.06f));
    const float pitch = size.y / float(count), tall = top - low;
    for (int k = 0; k < count; ++k) {
      const float at = -y + pitch * (float(k) + 0.5f);
      for (const float dx : {-0.026f, 0.026f})
        b.show("columns", white,
               rounded_box({0.034f, 0.74f * pitch, tall - 0.02f}, 0.013f, 2)
                   .moved(c0 + dx, at, (top + low) / 2));
      for (const float z : {low + 0.045f, top - 0.045f})
        b.show("columns", white,
               rounded_box({0.086f, 0.90f * pitch, 0.05f}, 0.018f, 2).moved(c0, at, z));
    }
  } else {
    // Pressed panels with flutes, a grille on top.
    const int flutes = std::max(8, int(size.y / 0.034f));
    for (const float side : {-1.0f, 1.0f}) {
      Path points;
      for (const float z : {low, low + 0.02f, low + 0.05f, top - 0.05f, top - 0.02f, top})
        for (int k = 0; k <= 4 * flutes; ++k) {
          const float u = float(k) / float(4 * flutes),
                      wave = std::max(0.0f, std::sin(2 * kPi * float(flutes) * u)) *
                             (z > low + 0.03f && z < top - 0.03f ? 1.0f : 0.0f);
          points.push_back({c0 + side * (0.030f + 0.007f * wave), side * (-y + size.y * u), z});
        }
      b.show("panels", white, sheet(points, 4 * flutes + 1));
      b.show("panels", white,
             slab({c0 - 0.031f, side * (y - 0.002f) - 0.002f, low + 0.004f},
                  {c0 + 0.031f, side * (y - 0.002f) + 0.002f, top}, 0.001f));
    }
    for (int k = 0; k < int(size.y / 0.02f); ++k) {
      const float at = -y + 0.01f + 0.02f * float(k);
      b.show(
          "grille", white,
          slab({c0 - 0.030f, at - 0.006f, top - 0.004f}, {c0 + 0.030f, at + 0.006f, top}, 0.001f));
    }
    b.show(
        "fins", shop.paint({0.50, 0.50, 0.49}),
        slab({c0 - 0.029f, -y + 0.004f, low + 0.002f}, {c0 + 0.029f, y - 0.004f, top - 0.02f}, 0));
  }
  for (const float side : {-0.7f, 0.7f})
    b.show("brackets", white,
           slab({-x, side * y - 0.012f, low + 0.06f}, {c0 - 0.02f, side * y + 0.012f, low + 0.09f},
                0.002f) +
               slab({-x, side * y - 0.012f, low + 0.04f},
                    {-x + 0.004f, side * y + 0.012f, top - 0.05f}, 0.001f));
  const std::string steel = shop.metal("chrome");
  const Path supply = smooth_path({{c0, y - 0.01f, low + 0.045f},
                                   {c0, y + 0.035f, low + 0.045f},
                                   {c0, y + 0.052f, low + 0.02f},
                                   {c0, y + 0.055f, 0}},
                                  5);
  b.show("pipes", steel, tube(supply, 0.008f, 12));
  Path other = supply;
  for (Vec3f& at : other) at.y = -at.y;
  b.show("pipes", steel, tube(other, 0.008f, 12));
  for (const float side : {-1.0f, 1.0f})
    b.show("roses", steel,
           cylinder(0.018f, 0, 0.006f, 0.002f, 24).moved(c0, side * (y + 0.055f), 0));
  b.show("valve_body", steel,
         bar({c0, y - 0.01f, low + 0.045f}, {c0, y + 0.032f, low + 0.045f}, 0.013f, 0.012f, 16));
  b.show("valve", shop.plastic({0.85, 0.85, 0.84}),
         lathe(rounded({{0, 0},
                        {0.017f, 0},
                        {0.021f, 0.012f},
                        {0.020f, 0.055f},
                        {0.012f, 0.062f},
                        {0, 0.062f}},
                       0.005f, 3),
               24)
             .turned(Axis::kY, 90)
             .moved(c0 + 0.008f, y + 0.03f, low + 0.045f));
  b.collide_box({-x, -y, low}, {c0 + 0.045f, y, top});
  for (const float side : {-1.0f, 1.0f})
    b.collide_cylinder(0.014f, 0, low + 0.06f, c0, side * (y + 0.052f));
  b.mass = 28.0 * double(size.y * size.z);  // steel, with its water
  return p;
}

// A plate in the wall, a hand's width across.
Prop wall_plate(Workshop& shop, bool switched) {
  Prop p;
  PropPart& b = p.body();
  const std::string white = shop.plastic(shop.color({0.84, 0.83, 0.80}), 0.3);
  b.show("plate", white, slab({0, -0.0405f, -0.0405f}, {0.009f, 0.0405f, 0.0405f}, 0.003f, 3));
  if (switched) {
    b.show("rocker", white,
           rounded_box({0.008f, 0.055f, 0.055f}, 0.002f, 2)
               .turned(Axis::kY, 3.5f)
               .moved(0.0085f, 0, 0));
  } else {
    // Type F: a round well with two holes and earth springs.
    const std::string dark = shop.plastic({0.02, 0.02, 0.021}, 0.8);
    b.show("well_floor", shop.plastic({0.62, 0.61, 0.59}, 0.4),
           cylinder(0.0195f, 0.0085f, 0.0094f, 0.0002f, 36).turned(Axis::kY, 90));
    for (const float y : {-0.0095f, 0.0095f})
      b.show("holes", dark,
             cylinder(0.003f, 0.0094f, 0.0098f, 0.0001f, 14).turned(Axis::kY, 90).moved(0, y, 0));
    for (const float z : {-0.018f, 0.018f})
      b.show("earth", shop.metal("steel"),
             slab({0.009f, -0.003f, z - 0.0015f}, {0.0105f, 0.003f, z + 0.0015f}, 0.0004f));
    b.show(
        "ring", white,
        lathe(
            rounded({{0.0195f, 0.0088f}, {0.020f, 0.0108f}, {0.0235f, 0.0100f}, {0.0245f, 0.0088f}},
                    0.001f, 2),
            40)
            .turned(Axis::kY, 90));
  }
  b.collide_box({0, -0.0405f, -0.0405f}, {0.010f, 0.0405f, 0.0405f});
  b.mass = 0.08;
  return p;
}

Prop wall_socket(Workshop& shop) { return wall_plate(shop, false); }
Prop light_switch(Workshop& shop) { return wall_plate(shop, true); }

constexpr PropKind kFixtures[] = {
    {"radiator", radiator, "heating radiator at a wall, of columns or panels"},
    {"wall_socket", wall_socket, "power socket"},
    {"light_switch", light_switch, "rocker switch beside a door"},
};

}  // namespace

PropFamily fixtures() { return kFixtures; }

}  // namespace gloam
