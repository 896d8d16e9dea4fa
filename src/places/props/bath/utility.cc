// Things in utility rooms.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

// Carton with a strip of tape over its seam.
void show_carton(Workshop& shop, PropPart* b, Vec3f low, Vec3f high) {
  b->show("cartons", shop.cardboard(), slab(low, high, 0.002f));
  const float y = (low.y + high.y) / 2;
  const std::string tape = shop.plastic({0.52, 0.40, 0.26}, 0.3);
  b->show("tape", tape,
          slab({low.x, y - 0.024f, high.z - 0.001f}, {high.x, y + 0.024f, high.z + 0.0006f}, 0));
  b->show("tape", tape,
          slab({high.x - 0.001f, y - 0.024f, high.z - 0.07f},
               {high.x + 0.0006f, y + 0.024f, high.z + 0.0006f}, 0));
  b->show("labels", shop.paper({0.88, 0.88, 0.86}),
          slab({high.x - 0.001f, low.y + 0.02f, low.z + 0.03f},
               {high.x + 0.0006f, low.y + 0.10f, low.z + 0.085f}, 0));
}

void show_tin(Workshop& shop, PropPart* b, int tint, Vec3f at, float r, float h) {
  const Vec3 tints[] = {
      {0.55, 0.12, 0.09}, {0.12, 0.28, 0.45}, {0.75, 0.62, 0.22}, {0.82, 0.81, 0.77}};
  b->show("tins", shop.metal("aluminium"),
          sharp_lathe({{r, 0},
                       {r, 0.005f},
                       {r - 0.002f, 0.006f},
                       {r - 0.002f, h - 0.006f},
                       {r, h - 0.005f},
                       {r, h},
                       {r - 0.006f, h},
                       {r - 0.006f, h - 0.004f},
                       {0, h - 0.004f}},
                      20)
              .moved(at));
  b->show("tin_labels_" + std::to_string(tint), shop.paint(tints[tint], 0.4),
          lathe({{r - 0.001f, 0.010f}, {r - 0.001f, h - 0.010f}}, 24).moved(at));
}

