// Fittings on the walls of bathrooms, and their shelves.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Prop towel_rail(Workshop& shop) {
  const Vec3f size = shop.size({0.11f, 0.50f, shop.dice.pick({0.8f, 1.2f})});
  const float y = std::clamp(size.y, 0.3f, 0.9f) / 2, z = std::clamp(size.z, 0.4f, 1.8f) / 2,
              x = 0.062f;
  const std::string paint = shop.paint({0.90, 0.90, 0.89}, 0.3), metal = bright_metal(shop);
  const std::string tube_of = shop.dice.chance(0.5) ? paint : metal;
  Prop p;
  PropPart& b = p.body();
  for (const float side : {-1.0f, 1.0f}) {
    b.show(
        "posts", tube_of,
        slab({x - 0.016f, side * y - 0.016f, -z}, {x + 0.016f, side * y + 0.016f, z}, 0.010f, 3));
    for (const float at : {-z + 0.06f, z - 0.06f})
      b.show("brackets", metal,
             bar({0, side * (y - 0.05f), at}, {x, side * (y - 0.05f), at}, 0.011f, 0.008f, 14));
    b.collide_box({x - 0.016f, side * y - 0.016f, -z}, {x + 0.016f, side * y + 0.016f, z});
  }
  const int rungs = std::max(4, int(2 * z / 0.055f));
  for (int i = 0; i < rungs; ++i) {
    const float at = -z + 0.03f + (2 * z - 0.06f) * float(i) / float(rungs - 1);
    if (i % 7 == 5) continue;  // gaps for towels
    b.show("rungs", tube_of, bar({x, -y, at}, {x, y, at}, 0.011f, 0.011f, 12));
  }
  const int hung = std::min(shop.dice.integer(1, 2), z > 0.45f ? 2 : 1);
  for (int i = 0; i < hung; ++i) {
    const float at =
        -z + 0.03f + (2 * z - 0.06f) * float(i == 0 ? rungs - 2 : rungs / 2) / float(rungs - 1);
    const float drop = i == 0 ? 0.42f : 0.30f;
    b.show("towel_" + std::to_string(i),
           shop.carpet(i == 0 ? shop.color(towel_color(shop)) : towel_color(shop)),
           draped(2 * y - 0.10f - 0.06f * float(i), min(drop, at + z + 0.2f),
                  min(drop * 0.85f, at + z + 0.1f), 0.012f, shop.dice.seed(), 0.006f)
               .moved(x, 0, at));
    b.collide_box({x - 0.03f, -y + 0.05f, at - min(drop, at + z + 0.2f)},
                  {x + 0.035f, y - 0.05f, at + 0.018f});
  }
  b.collide_box({x - 0.011f, -y, -z + 0.02f}, {x + 0.011f, y, z - 0.02f});
  b.mass = 9 * z + 1;
  return p;
}

