// Things on walls and sills: pictures, mirrors, clocks, vases.

#include <fmt/format.h>

#include <cmath>

#include "places/props/furniture/art.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// Four rails about an opening of half extents y, z on the wall, `wide` and `deep`, mitred by their
// look: grain along each.
void show_frame(PropPart* b, const std::string& along_y, const std::string& along_z, float y,
                float z, float wide, float deep) {
  for (const float s : {-1.0f, 1.0f}) {
    const float cz = s * (z - wide / 2), cy = s * (y - wide / 2);
    b->show("frame", along_y, slab({0, -y, cz - wide / 2}, {deep, y, cz + wide / 2}, 0.003f, 2));
    b->show(
        along_y == along_z ? "frame" : "frame_sides", along_z,
        slab({0, cy - wide / 2, -z + wide}, {deep - 0.0005f, cy + wide / 2, z - wide}, 0.003f, 2));
  }
}

Prop picture(Workshop& shop) {
  Dice& dice = shop.dice;
  const bool tall = dice.chance(0.55);
  const float edge = float(dice.uniform(0.4, 0.8));
  const Vec3f size = limited(
      shop.size(tall ? Vec3f{0.024f, 0.8f * edge, edge} : Vec3f{0.024f, 1.25f * edge, edge * 0.9f}),
      {0.018f, 0.12f, 0.12f}, {0.04f, 2.0f, 2.0f});
  const float y = size.y / 2, z = size.z / 2, d = size.x;
  Prop p;
  PropPart& b = p.body();
  const int finish = dice.integer(0, 2);
  const std::string fy = finish == 0   ? shop.wood(Axis::kY)
                         : finish == 1 ? shop.metal("black")
                                       : shop.paint({0.85, 0.84, 0.81}),
                    fz = finish == 0 ? shop.wood(Axis::kZ) : fy;
  const float wide = float(dice.uniform(0.014, 0.026));
  show_frame(&b, fy, fz, y, z, wide, d);
  const float mount = dice.chance(0.6) ? min(0.07f, 0.22f * min(y, z)) : 0.0f;
  if (mount > 0)
    b.show("mount", shop.paper({0.88, 0.87, 0.84}),
           slab({0.002f, -y + wide, -z + wide}, {d - 0.010f, y - wide, z - wide}, 0));
  const float w = 2 * (y - wide - mount), h = 2 * (z - wide - mount);
  const uint64_t seed = dice.seed();
  const int rows = 240, columns = std::clamp(int(std::lround(240 * w / h)), 60, 960);
  b.show("art",
         shop.picture(
             fmt::format("art_{:016x}_{}", seed, columns),
             [=] { return paint_art(seed, columns, rows); }, 0.7),
         panel(w, h).moved(d - 0.009f, 0, 0));
  b.show("backing", shop.paper({0.45, 0.36, 0.26}),
         slab({0.0005f, -y + 0.004f, -z + 0.004f}, {0.003f, y - 0.004f, z - 0.004f}, 0));
  b.collide_box({0, -y, -z}, {d, y, z});
  b.mass = 0.4 + 5.0 * double(size.y * size.z);
  return p;
}

