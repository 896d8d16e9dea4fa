// Workplaces in halls.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

constexpr Vec3 kBlue{0.06, 0.21, 0.45};

// A workbench with drawers, a vice and a panel of tools. The frame is the prop's; x, y are half its
// size, z its height [m].
struct Workbench {
  explicit Workbench(Workshop& maker) : shop(maker) {
    const Vec3f size = shop.size({0.75f, 1.6f, 0.88f});
    x = std::clamp(size.x, 0.5f, 1.0f) / 2, y = std::clamp(size.y, 1.0f, 3.0f) / 2,
    z = std::clamp(size.z, 0.75f, 1.0f);
    blue = shop.paint(shop.color(kBlue), 0.38), steel = shop.metal("steel");
    wall = -x + 0.02f, w0 = z + 0.06f, w1 = z + 0.62f;
  }

  void show_frame(PropPart& b) const;
  void show_drawers(PropPart& b) const;
  void show_vice(PropPart& b) const;
  void show_panel(PropPart& b) const;
  void show_tools(PropPart& b) const;

  Workshop& shop;
  float x = 0, y = 0, z = 0;
  std::string blue, steel;
  const float top = 0.045f;        // thickness of the board
  float wall = 0, w0 = 0, w1 = 0;  // front of the panel of tools, its bottom and its top
};

void Workbench::show_frame(PropPart& b) const {
  b.show("top", shop.wood("birch", Axis::kY), slab({-x, -y, z - top}, {x, y, z}, 0.005f, 2));
  for (const float s : {-1.0f, 1.0f}) {
    for (const float e : {-1.0f, 1.0f})
      b.show("frame", blue,
             slab({e * (x - 0.09f) - 0.025f, s * (y - 0.07f) - 0.025f, 0.01f},
                  {e * (x - 0.09f) + 0.025f, s * (y - 0.07f) + 0.025f, z - top}, 0.004f))
          .show("feet", shop.plastic(kSafetyBlack, 0.5),
                slab({e * (x - 0.09f) - 0.03f, s * (y - 0.07f) - 0.03f, 0},
                     {e * (x - 0.09f) + 0.03f, s * (y - 0.07f) + 0.03f, 0.012f}, 0.003f));
    for (const float h : {0.12f, z - top - 0.05f})
      b.show("frame", blue,
             slab({-x + 0.1f, s * (y - 0.07f) - 0.02f, h},
                  {x - 0.1f, s * (y - 0.07f) + 0.02f, h + 0.05f}, 0.003f));
    b.collide_box({-x + 0.065f, s * (y - 0.07f) - 0.03f, 0},
                  {x - 0.065f, s * (y - 0.07f) + 0.03f, z - top});
  }
  b.show("frame", blue,
         slab({-x + 0.08f, -y + 0.09f, 0.30f}, {-x + 0.1f, y - 0.09f, 0.36f}, 0.003f));
  b.show("shelf", shop.chipboard(),
         slab({-x + 0.08f, -y + 0.09f, 0.172f}, {x - 0.18f, y - 0.09f, 0.19f}, 0.002f));
  b.collide_box({-x + 0.08f, -y + 0.1f, 0.15f}, {x - 0.18f, y - 0.1f, 0.19f})
      .collide_box({-x, -y, z - top}, {x, y, z});
}

void Workbench::show_drawers(PropPart& b) const {
  // The drawers are fixed, with a gap all round.
  const float d0 = y - 0.55f, d1 = y - 0.105f;
  b.show("cabinet", blue,
         slab({-x + 0.12f, d0, z - top - 0.36f}, {x - 0.09f, d1, z - top}, 0.004f));
  for (int i = 0; i < 3; ++i) {
    const float h = z - top - 0.012f - 0.115f * float(i);
    b.show("drawers", shop.paint({0.62, 0.64, 0.65}, 0.4),
           slab({x - 0.092f, d0 + 0.012f, h - 0.108f}, {x - 0.072f, d1 - 0.012f, h}, 0.004f));
    b.show(
        "pulls", shop.metal("aluminium"),
        slab({x - 0.074f, d0 + 0.03f, h - 0.028f}, {x - 0.060f, d1 - 0.03f, h - 0.012f}, 0.005f));
  }
  b.collide_box({-x + 0.12f, d0, z - top - 0.36f}, {x - 0.06f, d1, z - top});
}

