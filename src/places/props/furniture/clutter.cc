// Small things in rooms: things to read, to play with, remote controls.

#include <fmt/format.h>

#include <cmath>

#include "places/props/furniture/art.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

Prop book_stack(Workshop& shop) {
  Dice& dice = shop.dice;
  const int count = dice.integer(2, 5);
  Prop p;
  PropPart& b = p.body();
  float z = 0, deep = 0.21f, tall = 0.29f;
  double mass = 0;
  float turned = 0;
  for (int i = 0; i < count; ++i) {
    const float thick = float(dice.uniform(0.018, 0.042));
    const float angle = i == 0 ? 0 : std::clamp(turned + float(dice.uniform(-9, 9)), -14.0f, 14.0f);
    turned = angle;
    show_book(&b, shop, {deep, thick, tall}, {0, 0, z}, 0, angle, dice.integer(0, kBookTints - 1),
              true);
    b.collide_box({0, 0, z + thick / 2}, {deep / 2, tall / 2, thick / 2},
                  turn({0, 0, 1}, double(angle) * M_PI / 180));
    z += thick;
    mass += 750.0 * double(deep * tall * thick);  // paper, loosely: 750 kg/m³
    deep *= float(dice.uniform(0.84, 1.0)), tall *= float(dice.uniform(0.84, 1.0));
  }
  b.mass = mass;
  p.surfaces.push_back({{-0.3f * deep, -0.3f * tall}, {0.3f * deep, 0.3f * tall}, z});
  p.loose = true;
  return p;
}

Prop magazine(Workshop& shop) {
  Dice& dice = shop.dice;
  const float thick = float(dice.uniform(0.004, 0.008)), d = 0.105f, h = 0.1425f;
  const uint64_t seed = dice.seed();
  Prop p;
  PropPart& b = p.body();
  b.show(
      "pages", shop.paper({0.84, 0.83, 0.80}),
      slab({-d + 0.0005f, -h + 0.0005f, 0.0004f}, {d - 0.0008f, h - 0.0005f, thick - 0.0004f}, 0));
  b.show("covers", shop.plastic({0.78, 0.77, 0.75}, 0.25),
         slab({-d, -h, 0}, {d, h, 0.0005f}, 0) + slab({-d, -h, 0}, {-d + 0.0006f, h, thick}, 0));
  // The title's page, a little curled at its free edge; read from +y.
  Path points;
  for (int i = 0; i <= 1; ++i)
    for (int j = 0; j <= 10; ++j) {
      const float u = float(j) / 10;
      points.push_back(
          {-d + 2 * d * u, -h + 2 * h * float(i), thick + 0.0002f + 0.004f * std::pow(u, 4.0f)});
    }
  b.show("cover",
         shop.picture(
             fmt::format("cover_{:016x}", seed), [=] { return paint_cover(seed, 180, 244); }, 0.25),
         sheet(points, 11, 0.0002f));
  b.collide_box({-d, -h, 0}, {d, h, thick + 0.001f});
  b.mass = 1000.0 * double(4 * d * h * thick);
  p.loose = true;
  return p;
}

Prop remote_control(Workshop& shop) {
  Dice& dice = shop.dice;
  Prop p;
  PropPart& b = p.body();
  b.show("case",
         shop.plastic(dice.chance(0.8) ? Vec3{0.11, 0.11, 0.113} : Vec3{0.66, 0.66, 0.66}, 0.4),
         slab({-0.085f, -0.022f, 0}, {0.085f, 0.022f, 0.017f}, 0.006f, 3));
  const std::string grey = shop.rubber({0.30, 0.30, 0.31});
  for (int i = 0; i < 4; ++i)
    for (const float y : {-0.0125f, 0.0f, 0.0125f})
      b.show("keys", grey,
             slab({-0.066f + 0.014f * float(i) - 0.0045f, y - 0.0042f, 0.016f},
                  {-0.066f + 0.014f * float(i) + 0.0045f, y + 0.0042f, 0.0188f}, 0.0014f));
  b.show(
      "keys", grey,
      lathe(rounded({{0.0145f, 0.0165f}, {0.014f, 0.0188f}, {0.0075f, 0.0185f}, {0.0075f, 0.0165f}},
                    0.0008f, 2),
            32)
              .moved(0.016f, 0, 0) +
          cylinder(0.0058f, 0.0165f, 0.0188f, 0.0008f, 20).moved(0.016f, 0, 0));
  for (const float y : {-0.012f, 0.012f})
    b.show("keys", grey,
           slab({0.038f, y - 0.0045f, 0.016f}, {0.060f, y + 0.0045f, 0.0190f}, 0.002f));
  b.show("power", shop.rubber({0.60, 0.08, 0.06}),
         cylinder(0.0045f, 0.0165f, 0.0188f, 0.001f, 18).moved(0.072f, 0.010f, 0));
  b.show("window", shop.plastic({0.05, 0.01, 0.01}, 0.1),
         slab({0.0835f, -0.010f, 0.005f}, {0.0856f, 0.010f, 0.012f}, 0.0008f));
  b.collide_box({-0.085f, -0.022f, 0}, {0.085f, 0.022f, 0.017f});
  b.mass = 0.12;
  p.loose = true;
  return p;
}