Prop wall_mirror(Workshop& shop) {
  Dice& dice = shop.dice;
  const bool round = dice.chance(0.4);
  const float usual = float(dice.uniform(0.5, 0.8));
  const Vec3f size = limited(
      shop.size(round ? Vec3f{0.03f, usual, usual} : Vec3f{0.03f, 0.8f * usual, 1.6f * usual}),
      {0.02f, 0.2f, 0.2f}, {0.06f, 1.5f, 2.0f});
  const float y = size.y / 2, z = size.z / 2, d = size.x;
  Prop p;
  PropPart& b = p.body();
  if (round) {
    const float r = min(y, z);
    const std::string rim = dice.chance(0.5) ? shop.metal("brass") : shop.metal("black");
    b.show(
        "frame", rim,
        lathe(rounded({{r - 0.016f, 0}, {r, 0}, {r, d}, {r - 0.014f, d}, {r - 0.016f, d - 0.008f}},
                      0.004f, 3),
              64)
            .turned(Axis::kY, 90));
    b.show("glass", shop.mirror(),
           cylinder(r - 0.014f, 0.004f, d - 0.008f, 0.0005f, 64).turned(Axis::kY, 90));
    b.collide_cylinder({0, 0, 0}, {d, 0, 0}, r);
  } else {
    show_frame(&b, shop.wood(Axis::kY), shop.wood(Axis::kZ), y, z, 0.032f, d);
    b.show("backing", shop.paper({0.45, 0.36, 0.26}),
           slab({0.0005f, -y + 0.005f, -z + 0.005f}, {0.004f, y - 0.005f, z - 0.005f}, 0));
    b.show("glass", shop.mirror(),
           slab({0.004f, -y + 0.03f, -z + 0.03f}, {d - 0.010f, y - 0.03f, z - 0.03f}, 0));
    b.collide_box({0, -y, -z}, {d, y, z});
  }
  b.mass = 1 + 13.0 * double(size.y * size.z);  // glass of 4 mm is 10 kg/m²
  return p;
}

Prop wall_clock(Workshop& shop) {
  Dice& dice = shop.dice;
  const float r = limited(shop.size({0.04f, float(dice.uniform(0.26, 0.36)), 0}), {0, 0.15f, 0},
                          {10, 0.6f, 10})
                      .y /
                  2,
              d = 0.042f;
  Prop p;
  PropPart& b = p.body();
  const Vec3 tints[] = {{0.135, 0.135, 0.14}, {0.82, 0.81, 0.78}, {0.16, 0.30, 0.32}};
  b.show("case",
         dice.chance(0.4) ? shop.wood(Axis::kZ)
                          : shop.plastic(shop.color(tints[dice.integer(0, 2)]), 0.3),
         lathe(rounded({{0, 0}, {r, 0}, {r, d - 0.004f}, {0.92f * r, d}, {0.9f * r, d - 0.012f}},
                       0.006f, 3),
               56)
             .turned(Axis::kY, 90));
  const auto facing = [&](const Solid& s, float x) {
    return s.turned(Axis::kY, 90).moved(x, 0, 0);
  };
  b.show("dial", shop.paper({0.90, 0.89, 0.86}),
         facing(cylinder(0.91f * r, -0.003f, 0, 0.0005f, 56), d - 0.012f));
  const std::string ink = shop.plastic({0.105, 0.105, 0.107}, 0.5);
  for (int k = 0; k < 60; ++k) {
    const bool hour = k % 5 == 0;
    const float w = hour ? 0.014f * r / 0.15f : 0.004f * r / 0.15f,
                len = hour ? 0.11f * r : 0.05f * r;
    b.show("marks", ink,
           slab({d - 0.0119f, -w / 4, 0.86f * r - len}, {d - 0.0114f, w / 4, 0.86f * r}, 0)
               .turned(Axis::kX, -6.0f * float(k)));
  }
  const float minutes = float(dice.integer(0, 719));
  // From the front the hands turn clockwise: about -x.
  b.show("hands", ink,
         slab({d - 0.0100f, -0.022f * r, -0.10f * r}, {d - 0.0090f, 0.022f * r, 0.50f * r}, 0)
                 .turned(Axis::kX, -0.5f * minutes) +
             slab({d - 0.0085f, -0.015f * r, -0.12f * r}, {d - 0.0075f, 0.015f * r, 0.76f * r}, 0)
                 .turned(Axis::kX, -6.0f * std::fmod(minutes, 60.0f)) +
             facing(cylinder(0.04f * r, -0.004f, 0.001f, 0.0008f, 20), d - 0.007f));
  b.show("second_hand", shop.paint({0.70, 0.10, 0.07}),
         slab({d - 0.0070f, -0.005f * r, -0.18f * r}, {d - 0.0064f, 0.005f * r, 0.82f * r}, 0)
             .turned(Axis::kX, float(dice.uniform(0, 360))));
  b.collide_cylinder({0, 0, 0}, {d, 0, 0}, r);
  b.mass = 0.7 * double(r / 0.15f);
  return p;
}