Prop mirror_cabinet(Workshop& shop) {
  const Vec3f size = shop.size({0.15f, float(shop.dice.uniform(0.55, 0.8)), 0.68f});
  const float x = std::clamp(size.x, 0.12f, 0.25f), y = std::clamp(size.y, 0.4f, 1.2f) / 2,
              z = std::clamp(size.z, 0.4f, 1.0f) / 2;
  const std::string board = shop.paint(shop.color({0.88, 0.88, 0.87}), 0.35);
  Prop p;
  PropPart& b = p.body();
  const float t = 0.016f, face = x - 0.021f;
  add_carcass(&b, "carcass", board, {0, -y, -z}, {face, y, z}, t);
  for (const float at : {-z / 3, z / 3})
    b.show("shelves", shop.glass(),
           slab({0.01f, -y + t, at}, {face - 0.015f, y - t, at + 0.005f}, 0));
  const Vec3 tints[] = {{0.30, 0.50, 0.62}, {0.85, 0.80, 0.70}, {0.60, 0.25, 0.28}};
  for (int i = 0; i < 7; ++i) {
    const float at = -y + 0.06f + (2 * y - 0.12f) * float(i) / 6,
                r = float(shop.dice.uniform(0.015, 0.024)),
                h = float(shop.dice.uniform(0.07, 0.14));
    b.show("bottles_" + std::to_string(i % 3), shop.plastic(tints[i % 3]),
           lathe(rounded(
                     {{0, 0}, {r, 0}, {r, h * 0.75f}, {r * 0.5f, h * 0.82f}, {r * 0.5f, h}, {0, h}},
                     0.004f),
                 18)
               .moved(0.05f, at, i % 2 ? -z + t : z / 3 + 0.005f));
  }
  // Lamp over the doors, as wide as the cabinet.
  b.show("lamp", shop.metal("chrome"),
         slab({0, -y + 0.05f, z}, {x + 0.03f, y - 0.05f, z + 0.018f}, 0.004f));
  b.show("glow", shop.glow({1, 0.95, 0.88}, 5000),
         slab({x - 0.01f, -y + 0.07f, z - 0.001f}, {x + 0.022f, y - 0.07f, z + 0.003f}, 0));
  b.collide_box({0, -y + 0.05f, z}, {x + 0.03f, y - 0.05f, z + 0.018f});
  LightOptions lamp;
  lamp.name = "lamp";
  lamp.type = LightType::kRect;
  lamp.position = {x + 0.006, 0, z - 0.003};
  lamp.size = {{0.03, 2.0 * y - 0.14}};
  lamp.flux = 700;
  lamp.temperature = 4000;
  p.lights.push_back(lamp);
  b.mass = 700.0 * 0.016 * (4 * x * z + 4 * x * y) + 3;
  for (const float side : {-1.0f, 1.0f}) {
    const std::string name = side < 0 ? "door_left" : "door_right";
    const float width = y - 0.003f;
    PropPart& door =
        p.hang(name, {x, side * (y - 0.001f), -z + 0.001f}, upright_hinge(-side, 1.75, 0.1));
    const float y0 = min(0.0f, -side * width), y1 = y0 + width, tall = 2 * z - 0.002f;
    door.show("board", board, slab({-0.018f, y0, 0}, {-0.004f, y1, tall}, 0.001f));
    door.show("mirror", shop.mirror(), slab({-0.004f, y0, 0}, {0, y1, tall}, 0.0012f));
    door.collide_box({-0.018f, y0, 0}, {0, y1, tall});
    door.mass = (700 * 0.014 + 2500 * 0.004) * width * tall;
  }
  return p;
}

Prop toilet_paper(Workshop& shop) {
  const std::string metal = bright_metal(shop), tissue = shop.paper({0.91, 0.91, 0.90});
  Prop p;
  PropPart& b = p.body();
  const float x = 0.068f, r = float(shop.dice.uniform(0.035, 0.056));
  b.show("holder", metal, bar({0, 0.085f, 0.03f}, {0.008f, 0.085f, 0.03f}, 0.022f, 0.020f, 24));
  b.show("holder", metal,
         tube(smooth_path({{0.004f, 0.085f, 0.03f},
                           {x - 0.02f, 0.085f, 0.03f},
                           {x - 0.002f, 0.083f, 0.03f},
                           {x, 0.07f, 0.03f},
                           {x, 0, 0.03f},
                           {x, -0.066f, 0.03f}},
                          5),
              0.006f, 12));
  b.show("holder", metal, ball(0.009f, 12).moved(x, -0.068f, 0.03f));
  const float z = 0.03f - 0.0135f;  // the roll hangs on the bar
  b.show("roll", tissue,
         sharp_lathe({{0.020f, -0.05f}, {r, -0.05f}, {r, 0.05f}, {0.020f, 0.05f}, {0.020f, -0.05f}},
                     40)
             .turned(Axis::kX, 90)
             .moved(x, 0, z));
  b.show("core", shop.cardboard(),
         sharp_lathe({{0.0188f, -0.0502f},
                      {0.0199f, -0.0502f},
                      {0.0199f, 0.0502f},
                      {0.0188f, 0.0502f},
                      {0.0188f, -0.0502f}},
                     28)
             .turned(Axis::kX, 90)
             .moved(x, 0, z));
  std::vector<Vec3f> end;
  for (int i = 0; i <= 6; ++i)
    for (const float y : {-0.0495f, 0.0495f})
      end.push_back(
          {x + r + 0.0005f + 0.003f * std::sin(float(i)), y, z - 0.11f * (1 - float(i) / 6)});
  b.show("roll", tissue, sheet(end, 2, 0.0005f));
  b.collide_cylinder({x, -0.05f, z}, {x, 0.05f, z}, r);
  b.collide_box({0, 0.078f, 0.02f}, {x + 0.006f, 0.092f, 0.04f});
  b.mass = 0.5;
  return p;
}