Prop shelf_unit(Workshop& shop) {
  const Vec3f size = shop.size({0.40f, float(shop.dice.uniform(0.8, 1.1)), 1.80f});
  const float x = std::clamp(size.x, 0.25f, 0.8f) / 2, y = std::clamp(size.y, 0.5f, 2.0f) / 2,
              z = std::clamp(size.z, 0.8f, 2.5f);
  const std::string zinc = shop.metal("galvanised"), board = shop.wood("birch", Axis::kY),
                    dark = shop.rubber();
  Prop p;
  PropPart& b = p.body();
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f}) {  // angle posts, with rows of holes on their faces
      const float ax = sx * x, ay = sy * y, t = 0.0018f, w = 0.036f;
      b.show("posts", zinc,
             slab({min(ax, ax - sx * w), min(ay, ay - sy * t), 0.004f},
                  {max(ax, ax - sx * w), max(ay, ay - sy * t), z}, 0));
      b.show("posts", zinc,
             slab({min(ax, ax - sx * t), min(ay, ay - sy * w), 0.004f},
                  {max(ax, ax - sx * t), max(ay, ay - sy * w), z}, 0));
      if (sx > 0)
        for (float at = 0.05f; at < z - 0.03f; at += 0.05f)
          b.show("holes", shop.paint({0.05, 0.05, 0.05}),
                 slab({x - 0.001f, ay - sy * 0.018f - 0.004f, at},
                      {x + 0.0004f, ay - sy * 0.018f + 0.004f, at + 0.016f}, 0));
      b.show("feet", dark,
             slab({min(ax, ax - sx * 0.04f), min(ay, ay - sy * 0.04f), 0},
                  {max(ax, ax - sx * 0.04f), max(ay, ay - sy * 0.04f), 0.012f}, 0.002f));
      b.collide_box({min(ax, ax - sx * 0.036f), min(ay, ay - sy * 0.036f), 0},
                    {max(ax, ax - sx * 0.036f), max(ay, ay - sy * 0.036f), z});
    }
  const int levels = std::max(2, int(std::lround(z / 0.45f)));
  for (int i = 0; i < levels; ++i) {
    const float at = 0.12f + (z - 0.14f) * float(i) / float(levels - 1),
                step = (z - 0.14f) / float(levels - 1);
    b.show("shelves", board,
           slab({-x + 0.003f, -y + 0.003f, at - 0.010f}, {x - 0.003f, y - 0.003f, at}, 0.001f));
    for (const float sx : {-1.0f, 1.0f})
      b.show("beams", zinc,
             slab({sx * (x - 0.003f) - 0.001f, -y + 0.003f, at - 0.045f},
                  {sx * (x - 0.003f) + 0.001f, y - 0.003f, at + 0.004f}, 0.0005f));
    for (const float sy : {-1.0f, 1.0f})
      b.show("beams", zinc,
             slab({-x + 0.003f, sy * (y - 0.003f) - 0.001f, at - 0.045f},
                  {x - 0.003f, sy * (y - 0.003f) + 0.001f, at + 0.004f}, 0.0005f));
    b.collide_box({-x + 0.002f, -y + 0.002f, at - 0.045f}, {x - 0.002f, y - 0.002f, at});
    if (i + 1 == levels || i % 2 == 1) {
      p.surfaces.push_back({{-x + 0.04f, -y + 0.05f},
                            {x - 0.04f, y - 0.05f},
                            at,
                            i + 1 < levels ? step - 0.05f : 0.6f});
    }
    if (i % 2 == 1) continue;
    const float free = i + 1 < levels ? step - 0.08f : 0.35f;
    if (i + 1 == levels) continue;
    // From one end to the other: cartons, tins.
    float from = -y + 0.05f;
    while (from < y - 0.18f) {
      if (shop.dice.chance(0.6)) {
        const float w = min(float(shop.dice.uniform(0.20, 0.34)), y - 0.05f - from),
                    d = float(shop.dice.uniform(0.7, 0.92)) * x,
                    h = min(free, float(shop.dice.uniform(0.14, 0.26)));
        show_carton(shop, &b, {-d, from, at + 0.001f}, {d, from + w, at + h});
        b.collide_box({-d, from, at}, {d, from + w, at + h});
        from += w + 0.025f;
      } else {
        const float r = 0.05f, h = min(free, 0.125f);
        for (int k = 0; k < 2; ++k)
          for (const float sx : {0.25f, -0.45f})
            show_tin(shop, &b, shop.dice.integer(0, 3),
                     {sx * 2 * x * 0.6f, from + r + 0.11f * float(k), at + 0.0005f}, r, h);
        b.collide_box({-0.45f * 1.2f * x - r, from, at},
                      {0.25f * 1.2f * x + r, from + 0.21f, at + h});
        from += 0.24f;
      }
    }
  }
  b.mass = 10 * z * (0.5 + y) + 12;
  p.front = 0.6f;
  return p;
}