void Workbench::show_vice(PropPart& b) const {
  const float vy = -y + 0.28f, vx = x - 0.06f;
  const std::string cast = shop.paint({0.10, 0.22, 0.36}, 0.35);
  b.show("vice", cast,
         slab({vx - 0.22f, vy - 0.07f, z}, {vx - 0.02f, vy + 0.07f, z + 0.025f}, 0.006f) +
             slab({vx - 0.13f, vy - 0.06f, z + 0.02f}, {vx - 0.06f, vy + 0.06f, z + 0.15f}, 0.012f,
                  2) +
             slab({vx - 0.19f, vy - 0.035f, z + 0.05f}, {vx + 0.1f, vy + 0.035f, z + 0.11f}, 0.012f,
                  2) +
             slab({vx + 0.03f, vy - 0.06f, z + 0.04f}, {vx + 0.09f, vy + 0.06f, z + 0.15f}, 0.014f,
                  2));
  b.show(
      "jaws", steel,
      slab({vx - 0.062f, vy - 0.063f, z + 0.12f}, {vx - 0.048f, vy + 0.063f, z + 0.152f}, 0.001f) +
          slab({vx + 0.018f, vy - 0.063f, z + 0.12f}, {vx + 0.032f, vy + 0.063f, z + 0.152f},
               0.001f) +
          bar({vx + 0.08f, vy, z + 0.078f}, {vx + 0.15f, vy, z + 0.078f}, 0.014f, 0.014f, 14) +
          bar({vx + 0.135f, vy - 0.02f, z - 0.01f}, {vx + 0.135f, vy + 0.03f, z + 0.18f}, 0.006f,
              0.006f, 8) +
          ball(0.010f, 10).moved(vx + 0.135f, vy - 0.02f, z - 0.01f) +
          ball(0.010f, 10).moved(vx + 0.135f, vy + 0.03f, z + 0.18f));
  b.collide_box({vx - 0.22f, vy - 0.07f, z}, {vx + 0.09f, vy + 0.07f, z + 0.152f});
}

void Workbench::show_panel(PropPart& b) const {
  b.show("board", shop.paint({0.42, 0.44, 0.46}, 0.45),
         slab({wall - 0.02f, -y + 0.03f, w0}, {wall, y - 0.03f, w1}, 0.003f));
  for (const float s : {-1.0f, 1.0f})
    b.show("frame", blue,
           slab({wall - 0.02f, s * (y - 0.06f) - 0.02f, z},
                {wall - 0.004f, s * (y - 0.06f) + 0.02f, w1 - 0.02f}, 0.002f));
  Solid holes;
  for (float hy = -y + 0.07f; hy < y - 0.05f; hy += 0.04f)
    for (float hz = w0 + 0.03f; hz < w1 - 0.02f; hz += 0.04f)
      holes += panel(0.011f, 0.011f).moved(wall + 0.0006f, hy, hz);
  b.show("holes", shop.paint({0.02, 0.02, 0.02}, 0.9), holes);
}