Prop bath_shelf(Workshop& shop) {
  const Vec3f size = shop.size({0.30f, 0.40f, float(shop.dice.uniform(0.9, 1.5))});
  const float x = std::clamp(size.x, 0.2f, 0.45f) / 2, y = std::clamp(size.y, 0.25f, 0.8f) / 2,
              z = std::clamp(size.z, 0.6f, 1.9f);
  const std::string metal = bright_metal(shop), wood = shop.wood(Axis::kY);
  Prop p;
  PropPart& b = p.body();
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f}) {
      b.show("posts", metal,
             bar({sx * (x - 0.012f), sy * (y - 0.012f), 0},
                 {sx * (x - 0.012f), sy * (y - 0.012f), z - 0.012f}, 0.009f, 0.009f, 14));
      b.show("posts", metal,
             ball(0.012f, 14).moved(sx * (x - 0.012f), sy * (y - 0.012f), z - 0.012f));
      b.collide_cylinder(0.009f, 0, z - 0.012f, sx * (x - 0.012f), sy * (y - 0.012f));
    }
  const int levels = std::max(2, int(std::lround((z - 0.15f) / 0.33f)) + 1);
  for (int i = 0; i < levels; ++i) {
    const float at = 0.12f + (z - 0.20f) * float(i) / float(levels - 1);
    for (int k = 0; k < 4; ++k) {
      const float w = (2 * x - 0.03f) / 4, x0 = -x + 0.015f + w * float(k);
      b.show(
          "slats", wood,
          slab({x0 + 0.003f, -y + 0.006f, at - 0.016f}, {x0 + w - 0.003f, y - 0.006f, at}, 0.003f));
    }
    for (const float sx : {-1.0f, 1.0f})
      for (const float lift : {-0.022f, 0.05f})
        b.show("rails", metal,
               bar({sx * (x - 0.012f), -y + 0.012f, at + lift},
                   {sx * (x - 0.012f), y - 0.012f, at + lift}, 0.005f, 0.005f, 8));
    b.collide_box({-x + 0.012f, -y + 0.006f, at - 0.024f}, {x - 0.012f, y - 0.006f, at});
    const float free = i + 1 < levels ? (z - 0.20f) / float(levels - 1) - 0.03f : 1.0f;
    if (i % 2 == 0 && i + 1 < levels) {  // folded towels
      for (int k = 0; k < 3; ++k) {
        const float w = min(0.15f, y - 0.03f), d = x - 0.045f, h = 0.045f,
                    z0 = at + 0.001f + h * float(k);
        b.show("towel_" + std::to_string(3 * i + k), shop.carpet(towel_color(shop)),
               rounded_box({2 * d, 2 * w, h * 0.96f}, 0.020f, 4).moved(0, 0, z0 + h / 2));
      }
      b.collide_box({-x + 0.045f, -min(0.15f, y - 0.03f), at},
                    {x - 0.045f, min(0.15f, y - 0.03f), at + 0.135f});
    } else {
      p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {x - 0.03f, y - 0.03f}, at, free});
    }
  }
  b.mass = 5 + 3 * z;
  return p;
}

constexpr PropKind kBathroomFittings[] = {
    {"towel_rail", towel_rail, "heated rail on a wall with towels over it"},
    {"mirror_cabinet", mirror_cabinet, "wall cabinet with mirror doors and a lamp"},
    {"toilet_paper", toilet_paper, "roll on a holder on the wall"},
    {"bath_shelf", bath_shelf, "slatted shelf with folded towels"},
};

}  // namespace

PropFamily bathroom_fittings() { return kBathroomFittings; }

}  // namespace gloam