Prop water_heater(Workshop& shop) {
  const Vec3f size = shop.size({0.47f, 0.45f, float(shop.dice.uniform(0.75, 1.1))});
  const float r = std::clamp(size.y, 0.3f, 0.6f) / 2, z = std::clamp(size.z, 0.5f, 1.4f) / 2,
              x = r + 0.02f;
  const std::string white = shop.paint(shop.color({0.90, 0.90, 0.89}), 0.25),
                    dark = shop.plastic({0.25, 0.26, 0.27});
  const std::string copper = shop.metal("brass"), low_plastic = shop.plastic({0.80, 0.80, 0.79});
  Prop p;
  PropPart& b = p.body();
  const float low = -z + 0.10f;
  b.show("tank", white,
         lathe(rounded({{0, low + 0.02f},
                        {r - 0.03f, low + 0.02f},
                        {r, low + 0.045f},
                        {r, z - 0.04f},
                        {r - 0.05f, z - 0.004f},
                        {0, z}},
                       0.02f, 4),
               52)
             .moved(x, 0, 0));
  b.show("cap", low_plastic,
         lathe(rounded({{0, low - 0.01f}, {r * 0.62f, low - 0.01f}, {r * 0.7f, low + 0.022f}},
                       0.01f, 3),
               40)
             .moved(x, 0, 0));
  b.show("seams", dark,
         lathe({{r + 0.0006f, low + 0.075f}, {r + 0.0006f, low + 0.078f}}, 52).moved(x, 0, 0));
  b.show("rails", shop.metal("steel"),
         slab({0, -0.12f, z - 0.22f}, {0.03f, 0.12f, z - 0.18f}, 0.002f) +
             slab({0, -0.12f, low + 0.16f}, {0.03f, 0.12f, low + 0.20f}, 0.002f));
  const Vec3 marks[] = {{0.10, 0.22, 0.60}, {0.62, 0.08, 0.06}};
  for (int i = 0; i < 2; ++i) {
    const float y = i ? 0.07f : -0.07f;
    b.show("pipes", copper,
           tube(smooth_path({{x, y, low - 0.005f},
                             {x, y, -z + 0.06f},
                             {x - 0.05f, y, -z + 0.035f},
                             {0.001f, y, -z + 0.03f}},
                            5),
                0.0085f, 12));
    b.show("ring_" + std::to_string(i), shop.plastic(marks[i]),
           cylinder(0.013f, low - 0.022f, low - 0.008f, 0.002f, 18).moved(x, y, 0));
    b.show("rosettes", shop.metal("chrome"),
           bar({0, y, -z + 0.03f}, {0.008f, y, -z + 0.03f}, 0.026f, 0.022f, 22));
  }
  b.show("valve", shop.metal("chrome"),
         bar({x, -0.07f, low - 0.045f}, {x + 0.05f, -0.07f, low - 0.045f}, 0.012f, 0.010f, 14));
  // Dial and thermometer, on a plate that is bent as the tank is.
  const float front = x + r;
  b.show(
      "plate", dark,
      slab({front - 0.02f, -0.05f, low + 0.10f}, {front + 0.006f, 0.05f, low + 0.24f}, 0.005f, 2));
  b.show("dial", low_plastic, knob(0.026f, 0.016f, {front + 0.005f, 0, low + 0.145f}));
  b.show("gauge", shop.paper({0.90, 0.90, 0.88}),
         knob(0.022f, 0.002f, {front + 0.0055f, 0, low + 0.205f}));
  b.show(
      "needle", shop.paint({0.6, 0.05, 0.04}),
      slab({front + 0.0065f, -0.001f, low + 0.205f}, {front + 0.0085f, 0.001f, low + 0.223f}, 0));
  b.show("cable", low_plastic,
         tube(smooth_path({{x, 0.02f, low - 0.008f},
                           {x - 0.03f, 0.03f, low - 0.06f},
                           {0.04f, 0.10f, -z + 0.12f},
                           {0.006f, 0.15f, -z + 0.14f}},
                          6),
              0.0045f, 8));
  b.collide_cylinder(r, low, z, x, 0);
  b.collide_box({0, -0.12f, low + 0.15f}, {0.06f, 0.12f, z - 0.17f});
  b.collide_box({0, -0.08f, -z + 0.02f}, {x + 0.02f, 0.08f, low});
  b.mass = 18 + 1000 * kPi * (r - 0.04) * (r - 0.04) * (z - low - 0.1);  // steel and water
  return p;
}

