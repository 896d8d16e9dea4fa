// Furniture and fittings of offices.

#include <fmt/format.h>

#include <cmath>

#include "places/canvas.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

Prop meeting_table(Workshop& shop) {
  const Vec3f size = limited(shop.size({1.1f, float(shop.dice.uniform(1.8, 3.2)), 0.74f}),
                             {0.8f, 1.2f, 0.7f}, {1.5f, 4.5f, 0.78f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, top = 0.026f;
  Prop p;
  PropPart& b = p.body();
  b.show(
      "top", shop.wood(Axis::kY),
      extrude(rounded_rectangle(size.x, size.y, 0.09f, 6), z - top, z - 0.0015f) +
          extrude(rounded_rectangle(size.x - 0.004f, size.y - 0.004f, 0.088f, 6), z - 0.0015f, z));
  const std::string steel = shop.metal("black");
  for (const float end : {-1.0f, 1.0f}) {
    const float at = end * (y - 0.32f), foot = x - 0.16f;
    // A frame of square tube: two feet, two uprights, a rail below the top.
    b.show("frame", steel, beam({-foot, at, 0.02f}, {foot, at, 0.02f}, 0.06f, 0.03f, 0.004f));
    for (const float side : {-1.0f, 1.0f}) {
      b.show("frame", steel,
             beam({side * (foot - 0.10f), at, 0.03f}, {side * (foot - 0.10f), at, z - top}, 0.05f,
                  0.05f, 0.004f));
      b.show("glides", shop.rubber(),
             cylinder(0.02f, 0, 0.006f).moved(side * (foot - 0.05f), at, 0));
      b.collide_box({side * (foot - 0.10f) - 0.025f, at - 0.025f, 0.035f},
                    {side * (foot - 0.10f) + 0.025f, at + 0.025f, z - top});
    }
    b.show("frame", steel,
           beam({-foot, at, z - top - 0.02f}, {foot, at, z - top - 0.02f}, 0.05f, 0.04f, 0.004f));
    b.collide_box({-foot, at - 0.03f, 0}, {foot, at + 0.03f, 0.035f});
  }
  b.show("beam", steel,
         beam({0, -y + 0.32f, z - top - 0.02f}, {0, y - 0.32f, z - top - 0.02f}, 0.05f, 0.04f));
  // Sockets in a lid in the middle.
  b.show("lid", shop.metal("aluminium"),
         slab({-0.05f, -0.14f, z}, {0.05f, 0.14f, z + 0.0025f}, 0.001f));
  b.collide_box({-x, -y, z - top}, {x, y, z});
  b.mass = 700.0 * double(size.x * size.y * top) + 24;  // chipboard; frames of 12 kg
  p.surfaces.push_back({{-x + 0.06f, 0.18f}, {x - 0.06f, y - 0.06f}, z});
  p.surfaces.push_back({{-x + 0.06f, -y + 0.06f}, {x - 0.06f, -0.18f}, z});
  return p;
}

Image8 paint_whiteboard(uint64_t seed, int columns, int rows) {
  Canvas c(columns, rows, {0.93, 0.94, 0.94});
  Dice dice(seed, "whiteboard");
  const float wide = float(columns) / float(rows);
  const auto ink = [&] {
    return dice.pick<Vec3>(
        {{0.10, 0.14, 0.40}, {0.08, 0.08, 0.09}, {0.62, 0.10, 0.10}, {0.06, 0.36, 0.16}});
  };
  // Notes in columns, a drawing of boxes and arrows, and what was wiped away.
  for (int i = 0; i < 5; ++i) {
    const float x = float(dice.uniform(0, double(wide))), y = float(dice.uniform(0.1, 0.9));
    c.line({x, y}, {x + float(dice.uniform(-0.3, 0.3)), y + float(dice.uniform(-0.1, 0.1))}, 0.05f,
           {0.905, 0.915, 0.925});
  }
  float x = 0.08f;
  while (x < wide - 0.35f) {
    const Vec3 color = ink();
    if (dice.chance(0.45)) {
      float y = 0.86f;
      const int lines = dice.integer(3, 8);
      for (int i = 0; i < lines; ++i, y -= 0.085f)
        c.bars({x, y}, {x + float(dice.uniform(0.2, 0.5)), y + 0.035f}, dice.seed(), color, true);
      x += 0.6f;
    } else {
      Vec2f before{};
      const int boxes = dice.integer(2, 4);
      for (int i = 0; i < boxes; ++i) {
        const Vec2f a{x + float(dice.uniform(0, 0.35)), 0.82f - 0.2f * float(i)};
        const Vec2f z{a.x + 0.22f, a.y - 0.11f};
        for (const auto& [p, q] : {std::pair<Vec2f, Vec2f>{a, {z.x, a.y}},
                                   {{z.x, a.y}, z},
                                   {z, {a.x, z.y}},
                                   {{a.x, z.y}, a}})
          c.line(p, q, 0.006f, color);
        c.bars({a.x + 0.03f, z.y + 0.04f}, {z.x - 0.03f, a.y - 0.04f}, dice.seed(), color, true);
        if (i > 0) c.line(before, {a.x + 0.1f, a.y}, 0.005f, color);
        before = {a.x + 0.1f, z.y};
      }
      x += 0.75f;
    }
  }
  return c.image();
}

Prop whiteboard(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.02f, shop.dice.pick({1.2f, 1.5f, 1.8f}), 0.95f}),
                             {0, 0.5f, 0.4f}, {1, 4, 1.4f});
  const float y = size.y / 2, h = size.z / 2;
  Prop p;
  PropPart& b = p.body();
  const uint64_t seed = shop.dice.seed();
  const int rows = 400, columns = int(std::lround(400 * size.y / size.z));
  b.show("board",
         shop.picture(
             fmt::format("whiteboard_{:016x}_{}", seed, columns),
             [=] { return paint_whiteboard(seed, columns, rows); }, 0.12),
         panel(size.y - 0.02f, size.z - 0.02f).moved(0.012f, 0, 0));
  const std::string frame = shop.metal("aluminium");
  for (const float side : {-1.0f, 1.0f}) {
    b.show("frame", frame,
           slab({0, side * (y - 0.006f) - 0.008f, -h}, {0.018f, side * (y - 0.006f) + 0.008f, h},
                0.003f));
    b.show("frame", frame,
           slab({0, -y, side * (h - 0.006f) - 0.008f}, {0.018f, y, side * (h - 0.006f) + 0.008f},
                0.003f));
  }
  b.show("back", shop.metal("galvanised"),
         slab({0, -y + 0.01f, -h + 0.01f}, {0.011f, y - 0.01f, h - 0.01f}, 0));
  // A tray with pens and a sponge.
  b.show("frame", frame,
         plate_y({{0.014f, -h - 0.012f},
                  {0.075f, -h - 0.012f},
                  {0.075f, -h - 0.002f},
                  {0.072f, -h - 0.009f},
                  {0.014f, -h - 0.009f}},
                 -0.22f, 0.22f));
  int pen = 0;
  for (const Vec3 color :
       {Vec3{0.10, 0.14, 0.40}, Vec3{0.62, 0.10, 0.10}, Vec3{0.08, 0.08, 0.09}}) {
    const float at = -0.16f + 0.11f * float(pen++);
    const Solid body = cylinder(0.007f, 0, 0.10f, 0.002f, 10),
                cap = cylinder(0.0078f, 0.095f, 0.135f, 0.002f, 10);
    b.show("pens", shop.plastic({0.86, 0.86, 0.86}),
           body.turned(Axis::kX, -90).moved(0.045f, at, -h - 0.002f));
    b.show(fmt::format("cap_{}", pen), shop.plastic(color),
           cap.turned(Axis::kX, -90).moved(0.045f, at, -h - 0.002f));
  }
  b.show("sponge", shop.fabric({0.20, 0.22, 0.26}),
         slab({0.022f, 0.175f, -h - 0.009f}, {0.066f, 0.215f, -h + 0.022f}, 0.006f, 2));
  b.collide_box({0, -y, -h}, {0.018f, y, h});
  b.collide_box({0, -0.22f, -h - 0.012f}, {0.075f, 0.22f, -h});
  b.mass = 7.5 * size.y * size.z;  // steel sheet over cardboard
  return p;
}