Prop toy_ball(Workshop& shop) {
  Dice& dice = shop.dice;
  const float r =
      limited(shop.size({2 * float(dice.uniform(0.07, 0.12)), 0, 0}), {0.05f, 0, 0}, {0.6f, 10, 10})
          .x /
      2;
  Prop p;
  PropPart& b = p.body();
  // Six gores in two or three colours, meeting at two caps.
  const Vec3 tints[4] = {
      shop.color({0.75, 0.14, 0.09}), {0.86, 0.84, 0.78}, {0.12, 0.30, 0.55}, {0.88, 0.66, 0.14}};
  const int first = 0, second = dice.integer(1, 3);
  constexpr int kGores = 8, kAcross = 6, kUp = 24;
  const auto turned = [&](const Solid& s) {
    return s.turned(Axis::kX, 62).turned(Axis::kZ, 25).moved(0, 0, r);
  };
  const auto at = [&](float polar, float around, float radius) {
    return Vec3f{std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                 -std::cos(polar)} *
           radius;
  };
  for (int g = 0; g < kGores; ++g) {
    Path points;
    for (int i = 0; i <= kUp; ++i)
      for (int j = 0; j <= kAcross; ++j)
        points.push_back(at(kPi * (0.06f + 0.88f * float(i) / kUp),
                            2 * kPi * (float(g) + float(j) / kAcross) / kGores, r));
    TriangleMesh mesh = sheet(points, kAcross + 1).mesh();
    for (size_t i = 0; i < mesh.positions.size(); ++i) mesh.normals[i] = mesh.positions[i] / r;
    const int tint = g % 2 ? second : first;
    b.show(fmt::format("gores_{}", tint), shop.plastic(tints[tint], 0.35),
           turned(Solid(std::move(mesh))));
  }
  Profile cap;
  for (int i = 0; i <= 6; ++i)
    cap.push_back({r * std::sin(kPi * 0.065f * float(i) / 6),
                   -r * std::cos(kPi * 0.065f * float(i) / 6) * 1.0006f});
  const Solid low = lathe(cap, 32);
  b.show("caps", shop.plastic(tints[1], 0.35), turned(low) + turned(low.turned(Axis::kX, 180)));
  b.collide_sphere({0, 0, r}, r);
  b.mass = 0.25 * double(r * r / 0.0121f);
  p.loose = true;
  return p;
}

Prop toy_block(Workshop& shop) {
  Dice& dice = shop.dice;
  const float e = limited(shop.size({float(dice.pick({0.115, 0.125, 0.135})), 0, 0}),
                          {0.025f, 0, 0}, {0.12f, 10, 10})
                      .x;
  Prop p;
  PropPart& b = p.body();
  b.show("wood", shop.wood("birch", Axis::kX),
         rounded_box({e, e, e}, 0.06f * e, 2).moved(0, 0, e / 2));
  // A painted inlay on each face, with a mark of strokes.
  const Vec3 tints[] = {
      {0.72, 0.14, 0.09}, {0.12, 0.32, 0.58}, {0.86, 0.62, 0.10}, {0.16, 0.44, 0.22}};
  const int tint = dice.integer(0, 3), mark = dice.integer(0, 3);
  const std::string ink = shop.paint(shop.color(tints[tint]), 0.45);
  for (int side = 0; side < 6; ++side) {
    const auto face = [&](const Solid& s) {  // from the plane x = 0 that faces +x
      const Solid out = s.moved(e / 2, 0, 0);
      return (side < 4 ? out.turned(Axis::kZ, 90.0f * float(side))
                       : out.turned(Axis::kY, side == 4 ? 90.0f : -90.0f))
          .moved(0, 0, e / 2);
    };
    const float t = 0.0004f, in = 0.40f * e, w = 0.035f * e;
    for (const float s : {-1.0f, 1.0f}) {
      if (side == 5 || side == 4) continue;  // it stands on one, the other stays bare
      b.show("print", ink,
             face(slab({-0.0001f, -in, s * in - w}, {t, in, s * in + w}, 0)) +
                 face(slab({-0.0001f, s * in - w, -in}, {t, s * in + w, in}, 0)));
    }
    if (side >= 4) continue;
    const Solid mark_solid =
        mark == 0 ? extrude(circle(0.24f * e, 28), 0, t)
        : mark == 1
            ? extrude({{-0.24f * e, -0.22f * e}, {0.24f * e, -0.22f * e}, {0, 0.26f * e}}, 0, t)
        : mark == 2 ? extrude(rounded_rectangle(0.42f * e, 0.42f * e, 0.05f * e), 0, t)
                    : extrude({{-0.08f * e, -0.26f * e},
                               {0.08f * e, -0.26f * e},
                               {0.08f * e, -0.08f * e},
                               {0.26f * e, -0.08f * e},
                               {0.26f * e, 0.08f * e},
                               {0.08f * e, 0.08f * e},
                               {0.08f * e, 0.26f * e},
                               {-0.08f * e, 0.26f * e},
                               {-0.08f * e, 0.08f * e},
                               {-0.26f * e, 0.08f * e},
                               {-0.26f * e, -0.08f * e},
                               {-0.08f * e, -0.08f * e}},
                              0, t);
    // Extruded along z: its y becomes up, its z the outward normal.
    b.show("print", ink, face(mark_solid.turned(Axis::kX, 90).turned(Axis::kZ, 90)));
  }
  b.collide_box({-e / 2, -e / 2, 0}, {e / 2, e / 2, e});
  b.mass = 620.0 * double(e * e * e);  // beech and birch
  p.loose = true;
  return p;
}

constexpr PropKind kClutter[] = {
    {"book_stack", book_stack, "two to five books in a pile"},
    {"magazine", magazine, "magazine with a picture on its cover"},
    {"remote_control", remote_control, "remote control of a television"},
    {"toy_ball", toy_ball, "ball in gores of two colours"},
    {"toy_block", toy_block, "wooden building block with prints"},
};

}  // namespace

PropFamily clutter() { return kClutter; }

}  // namespace gloam