Prop fuse_box(Workshop& shop) {
  const Vec3f size = shop.size({0.10f, 0.34f, 0.48f});
  const float x = std::clamp(size.x, 0.07f, 0.2f), y = std::clamp(size.y, 0.25f, 0.8f) / 2,
              z = std::clamp(size.z, 0.25f, 1.2f) / 2;
  const std::string grey = shop.paint(shop.color({0.80, 0.80, 0.78}), 0.4),
                    white = shop.plastic({0.88, 0.88, 0.87}, 0.35),
                    dark = shop.plastic({0.07, 0.07, 0.075});
  Prop p;
  PropPart& b = p.body();
  const float face = x - 0.018f;
  add_carcass(&b, "case", grey, {0, -y, -z}, {face, y, z}, 0.004f);
  b.show("cover", white,
         slab({0.006f, -y + 0.006f, -z + 0.006f}, {face - 0.022f, y - 0.006f, z - 0.006f}, 0.002f));
  b.collide_box({0.006f, -y + 0.006f, -z + 0.006f}, {face - 0.022f, y - 0.006f, z - 0.006f});
  const int rows = std::max(1, int((2 * z - 0.06f) / 0.13f));
  for (int row = 0; row < rows; ++row) {
    const float at = z - 0.09f - (2 * z - 0.10f) / float(rows) * float(row);
    const int count = int((2 * y - 0.06f) / 0.018f);
    b.show("strips", shop.paper({0.90, 0.90, 0.88}),
           slab({face - 0.0225f, -y + 0.03f, at + 0.026f}, {face - 0.0215f, y - 0.03f, at + 0.038f},
                0));
    for (int i = 0; i < count; ++i) {
      const float y0 = -y + 0.03f + 0.018f * float(i);
      const bool wide = row == 0 && i < 4;
      b.show("breakers", shop.plastic({0.76, 0.77, 0.77}, 0.4),
             slab({face - 0.024f, y0 + 0.0004f, at - 0.022f},
                  {face - 0.012f, y0 + 0.0176f, at + 0.022f}, 0));
      if (!wide || i == 1)
        b.show(wide ? "main_lever" : "levers", wide ? shop.plastic({0.10, 0.22, 0.55}) : dark,
               slab({face - 0.013f, y0 + 0.005f, at - 0.002f},
                    {face - 0.004f, y0 + 0.013f, at + 0.008f}, 0));
    }
  }
  b.show("conduits", grey,
         cylinder(0.012f, z - 0.002f, z + 0.09f, 0.001f, 16).moved(0.03f, -0.05f, 0) +
             cylinder(0.016f, z - 0.002f, z + 0.09f, 0.001f, 16).moved(0.03f, 0.04f, 0));
  b.mass = 40.0 * 4 * y * z;
  PropPart& door = p.hang("door", {x, -y, -z}, upright_hinge(1, 2.0, 0.05));
  door.show("door", grey,
            slab({-0.015f, 0.001f, 0.001f}, {0, 2 * y - 0.001f, 2 * z - 0.001f}, 0.004f, 2));
  door.show("lock", shop.metal("black"), knob(0.012f, 0.006f, {0, 2 * y - 0.03f, z}));
  door.show("sign", shop.paint({0.92, 0.74, 0.06}, 0.4),
            extrude({{-0.032f, -0.02f}, {0.032f, -0.02f}, {0, 0.036f}}, 0, 0.0006f)
                .turned(Axis::kX, 90)
                .turned(Axis::kZ, 90)
                .moved(0, y, 2 * z - 0.08f));
  door.show("bolt", shop.paint({0.04, 0.04, 0.04}, 0.4),
            extrude({{-0.004f, 0.018f},
                     {-0.009f, -0.001f},
                     {-0.001f, 0.002f},
                     {-0.003f, -0.014f},
                     {0.008f, 0.006f},
                     {0, 0.004f},
                     {0.004f, 0.018f}},
                    0, 0.0012f)
                .turned(Axis::kX, 90)
                .turned(Axis::kZ, 90)
                .moved(0, y, 2 * z - 0.082f));
  door.collide_box({-0.015f, 0, 0}, {0, 2 * y, 2 * z});
  door.mass = 7800.0 * 0.0012 * 4 * y * z + 0.1;
  p.front = 0.6f;
  return p;
}

constexpr PropKind kUtility[] = {
    {"shelf_unit", shelf_unit, "metal shelves with cartons and tins"},
    {"water_heater", water_heater, "electric water heater on a wall"},
    {"fuse_box", fuse_box, "fuse box on a wall, with a hinged door"},
};

}  // namespace

PropFamily utility() { return kUtility; }

}  // namespace gloam
