// Shelves and racks.

#include <fmt/format.h>

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// A vase, a bowl or a box for a bay of shelves; stands on z = 0.
void show_ornament(PropPart* b, Workshop& shop, Vec3f at, float room, float height) {
  Dice& dice = shop.dice;
  const Vec3 glaze = dice.pick<Vec3>(
      {{0.06, 0.16, 0.30}, {0.48, 0.17, 0.09}, {0.86, 0.84, 0.80}, {0.20, 0.28, 0.24}});
  const int tint = int(std::lround(glaze.x * 100));
  const int kind = dice.integer(0, 2);
  if (kind == 0) {
    const float h = min(float(dice.uniform(0.16, 0.24)), height - 0.04f),
                r = min(0.40f * h, room / 2);
    b->show(fmt::format("vase_{}", tint), shop.ceramic(glaze),
            lathe(rounded({{0, 0},
                           {0.6f * r, 0},
                           {r, 0.45f * h},
                           {0.40f * r, 0.86f * h},
                           {0.48f * r, h},
                           {0.40f * r, h},
                           {0.32f * r, 0.85f * h},
                           {0, 0.7f * h}},
                          0.16f * h, 5),
                  28)
                .moved(at));
  } else if (kind == 1) {
    const float r = min(0.10f, room / 2);
    b->show(fmt::format("vase_{}", tint), shop.ceramic(glaze),
            lathe(rounded({{0, 0},
                           {0.4f * r, 0},
                           {r, 0.7f * r},
                           {0.95f * r, 0.7f * r},
                           {0.36f * r, 0.1f * r},
                           {0, 0.1f * r}},
                          0.012f, 4),
                  28)
                .moved(at));
  } else {
    const float w = min(0.24f, room - 0.01f), h = min(0.15f, height - 0.05f);
    const std::string cloth = shop.fabric({0.62, 0.57, 0.48}, 0.003);
    b->show("storage_box", cloth,
            slab(at + Vec3f{-0.12f, -w / 2, 0}, at + Vec3f{0.09f, w / 2, h}, 0.008f, 2));
    b->show("storage_box", cloth,
            slab(at + Vec3f{-0.124f, -w / 2 - 0.004f, h - 0.04f},
                 at + Vec3f{0.094f, w / 2 + 0.004f, h + 0.006f}, 0.006f, 2));
    b->show("box_label", shop.metal("brass"),
            slab(at + Vec3f{0.089f, -0.03f, h * 0.4f}, at + Vec3f{0.092f, 0.03f, h * 0.4f + 0.03f},
                 0.001f));
  }
}