void Workbench::show_tools(PropPart& b) const {
  const std::string red = shop.plastic({0.62, 0.05, 0.04}, 0.3), wood = shop.wood("oak", Axis::kZ);
  float at = -y + 0.16f;
  for (int i = 0; i < 5; ++i, at += 0.06f) {  // screwdrivers
    const float l = 0.20f - 0.018f * float(i);
    b.show("handles", red,
           bar({wall + 0.03f, at, w1 - 0.09f}, {wall + 0.03f, at, w1 - 0.19f}, 0.013f, 0.015f, 10));
    b.show("blades", steel,
           bar({wall + 0.03f, at, w1 - 0.19f}, {wall + 0.03f, at, w1 - 0.19f - l}, 0.0035f, 0.003f,
               8));
    b.show("hooks", steel,
           bar({wall, at, w1 - 0.185f}, {wall + 0.045f, at, w1 - 0.185f}, 0.0025f, 0.0025f, 6));
  }
  for (int i = 0; i < 6; ++i, at += 0.055f) {  // spanners
    const float l = 0.30f - 0.03f * float(i), k = l / 0.3f;
    b.show("blades", steel,
           slab({wall + 0.008f, at - 0.008f * k, w1 - 0.1f - l},
                {wall + 0.014f, at + 0.008f * k, w1 - 0.1f}, 0.002f) +
               ring(0.010f * k, 0.020f * k, 0.006f, 0.016f, 16)
                   .turned(Axis::kY, 90)
                   .moved(wall, at, w1 - 0.1f) +
               ring(0.009f * k, 0.018f * k, 0.006f, 0.016f, 12)
                   .turned(Axis::kY, 90)
                   .moved(wall, at, w1 - 0.1f - l));
  }
  for (int i = 0; i < 2; ++i, at += 0.15f) {  // hammers
    b.show("shafts", wood,
           bar({wall + 0.03f, at, w1 - 0.12f}, {wall + 0.03f, at, w1 - 0.42f}, 0.011f, 0.014f, 10));
    b.show("blades", steel,
           slab({wall + 0.017f, at - 0.055f, w1 - 0.125f},
                {wall + 0.043f, at + 0.055f, w1 - 0.098f}, 0.004f));
  }
}

Prop workbench(Workshop& shop) {
  const Workbench w(shop);
  Prop p;
  PropPart& b = p.body();
  w.show_frame(b);
  w.show_drawers(b);
  w.show_vice(b);
  w.show_panel(b);
  w.show_tools(b);
  b.collide_box({w.wall - 0.02f, -w.y + 0.03f, w.z}, {w.wall + 0.02f, w.y - 0.03f, w.w1});
  b.mass = 25 + 700 * w.top * 4 * w.x * w.y + 20;
  p.surfaces.push_back({{-w.x + 0.1f, -w.y + 0.5f}, {w.x - 0.02f, w.y - 0.02f}, w.z});
  p.front = 0.7f;
  return p;
}

Prop conveyor(Workshop& shop) {
  // Gravity rollers of 50 mm at 100 mm between two channels; runs along y.
  const Vec3f size = shop.size({0.6f, 2.0f, 0.75f});
  const float x = std::clamp(size.x, 0.3f, 1.2f) / 2, y = std::clamp(size.y, 0.5f, 10.0f) / 2,
              z = std::clamp(size.z, 0.3f, 1.2f), r = 0.025f;
  Prop p;
  PropPart& b = p.body();
  const std::string frame = shop.paint(shop.color(kBlue), 0.38), steel = shop.metal("galvanised");
  for (const float s : {-1.0f, 1.0f}) {
    const Profile c{{0, -0.06f},       {0, 0.06f},         {-0.03f, 0.06f},   {-0.03f, 0.057f},
                    {-0.003f, 0.057f}, {-0.003f, -0.057f}, {-0.03f, -0.057f}, {-0.03f, -0.06f}};
    const Solid rail = plate_y(c, -y, y);  // open to the inside
    b.show("rails", frame, (s > 0 ? rail : rail.turned(Axis::kZ, 180)).moved(s * x, 0, z - 0.075f));
  }
  const int rollers = std::max(3, int(2 * y / 0.1f));
  for (int i = 0; i < rollers; ++i) {
    const float at = -y + 2 * y * (float(i) + 0.5f) / float(rollers);
    b.show("rollers", steel, bar({-x + 0.008f, at, z - r}, {x - 0.008f, at, z - r}, r, r, 14));
    for (const float s : {-1.0f, 1.0f})
      b.show("axles", shop.metal("steel"),
             bar({s * (x - 0.004f), at, z - r}, {s * (x + 0.004f), at, z - r}, 0.006f, 0.006f, 6));
  }
  const int stands = std::max(2, int(2 * y / 1.6f) + 1);
  for (int i = 0; i < stands; ++i) {
    const float at = (-y + 0.15f) + (2 * y - 0.3f) * float(i) / float(stands - 1);
    for (const float s : {-1.0f, 1.0f}) {
      const float lx = s * (x - 0.05f);
      b.show("legs", frame,
             slab({lx - 0.02f, at - 0.02f, 0.03f}, {lx + 0.02f, at + 0.02f, z - 0.13f}, 0.003f) +
                 slab({lx - 0.02f, at - 0.05f, z - 0.14f},
                      {lx + 0.047f * s + 0.02f * (s < 0), at + 0.05f, z - 0.134f}, 0.001f));
      b.show("feet", steel,
             cylinder(0.04f, 0, 0.012f, 0.002f, 20).moved(lx, at, 0) +
                 cylinder(0.008f, 0.01f, 0.04f, 0.001f, 8).moved(lx, at, 0));
    }
    b.show("legs", frame,
           slab({-x + 0.05f, at - 0.015f, 0.14f}, {x - 0.05f, at + 0.015f, 0.17f}, 0.002f));
    b.collide_box({-x + 0.01f, at - 0.04f, 0}, {x - 0.01f, at + 0.04f, z - 0.135f});
  }
  b.collide_box({-x, -y, z - 0.135f}, {x, y, z});
  b.mass = 2 * y * (8 + 40 * x) + stands * 6;
  p.surfaces.push_back({{-x + 0.04f, -y + 0.03f}, {x - 0.04f, y - 0.03f}, z});
  return p;
}