Prop vase(Workshop& shop) {
  Dice& dice = shop.dice;
  const float h = limited(shop.size({0.14f, 0.14f, float(dice.uniform(0.18, 0.32))}), {0, 0, 0.08f},
                          {10, 10, 0.7f})
                      .z;
  const int form = dice.integer(0, 2);
  const float k = h / 0.25f;
  const Profile forms[3] = {{{0, 0.01f},
                             {0.03f, 0.0f},
                             {0.045f, 0},
                             {0.078f, 0.10f},
                             {0.028f, 0.20f},
                             {0.038f, 0.25f},
                             {0.034f, 0.25f},
                             {0.023f, 0.20f},
                             {0.07f, 0.10f},
                             {0.04f, 0.006f},
                             {0, 0.006f}},
                            {{0, 0.01f},
                             {0.03f, 0},
                             {0.042f, 0},
                             {0.062f, 0.24f},
                             {0.062f, 0.25f},
                             {0.057f, 0.25f},
                             {0.038f, 0.006f},
                             {0, 0.006f}},
                            {{0, 0.01f},
                             {0.03f, 0},
                             {0.05f, 0},
                             {0.07f, 0.14f},
                             {0.062f, 0.20f},
                             {0.030f, 0.215f},
                             {0.032f, 0.25f},
                             {0.027f, 0.25f},
                             {0.025f, 0.21f},
                             {0.06f, 0.14f},
                             {0.045f, 0.008f},
                             {0, 0.008f}}};
  Profile outline;
  for (const Vec2f at : rounded(forms[form], form == 1 ? 0.006f : 0.04f, 5))
    outline.push_back({at.x * k, max(0.0f, at.y) * k});
  Prop p;
  PropPart& b = p.body();
  const Vec3 glaze = shop.color(dice.pick<Vec3>({{0.08, 0.18, 0.30},
                                                 {0.48, 0.19, 0.11},
                                                 {0.84, 0.82, 0.78},
                                                 {0.32, 0.40, 0.34},
                                                 {0.55, 0.46, 0.30}}));
  b.show("vase",
         form == 1 && dice.chance(0.6) ? shop.solid_glass({0.75, 0.86, 0.84}) : shop.ceramic(glaze),
         lathe(outline, 40));
  if (dice.chance(0.6)) {
    // Dry grass: stems with ears.
    const std::string straw = shop.leaf({0.68, 0.55, 0.33});
    for (int s = 0; s < 11; ++s) {
      const float a = 2.4f * float(s) + float(dice.uniform(-0.3, 0.3)),
                  out = float(dice.uniform(0.05, 0.15)) * k,
                  top = h + float(dice.uniform(0.16, 0.34)) * k;
      const Vec3f tip{out * std::cos(a), out * std::sin(a), top},
          neck{0.16f * k * 0.1f * std::cos(a), 0.16f * k * 0.1f * std::sin(a), h};
      b.show(
          "stems", straw,
          tube(smooth_path(
                   {{0, 0, 0.02f}, neck, {0.5f * tip.x, 0.5f * tip.y, h + 0.6f * (top - h)}, tip},
                   4),
               0.0012f, 5));
      b.show("ears", straw,
             ball(0.006f, 8)
                 .scaled({1, 1, 4.5f})
                 .turned(Axis::kY, 60 * out)
                 .turned(Axis::kZ, a * 180 / kPi)
                 .moved(tip));
    }
  }
  b.collide_cylinder(0.046f * k, 0, 0.03f * k);
  b.collide_cylinder((form == 1 ? 0.055f : 0.066f) * k, 0.03f * k, form == 1 ? h : 0.18f * k);
  if (form != 1) b.collide_cylinder(0.036f * k, 0.18f * k, h);
  b.mass = 0.9 * double(k * k);
  p.loose = true;
  return p;
}

constexpr PropKind kDecor[] = {
    {"picture", picture, "framed picture on a wall"},
    {"wall_mirror", wall_mirror, "mirror on a wall, round or framed"},
    {"wall_clock", wall_clock, "round clock on a wall"},
    {"vase", vase, "vase of glazed clay or glass, some with dry grass"},
};

}  // namespace

PropFamily decor() { return kDecor; }

}  // namespace gloam