Prop bookshelf(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size =
      limited(shop.size({float(dice.uniform(0.28, 0.34)), float(dice.pick({0.8, 1.0, 1.2})),
                         float(dice.uniform(1.75, 2.05))}),
              {0.22f, 0.4f, 0.7f}, {0.45f, 2.4f, 2.6f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, t = 0.022f, plinth = 0.06f;
  const int bays = std::max(2, int(std::lround((z - plinth) / 0.36f)));
  const int columns = size.y > 0.95f ? 2 : 1;
  const bool white = dice.chance(0.3);
  const auto board = [&](Axis axis) {
    return white ? shop.paint({0.86, 0.85, 0.83}, 0.4) : shop.wood(axis);
  };
  Prop p;
  PropPart& b = p.body();
  for (int k = 0; k <= columns; ++k) {
    const float at = -y + t / 2 + (size.y - t) * float(k) / float(columns);
    b.show("uprights", board(Axis::kZ),
           slab({-x, at - t / 2, 0}, {x, at + t / 2, z - (k > 0 && k < columns ? t : 0)}, 0.003f));
  }
  b.show("back", board(Axis::kZ), slab({-x, -y + t, 0.02f}, {-x + 0.005f, y - t, z - t}, 0));
  b.show("kickboard", board(Axis::kY),
         slab({x - 0.04f, -y + t, 0}, {x - 0.025f, y - t, plinth - t / 2}, 0.001f));
  const float pitch = (z - t / 2 - plinth) / float(bays),
              inner = (size.y - t * float(columns + 1)) / float(columns);
  for (int level = 0; level <= bays; ++level) {
    const float at = plinth + pitch * float(level);
    for (int c = 0; c < columns; ++c) {
      const float y0 = -y + t + (inner + t) * float(c);
      b.show("shelves", board(Axis::kY),
             slab({-x + 0.003f, y0, at - t / 2}, {x - 0.004f, y0 + inner, at + t / 2}, 0.002f));
      if (level == bays) continue;
      const float floor = at + t / 2 + 0.0003f, free = pitch - t;
      const bool sparse = dice.chance(0.35);
      const float end =
          show_books(&b, shop, {x - 0.03f, y0, floor}, inner, free, size.x - 0.03f,
                     sparse ? float(dice.uniform(0.25, 0.6)) : float(dice.uniform(0.8, 0.97)));
      const float room = y0 + inner - end - 0.03f;
      if (room > 0.14f)
        show_ornament(&b, shop, {0.01f, end + 0.02f + room / 2, floor}, min(room, 0.26f), free);
    }
  }
  // Loaded with 25 kg of books per metre of shelf: in one, since nothing is taken out.
  b.collide_box({-x, -y, 0}, {x - 0.01f, y, z});
  b.mass = 650.0 * 0.022 * double(size.x) * double(2 * z + float(bays + 1) * size.y) +
           16.0 * double(size.y) * bays;
  p.surfaces.push_back({{-x + 0.02f, -y + 0.03f}, {x - 0.02f, y - 0.03f}, z});
  p.front = 0.5f;
  return p;
}

Prop wall_shelf(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size =
      limited(shop.size({float(dice.uniform(0.18, 0.24)), float(dice.uniform(0.6, 1.1)), 0.22f}),
              {0.12f, 0.3f, 0.1f}, {0.35f, 2.0f, 0.3f});
  const float d = size.x, y = size.y / 2, t = 0.014f;
  Prop p;
  PropPart& b = p.body();
  b.show("board", shop.wood(Axis::kY), slab({0, -y, -t}, {d, y, t}, 0.003f));
  const bool brackets = dice.chance(0.6);
  for (const float side : {-0.76f, 0.76f}) {
    if (!brackets) continue;
    b.show(
        "brackets", shop.metal("black"),
        slab({0, side * y - 0.012f, -0.11f}, {0.005f, side * y + 0.012f, -t}, 0.001f) +
            slab({0, side * y - 0.012f, -t - 0.005f}, {d - 0.03f, side * y + 0.012f, -t}, 0.001f) +
            bar({0.004f, side * y, -0.10f}, {d - 0.06f, side * y, -t - 0.004f}, 0.005f, 0.005f, 8));
  }
  b.collide_box({0, -y, -t}, {d, y, t});
  b.mass = 650.0 * double(d * size.y * 2 * t) + 1;
  p.surfaces.push_back({{0.02f, -y + 0.02f}, {d - 0.02f, y - 0.02f}, t});
  return p;
}

Prop shoe_rack(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size =
      limited(shop.size({0.30f, float(dice.uniform(0.6, 0.9)), float(dice.uniform(0.45, 0.75))}),
              {0.24f, 0.4f, 0.3f}, {0.4f, 1.4f, 1.2f});
  const float x = size.x / 2, y = size.y / 2, z = size.z, t = 0.02f;
  const int levels = std::max(2, int(std::lround(z / 0.24f)));
  Prop p;
  PropPart& b = p.body();
  for (const float side : {-1.0f, 1.0f}) {
    for (const float end : {-1.0f, 1.0f})
      b.show("posts", shop.wood(Axis::kZ),
             slab({end * (x - 0.014f) - 0.014f, side * (y - 0.012f) - 0.012f, 0},
                  {end * (x - 0.014f) + 0.014f, side * (y - 0.012f) + 0.012f, z}, 0.003f));
    b.collide_box({-x, side * (y - 0.012f) - 0.012f, 0}, {x, side * (y - 0.012f) + 0.012f, z});
  }
  for (int k = 0; k < levels; ++k) {
    const float at = 0.09f + (z - 0.11f) * float(k) / float(levels - 1);
    for (const float side : {-1.0f, 1.0f})
      b.show("bearers", shop.wood(Axis::kX),
             slab({-x + 0.028f, side * (y - 0.012f) - 0.009f, at - 0.016f},
                  {x - 0.028f, side * (y - 0.012f) + 0.009f, at + t / 2}, 0.001f));
    for (int s = 0; s < 5; ++s) {
      const float cx = -x + 0.03f + (size.x - 0.06f) * float(s) / 4;
      b.show("slats", shop.wood(Axis::kY),
             slab({cx - 0.020f, -y + 0.012f, at}, {cx + 0.020f, y - 0.012f, at + t / 2}, 0.002f));
    }
    b.collide_box({-x, -y + 0.024f, at}, {x, y - 0.024f, at + t / 2});
    const float above = k + 1 < levels ? (z - 0.11f) / float(levels - 1) - 0.03f : 10;
    p.surfaces.push_back({{-x + 0.01f, -y + 0.03f}, {x - 0.01f, y - 0.03f}, at + t / 2, above});
  }
  b.mass = 2 + 7.0 * double(size.y) * levels * 0.5;
  p.front = 0.4f;
  return p;
}

Prop coat_rack(Workshop& shop) {
  Dice& dice = shop.dice;
  const float z = limited(shop.size({0.5f, 0.5f, float(dice.uniform(1.68, 1.82))}), {0, 0, 1.4f},
                          {10, 10, 2.1f})
                      .z;
  Prop p;
  PropPart& b = p.body();
  const bool steel = dice.chance(0.4);
  const std::string pole = steel ? shop.metal("black") : shop.wood(Axis::kZ),
                    arm = steel ? shop.metal("black") : shop.wood(Axis::kX);
  b.show("pole", pole, cylinder(0.019f, 0.03f, z, 0.008f, 20));
  for (int k = 0; k < 4; ++k) {
    const float a = kPi / 4 + kPi / 2 * float(k), c = std::cos(a), s = std::sin(a);
    const auto at = [&](float r, float h) { return Vec3f{r * c, r * s, h}; };
    b.show("feet", arm,
           tube(smooth_path(
                    {at(0.015f, 0.24f), at(0.10f, 0.15f), at(0.23f, 0.030f), at(0.275f, 0.0125f)}),
                0.0125f, 10));
    b.show("hooks", arm,
           tube(smooth_path({at(0.012f, z - 0.17f), at(0.07f, z - 0.16f), at(0.115f, z - 0.10f),
                             at(0.125f, z - 0.05f)}),
                0.009f, 9) +
               ball(0.0125f, 12).moved(at(0.1255f, z - 0.045f)));
    b.collide_box(at(0.155f, 0.012f), {0.12f, 0.0125f, 0.012f}, turn({0, 0, 1}, double(a)));
    b.collide_capsule(at(0.03f, z - 0.165f), at(0.12f, z - 0.06f), 0.010f);
  }
  b.show("ring", arm,
         cylinder(0.028f, 0.215f, 0.255f, 0.006f, 24) +
             cylinder(0.026f, z - 0.19f, z - 0.15f, 0.006f, 24));
  if (dice.chance(0.6)) {
    // A coat on one hook: a cloth gathered at its collar.
    constexpr int kAround = 40, kDown = 18;
    const float a = kPi / 4, hx = 0.16f * std::cos(a), hy = 0.16f * std::sin(a),
                phase = float(dice.uniform(0, 6));
    Path points;
    for (int i = 0; i <= kDown; ++i) {
      const float s = float(i) / kDown, r = 0.03f + 0.11f * (1 - std::exp(-5 * s)) + 0.03f * s;
      for (int k = 0; k <= kAround; ++k) {
        const float u = 2 * kPi * float(k) / kAround,
                    fold = 1 + 0.16f * s * std::sin(7 * u + phase + s) + 0.07f * std::sin(3 * u);
        points.push_back({hx + r * fold * std::cos(u) * 0.75f, hy + r * fold * std::sin(u),
                          z - 0.075f - s * 0.92f});
      }
    }
    // Rows run downwards: the front of the cloth is outside.
    b.show(
        "coat",
        shop.fabric(
            shop.color(dice.pick<Vec3>(
                {{0.16, 0.19, 0.26}, {0.42, 0.36, 0.28}, {0.14, 0.14, 0.15}, {0.35, 0.16, 0.14}})),
            0.0013),
        Solid(sheet(points, kAround + 1, 0.004f)));
    b.collide_capsule({hx, hy, z - 0.24f}, {hx, hy, z - 0.85f}, 0.12f);
  }
  b.collide_cylinder(0.02f, 0.024f, z);
  b.mass = 7;
  p.loose = true;
  return p;
}

constexpr PropKind kShelving[] = {
    {"bookshelf", bookshelf, "shelves filled with books and a few ornaments"},
    {"wall_shelf", wall_shelf, "board on brackets at a wall"},
    {"shoe_rack", shoe_rack, "slatted rack for shoes"},
    {"coat_rack", coat_rack, "pole with hooks, some with a coat"},
};

}  // namespace

PropFamily shelving() { return kShelving; }

}  // namespace gloam