Prop desk_screen(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.03f, 1.6f, 1.25f}), {0.025f, 0.6f, 0.9f}, {0.06f, 8, 2});
  const float x = size.x / 2, y = size.y / 2, z = size.z;
  Prop p;
  PropPart& b = p.body();
  const int count = std::max(1, int(std::lround(size.y / 1.6f)));
  const float wide = size.y / float(count);
  const std::string cloth = shop.fabric(shop.color(shop.style.accent), 0.0022);
  for (int i = 0; i < count; ++i) {
    const float y0 = -y + wide * float(i);
    b.show("cloth", cloth, slab({-x, y0 + 0.004f, 0.06f}, {x, y0 + wide - 0.004f, z}, 0.008f, 3));
  }
  for (int i = 0; i <= count; ++i) {
    const float at = std::clamp(-y + wide * float(i), -y + 0.015f, y - 0.015f);
    b.show("posts", shop.metal("steel"),
           slab({-x * 0.9f, at - 0.012f, 0}, {x * 0.9f, at + 0.012f, 0.10f}, 0.002f));
  }
  b.collide_box({-x, -y, 0}, {x, y, z});
  b.mass = 9.0 * size.y * size.z;
  return p;
}

Prop filing_cabinet(Workshop& shop) {
  const Vec3f size = limited(shop.size({0.62f, 0.46f, shop.dice.pick({0.73f, 1.02f, 1.32f})}),
                             {0.4f, 0.35f, 0.5f}, {0.8f, 1, 1.6f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, plinth = 0.05f, wall = 0.012f;
  Prop p;
  PropPart& b = p.body();
  const std::string steel = shop.paint(
      shop.color(
          shop.dice.pick<Vec3>({{0.70, 0.71, 0.71}, {0.30, 0.32, 0.34}, {0.84, 0.83, 0.80}})),
      0.45);
  const float face = x - 0.018f;
  for (const float side : {-1.0f, 1.0f})
    b.show("case", steel,
           slab({-x, side * (y - wall / 2) - wall / 2, plinth},
                {face, side * (y - wall / 2) + wall / 2, z}, 0.002f));
  b.show("case", steel, slab({-x, -y, z - wall}, {face + 0.01f, y, z}, 0.003f));
  b.show("case", steel, slab({-x, -y + wall, plinth}, {face, y - wall, plinth + wall}, 0));
  b.show("case", steel, slab({-x, -y + wall, plinth + wall}, {-x + 0.004f, y - wall, z - wall}, 0));
  b.show("plinth", shop.paint({0.10, 0.10, 0.11}),
         slab({-x + 0.01f, -y + 0.015f, 0}, {face - 0.02f, y - 0.015f, plinth}, 0.002f));
  b.collide_box({-x, -y, 0}, {face - 0.02f, y, plinth + wall});
  b.collide_box({-x, -y, z - wall}, {face, y, z});
  for (const float side : {-1.0f, 1.0f})
    b.collide_box({-x, side * (y - wall / 2) - wall / 2, plinth + wall},
                  {face, side * (y - wall / 2) + wall / 2, z - wall});
  b.collide_box({-x, -y + wall, plinth + wall}, {-x + wall, y - wall, z - wall});
  const int drawers = std::max(2, int(std::lround((z - plinth) / 0.31f)));
  const float low = plinth + wall, step = (z - wall - low) / float(drawers);
  const FrontLook look{steel, shop.metal("aluminium"), 0};
  for (int i = 0; i < drawers; ++i)
    add_drawer(&p, shop, fmt::format("drawer_{}", i + 1), face, {-y, low + step * float(i)},
               {y, low + step * float(i + 1)}, size.x - 0.06f, look);
  b.mass = 14 + 22.0 * z;  // sheet steel of 0.8 mm
  p.front = 0.5f;
  p.surfaces.push_back({{-x + 0.03f, -y + 0.03f}, {face - 0.03f, y - 0.03f}, z});
  return p;
}

Prop copier(Workshop& shop) {
  // A floor-standing multifunction printer: cassettes, an engine, a scanner with its lid, a panel.
  Prop p;
  PropPart& b = p.body();
  const std::string light = shop.plastic({0.80, 0.80, 0.79}, 0.45),
                    dark = shop.plastic({0.16, 0.17, 0.18}, 0.4);
  const float x = 0.31f, y = 0.30f;
  b.show("base", dark,
         slab({-x + 0.01f, -y + 0.01f, 0.03f}, {x - 0.01f, y - 0.01f, 0.09f}, 0.006f));
  for (const float i : {-1.0f, 1.0f})
    for (const float j : {-1.0f, 1.0f})
      add_caster(&b, &shop, i * (x - 0.06f), j * (y - 0.06f), 0.035f, 0.014f);
  for (int i = 0; i < 4; ++i) {
    const float z0 = 0.095f + 0.105f * float(i);
    b.show("case", light, slab({-x, -y, z0}, {x - 0.006f, y, z0 + 0.102f}, 0.006f));
    b.show("front", light,
           slab({x - 0.008f, -y + 0.004f, z0 + 0.003f}, {x, y - 0.004f, z0 + 0.099f}, 0.005f, 2));
    b.show("grips", dark,
           slab({x - 0.001f, -0.09f, z0 + 0.060f}, {x + 0.001f, 0.09f, z0 + 0.085f}, 0.0005f));
  }
  b.show("case", light, slab({-x, -y, 0.517f}, {x, y, 0.70f}, 0.012f, 2));
  // The tray where sheets come out, between engine and scanner.
  b.show("tray", dark, slab({-x + 0.02f, -y, 0.70f}, {x - 0.06f, y - 0.10f, 0.715f}, 0.003f));
  b.show("case", light, slab({-x, -y, 0.70f}, {-x + 0.08f, y, 0.90f}, 0.008f));
  b.show("case", light, slab({-x, y - 0.10f, 0.70f}, {x, y, 0.90f}, 0.008f));
  b.show("sheets", shop.paper({0.90, 0.90, 0.89}),
         slab({-0.14f, -0.22f, 0.7155f}, {0.16f, -0.01f, 0.721f}, 0));
  b.show("scanner", light, slab({-x, -y, 0.90f}, {x, y, 0.965f}, 0.010f, 2));
  b.show("lid", light,
         slab({-x + 0.01f, -y + 0.005f, 0.968f}, {x - 0.03f, y - 0.005f, 1.05f}, 0.022f, 3));
  b.show("feeder", dark, slab({-x + 0.06f, -0.17f, 1.05f}, {0.02f, 0.17f, 1.058f}, 0.003f));
  b.show(
      "panel", dark,
      slab({x - 0.01f, -0.13f, 0.90f}, {x + 0.06f, 0.13f, 0.925f}, 0.005f, 2).turned(Axis::kY, 0));
  b.show("screen", shop.glow({0.32, 0.46, 0.60}, 180),
         slab({x + 0.004f, -0.085f, 0.9252f}, {x + 0.05f, 0.085f, 0.9258f}, 0));
  b.collide_box({-x, -y, 0.021f}, {x, y, 0.715f});
  b.collide_box({-x, -y, 0.90f}, {x, y, 1.055f});
  b.collide_box({-x, -y, 0.715f}, {-x + 0.08f, y, 0.90f});
  b.collide_box({-x, y - 0.10f, 0.715f}, {x, y, 0.90f});
  b.collide_box({x, -0.13f, 0.90f}, {x + 0.06f, 0.13f, 0.925f});
  b.collide_box({-x + 0.03f, -y + 0.03f, 0}, {x - 0.03f, y - 0.03f, 0.021f});
  b.mass = 84;
  p.front = 0.6f;
  return p;
}

Prop panel_lamp(Workshop& shop) {
  // LED panel for grids of 60 x 60 cm, 3,600 lm (EN 12464-1 asks for 500 lx on desks).
  const float edge = limited(shop.size({0.6f, 0.6f, 0.03f}), {0.3f, 0.3f, 0}, {1.2f, 1.2f, 1}).x,
              h = edge / 2;
  Prop p;
  PropPart& b = p.body();
  const std::string rim = shop.paint({0.88, 0.88, 0.87});
  for (const float s : {-1.0f, 1.0f}) {
    b.show("rim", rim,
           slab({s * (h - 0.0075f) - 0.0075f, -h, -0.012f}, {s * (h - 0.0075f) + 0.0075f, h, 0},
                0.002f));
    b.show("rim", rim,
           slab({-h + 0.015f, s * (h - 0.0075f) - 0.0075f, -0.012f},
                {h - 0.015f, s * (h - 0.0075f) + 0.0075f, 0}, 0.002f));
  }
  b.show("cover", shop.plastic({0.86, 0.86, 0.85}, 0.5),
         slab({-h + 0.015f, -h + 0.015f, -0.009f}, {h - 0.015f, h - 0.015f, -0.001f}, 0));
  b.collide_box({-h, -h, -0.012f}, {h, h, 0});
  b.mass = 2.4;
  LightOptions light;
  light.type = LightType::kRect;
  light.position = {0, 0, -0.0095};
  light.size = {double(edge) - 0.032, double(edge) - 0.032};
  light.flux = 3600;
  light.temperature = 4000;
  p.lights.push_back(std::move(light));
  return p;
}

constexpr PropKind kOffices[] = {
    {"meeting_table", meeting_table, "table for meetings on two frames"},
    {"whiteboard", whiteboard, "board with notes and pens, on a wall"},
    {"desk_screen", desk_screen, "cloth partition between desks"},
    {"filing_cabinet", filing_cabinet, "steel cabinet; its drawers slide"},
    {"copier", copier, "floor-standing copier"},
    {"panel_lamp", panel_lamp, "square LED panel under the ceiling"},
};

}  // namespace

PropFamily offices() { return kOffices; }

}  // namespace gloam