Prop packing_table(Workshop& shop) {
  // Table with a shelf above, a roll of paper across, cartons, tape, a screen.
  const Vec3f size = shop.size({0.8f, 1.8f, 1.75f});
  const float x = std::clamp(size.x, 0.6f, 1.0f) / 2, y = std::clamp(size.y, 1.2f, 3.0f) / 2,
              z = 0.86f, high = std::clamp(size.z, 1.5f, 2.2f);
  Prop p;
  PropPart& b = p.body();
  const std::string grey = shop.paint({0.60, 0.62, 0.63}, 0.4), steel = shop.metal("steel");
  b.show("top", shop.plastic(shop.color({0.70, 0.71, 0.70}), 0.45),
         slab({-x, -y, z - 0.03f}, {x, y, z}, 0.004f, 2));
  b.show("top_edge", shop.plastic(kSafetyBlack, 0.5),
         slab({x - 0.001f, -y, z - 0.031f}, {x + 0.002f, y, z + 0.0005f}, 0.0008f));
  for (const float s : {-1.0f, 1.0f}) {
    const float ly = s * (y - 0.05f);
    b.show(
        "frame", grey,
        slab({x - 0.10f, ly - 0.02f, 0.02f}, {x - 0.06f, ly + 0.02f, z - 0.03f}, 0.003f) +
            slab({-x + 0.02f, ly - 0.02f, 0.02f}, {-x + 0.06f, ly + 0.02f, high}, 0.003f) +
            slab({-x + 0.05f, ly - 0.02f, z - 0.09f}, {x - 0.07f, ly + 0.02f, z - 0.03f}, 0.003f) +
            slab({-x + 0.05f, ly - 0.02f, 0.12f}, {x - 0.07f, ly + 0.02f, 0.16f}, 0.003f));
    for (const float lx : {x - 0.08f, -x + 0.04f})
      b.show("feet", shop.plastic(kSafetyBlack, 0.5),
             cylinder(0.025f, 0, 0.025f, 0.004f, 16).moved(lx, ly, 0));
    b.show("frame", grey,
           beam({-x + 0.05f, ly, high - 0.32f}, {-x + 0.33f, ly, high - 0.27f}, 0.006f, 0.04f));
    b.collide_box({-x + 0.02f, ly - 0.025f, 0}, {x - 0.06f, ly + 0.025f, z - 0.03f})
        .collide_box({-x + 0.02f, ly - 0.02f, z}, {-x + 0.06f, ly + 0.02f, high});
  }
  b.show(
      "shelf", shop.chipboard(),
      slab({-x + 0.02f, -y + 0.03f, high - 0.27f}, {-x + 0.36f, y - 0.03f, high - 0.25f}, 0.002f));
  b.collide_box({-x + 0.02f, -y + 0.03f, high - 0.27f}, {-x + 0.36f, y - 0.03f, high - 0.25f})
      .collide_box({-x, -y, z - 0.03f}, {x, y, z});
  b.show("frame", grey,
         slab({-x + 0.05f, -y + 0.05f, 0.12f}, {-x + 0.08f, y - 0.05f, 0.16f}, 0.003f));
  // Paper on its axle under the shelf, its end on the table.
  const float roll = 0.11f, rz = z + 0.20f, rx = -x + 0.19f;
  b.show("paper", shop.paper({0.55, 0.43, 0.30}),
         bar({rx, -y * 0.5f, rz}, {rx, y * 0.35f, rz}, roll, roll, 32) +
             slab({rx, -y * 0.5f, z + 0.0005f}, {x - 0.25f, y * 0.35f, z + 0.0015f}, 0));
  std::vector<Vec3f> fall;
  for (int k = 0; k <= 6; ++k)
    for (const float wy : {-y * 0.5f, y * 0.35f}) {
      const float t = float(k) / 6;
      fall.push_back({rx + roll + 0.02f * std::sin(kPi * t), wy, rz + (z + 0.001f - rz) * t});
    }
  b.show("paper", shop.paper({0.55, 0.43, 0.30}), sheet(fall, 2, 0.0006f));
  b.show("axle", steel, bar({rx, -y + 0.05f, rz}, {rx, y - 0.05f, rz}, 0.012f, 0.012f, 10));
  for (const float s : {-1.0f, 1.0f})
    b.show(
        "frame", grey,
        beam({-x + 0.05f, s * (y - 0.05f), rz}, {rx + 0.02f, s * (y - 0.05f), rz}, 0.006f, 0.05f));
  b.collide_cylinder(Vec3f{rx, -y * 0.5f, rz}, Vec3f{rx, y * 0.35f, rz}, roll);
  const float cx = -x + 0.06f;
  add_cartons(&b, &shop, {cx, -y + 0.1f, high - 0.25f},
              {cx + 0.28f, -y + 0.1f + 0.7f, high - 0.02f});
  b.collide_box({cx, -y + 0.1f, high - 0.25f}, {cx + 0.28f, -y + 0.8f, high - 0.02f});
  b.show("dispenser", shop.plastic({0.62, 0.06, 0.05}),
         ring(0.035f, 0.052f, -0.025f, 0.025f, 24)
                 .turned(Axis::kX, 90)
                 .moved(x - 0.2f, y - 0.3f, z + 0.053f) +
             slab({x - 0.15f, y - 0.325f, z + 0.02f}, {x - 0.08f, y - 0.275f, z + 0.04f}, 0.004f));
  b.show("screen", shop.plastic(kSafetyBlack, 0.25),
         rounded_box({0.025f, 0.40f, 0.26f}, 0.006f)
             .turned(Axis::kZ, -18)
             .moved(-x + 0.30f, y - 0.38f, z + 0.30f));
  b.show("screen_glow", shop.glow({0.35, 0.55, 0.75}, 90),
         panel(0.375f, 0.235f).turned(Axis::kZ, -18).moved(-x + 0.3125f, y - 0.384f, z + 0.30f));
  b.show("screen_foot", shop.plastic(kSafetyBlack, 0.4),
         bar({-x + 0.28f, y - 0.375f, z + 0.005f}, {-x + 0.28f, y - 0.375f, z + 0.25f}, 0.02f,
             0.016f, 12) +
             cylinder(0.1f, z, z + 0.012f, 0.003f, 28).moved(-x + 0.28f, y - 0.375f, 0));
  b.mass = 62;
  p.surfaces.push_back(
      {{x - 0.24f, -y + 0.05f}, {x - 0.02f, y - 0.45f}, z + 0.002f, high - z - 0.3f});
  p.front = 0.8f;
  return p;
}

Prop fan(Workshop& shop) {
  // Drum fan on a tilting stand.
  const float r = std::clamp(shop.size({0.35f, 0.75f, 0.8f}).y, 0.4f, 1.2f) / 2 - 0.03f,
              deep = 0.10f, axis = r + 0.07f;
  Prop p;
  PropPart& b = p.body();
  const std::string frame = shop.paint(shop.color({0.05, 0.05, 0.055}), 0.4),
                    wire_paint = shop.metal("steel");
  const auto on_x = [&](const Solid& s) { return s.turned(Axis::kY, 90).moved(0, 0, axis); };
  b.show("drum", frame,
         on_x(lathe(rounded({{r - 0.008f, deep},
                             {r - 0.008f, -deep},
                             {r + 0.004f, -deep - 0.006f},
                             {r, -deep + 0.02f},
                             {r, deep - 0.02f},
                             {r + 0.004f, deep + 0.006f},
                             {r - 0.008f, deep}},
                            0.005f),
                    44)));
  for (const float s : {-1.0f, 1.0f}) {
    for (const float q : {0.25f, 0.42f, 0.59f, 0.76f, 0.93f}) {
      Path loop;
      const int n = 28;
      for (int k = 0; k <= n; ++k)
        loop.push_back({s * (deep + 0.004f), q * r * std::cos(2 * kPi * float(k) / n),
                        axis + q * r * std::sin(2 * kPi * float(k) / n)});
      b.show("grille", wire_paint, tube(loop, 0.002f, 4));
    }
    for (int k = 0; k < 12; ++k) {
      const float a = kPi * float(k) / 6;
      b.show("grille", wire_paint,
             tube({{s * (deep + 0.003f), 0.1f * r * std::cos(a), axis + 0.1f * r * std::sin(a)},
                   {s * (deep + 0.003f), r * std::cos(a), axis + r * std::sin(a)}},
                  0.0025f, 4));
    }
    b.show("badge", frame,
           on_x(cylinder(0.16f * r, s > 0 ? deep : -deep - 0.012f, s > 0 ? deep + 0.012f : -deep,
                         0.003f, 24)));
    // The stand: a bent tube at both sides, joined on the floor.
    b.show("stand", frame,
           tube(rounded_path({{0.22f, s * (r + 0.02f), 0.0125f},
                              {0.0f, s * (r + 0.02f), 0.0125f},
                              {0.0f, s * (r + 0.02f), axis}},
                             0.01f),
                0.0125f, 10) +
               bar({-0.22f, s * (r + 0.02f), 0.0125f}, {0, s * (r + 0.02f), 0.0125f}, 0.0125f,
                   0.0125f, 10));
    b.show("stand", frame,
           bar({s * 0.22f, -r - 0.02f, 0.0125f}, {s * 0.22f, r + 0.02f, 0.0125f}, 0.0125f, 0.0125f,
               10));
    b.show("knobs", shop.plastic(kSafetyBlack, 0.45),
           bar({0, s * (r + 0.005f), axis}, {0, s * (r + 0.06f), axis}, 0.025f, 0.022f, 14));
    b.collide_box({-0.232f, s * (r + 0.02f) - 0.0125f, 0},
                  {0.232f, s * (r + 0.02f) + 0.0125f, 0.025f});
    b.collide_box({-0.0125f, s * (r + 0.02f) - 0.0125f, 0.025f},
                  {0.0125f, s * (r + 0.02f) + 0.0125f, axis});
  }
  for (int k = 0; k < 4; ++k) {
    std::vector<Vec3f> blade;
    for (int i = 0; i <= 5; ++i)
      for (int j = 0; j <= 3; ++j) {
        const float q = (0.16f + 0.76f * float(i) / 5) * r,
                    a = (float(j) / 3 - 0.5f) * (0.75f - 0.05f * float(i)),
                    pitch = 0.10f * (float(j) / 3 - 0.5f) * (1.4f - 0.15f * float(i));
        blade.push_back({pitch, q * std::cos(a), q * std::sin(a)});
      }
    b.show("blades", shop.metal("aluminium"),
           sheet(blade, 4, 0.002f).turned(Axis::kX, 90.0f * float(k) + 20).moved(0, 0, axis));
  }
  b.show("motor", frame, on_x(cylinder(0.2f * r, -deep + 0.01f, 0.03f, 0.01f, 24)));
  b.collide_cylinder(Vec3f{-deep, 0, axis}, Vec3f{deep, 0, axis}, r);
  b.mass = 30 * (2 * r) * (2 * r) + 4;
  p.loose = true;
  return p;
}

Prop water_cooler(Workshop& shop) {
  // Bottle of 19 l upside down on a cabinet with two taps.
  const float x = 0.16f, y = 0.16f, z = 0.98f;
  Prop p;
  PropPart& b = p.body();
  const std::string white = shop.plastic(shop.color({0.84, 0.85, 0.85}), 0.35),
                    dark = shop.plastic({0.08, 0.085, 0.09}, 0.35);
  b.show("cabinet", white, slab({-x, -y, 0.02f}, {x - 0.02f, y, z}, 0.02f, 3));
  b.show("front", white,
         slab({x - 0.03f, -y + 0.008f, 0.04f}, {x, y - 0.008f, 0.62f}, 0.012f, 2) +
             slab({x - 0.03f, -y + 0.008f, 0.86f}, {x, y - 0.008f, z - 0.012f}, 0.012f, 2));
  b.show("niche", dark,
         slab({x - 0.03f, -y + 0.012f, 0.625f}, {x - 0.012f, y - 0.012f, 0.858f}, 0.003f) +
             slab({x - 0.02f, -0.11f, 0.622f}, {x + 0.035f, 0.11f, 0.645f}, 0.008f, 2));
  b.show("feet", dark, slab({-x + 0.02f, -y + 0.02f, 0}, {x - 0.04f, y - 0.02f, 0.022f}, 0.003f));
  const auto tap = [&](const char* name, float at, Vec3 color) {
    b.show(name, shop.plastic(color, 0.3),
           bar({x - 0.015f, at, 0.80f}, {x + 0.035f, at, 0.80f}, 0.012f, 0.012f, 12) +
               bar({x + 0.025f, at, 0.805f}, {x + 0.025f, at, 0.765f}, 0.009f, 0.008f, 12) +
               slab({x + 0.012f, at - 0.012f, 0.812f}, {x + 0.045f, at + 0.012f, 0.822f}, 0.004f));
  };
  tap("tap_cold", -0.05f, {0.05, 0.20, 0.60});
  tap("tap_hot", 0.05f, {0.70, 0.05, 0.05});
  b.show("collar", dark, cylinder(0.10f, z - 0.002f, z + 0.02f, 0.006f, 32));
  b.show("bottle", shop.solid_glass({0.62, 0.80, 0.90}),
         lathe(rounded({{0.03f, z - 0.03f},
                        {0.03f, z + 0.03f},
                        {0.13f, z + 0.10f},
                        {0.135f, z + 0.18f},
                        {0.128f, z + 0.20f},
                        {0.135f, z + 0.22f},
                        {0.135f, z + 0.32f},
                        {0.128f, z + 0.34f},
                        {0.135f, z + 0.36f},
                        {0.13f, z + 0.43f},
                        {0.0f, z + 0.44f}},
                       0.02f, 3),
               36));
  b.collide_box({-x, -y, 0}, {x, y, z}).collide_cylinder(0.135f, z, z + 0.44f);
  b.mass = 16 + 14;
  p.front = 0.5f;
  return p;
}

constexpr PropKind kStations[] = {
    {"workbench", workbench, "bench with a vice, drawers and a wall of tools"},
    {"conveyor", conveyor, "section of a roller conveyor along y"},
    {"packing_table", packing_table, "table with paper roll, shelf and screen"},
    {"fan", fan, "industrial drum fan on its stand"},
    {"water_cooler", water_cooler, "dispenser with a bottle of 19 l"},
};

}  // namespace

PropFamily stations() { return kStations; }

}  // namespace gloam
