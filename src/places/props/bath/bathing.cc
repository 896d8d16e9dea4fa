// Bathtubs and showers.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

// Hand shower with its rose facing down and to +x, from the holder.
void show_hand_shower(PropPart* b, const std::string& chrome, Vec3f holder) {
  b->show("shower_head", chrome, bar(holder, holder + Vec3f{0.055f, 0, 0.14f}, 0.010f, 0.013f, 14));
  b->show(
      "shower_head", chrome,
      lathe(rounded(
                {{0, -0.006f}, {0.045f, -0.006f}, {0.042f, 0.010f}, {0.015f, 0.024f}, {0, 0.026f}},
                0.005f),
            28)
          .turned(Axis::kY, -35)
          .moved(holder + Vec3f{0.072f, 0, 0.165f}));
}

Prop bathtub(Workshop& shop) {
  const Vec3f size = shop.size({0.75f, 1.70f, 0.57f});
  const float x = std::clamp(size.x, 0.65f, 1.0f) / 2, y = std::clamp(size.y, 1.2f, 2.1f) / 2,
              z = std::clamp(size.z, 0.45f, 0.70f);
  const std::string enamel = shop.ceramic(shop.color({0.92, 0.92, 0.91})),
                    chrome = shop.metal("chrome");
  Prop p;
  PropPart& b = p.body();
  const auto outer = [&](float in, float at) {
    return ring({-x + in, -y + in}, {x - in, y - in}, 0.012f, at, 8);
  };
  // Steep at the feet (-y), sloped at the head.
  const auto inner = [&](float in, float at) {
    return ring({-x + 0.075f + in, -y + 0.10f + in}, {x - 0.06f - in, y - 0.075f - 2.6f * in},
                0.17f - 0.4f * in, at, 8);
  };
  const float floor = z - 0.42f;
  const Vec3f drain{0.01f, -y + 0.30f, floor - 0.006f};
  b.show("apron", enamel,
         loft({outer(0.02f, 0.06f), outer(0.012f, 0.06f), outer(0.012f, 0.06f),
               outer(0.012f, z - 0.04f), outer(0.012f, z - 0.04f), outer(0, z - 0.038f),
               outer(0, z - 0.008f), outer(0.003f, z - 0.002f), outer(0.009f, z), inner(-0.014f, z),
               inner(-0.004f, z - 0.004f), inner(0.002f, z - 0.018f), inner(0.03f, z - 0.20f),
               inner(0.055f, floor + 0.08f), inner(0.075f, floor + 0.03f),
               inner(0.105f, floor + 0.006f), inner(0.14f, floor), point_of(outer(0, 0), drain)}));
  b.show("base", shop.paint({0.30, 0.30, 0.30}, 0.6),
         slab({-x + 0.03f, -y + 0.03f, 0}, {x - 0.035f, y - 0.03f, 0.065f}, 0.002f));
  b.show("drain", chrome,
         cylinder(0.035f, floor - 0.004f, floor + 0.004f, 0.002f, 28).moved(drain.x, drain.y, 0));
  b.show("overflow", chrome,
         lathe(rounded({{0.034f, 0}, {0.032f, 0.010f}, {0.020f, 0.014f}, {0, 0.014f}}, 0.003f), 28)
             .turned(Axis::kX, -83)
             .moved(drain.x, -y + 0.117f, z - 0.10f));
  // Mixer on the rim at the wall, with a hand shower.
  const Vec3f foot{-x + 0.037f, -y + 0.55f, z - 0.001f};
  for (const float side : {-1.0f, 1.0f}) {
    b.show("mixer", chrome,
           cylinder(0.024f, z - 0.001f, z + 0.006f, 0.002f, 24)
               .moved(foot.x, foot.y + side * 0.075f, 0));
    b.show("mixer", chrome,
           cylinder(0.013f, z, z + 0.07f, 0.002f, 18).moved(foot.x, foot.y + side * 0.075f, 0));
    b.show("mixer", chrome,
           bar({foot.x, foot.y + side * 0.10f, z + 0.075f},
               {foot.x, foot.y + side * 0.145f, z + 0.075f}, 0.021f, 0.019f, 20));
  }
  b.show("mixer", chrome,
         bar({foot.x, foot.y - 0.11f, z + 0.075f}, {foot.x, foot.y + 0.11f, z + 0.075f}, 0.019f,
             0.019f, 20));
  b.show("mixer", chrome,
         tube(smooth_path({{foot.x, foot.y, z + 0.078f},
                           {foot.x + 0.06f, foot.y, z + 0.085f},
                           {foot.x + 0.125f, foot.y, z + 0.078f},
                           {foot.x + 0.145f, foot.y, z + 0.045f}},
                          5),
              0.013f, 14));
  b.show("mixer", chrome,
         bar({foot.x, foot.y, z + 0.08f}, {foot.x, foot.y, z + 0.125f}, 0.012f, 0.010f, 14));
  show_hand_shower(&b, chrome, {foot.x, foot.y, z + 0.125f});
  b.show("hose", chrome,
         tube(smooth_path({{foot.x + 0.005f, foot.y, z + 0.12f},
                           {foot.x + 0.01f, foot.y + 0.16f, z + 0.05f},
                           {foot.x + 0.03f, foot.y + 0.30f, z + 0.010f},
                           {foot.x + 0.02f, foot.y + 0.45f, z + 0.0085f},
                           {foot.x - 0.005f, foot.y + 0.36f, z + 0.0085f},
                           {foot.x - 0.008f, foot.y + 0.18f, z + 0.02f},
                           {foot.x, foot.y + 0.03f, z + 0.06f}},
                          8),
              0.0075f, 10));
  b.collide_box({-x + 0.03f, -y + 0.03f, 0}, {x - 0.03f, y - 0.03f, floor});
  b.collide_box({-x, -y, floor}, {-x + 0.085f, y, z});
  b.collide_box({x - 0.075f, -y, floor}, {x, y, z});
  b.collide_box({-x + 0.085f, -y, floor}, {x - 0.075f, -y + 0.12f, z});
  b.collide_box({-x + 0.085f, y - 0.11f, floor}, {x - 0.075f, y, z});
  b.collide_box({foot.x - 0.02f, foot.y - 0.14f, z}, {foot.x + 0.03f, foot.y + 0.14f, z + 0.10f});
  b.mass = 24.0 * 4 * x * y + 14;  // steel of 2.4 mm, and its apron
  p.front = 0.6f;
  return p;
}

// A glass cubicle. The frame is the prop's; x, y are half its size, z its height [m].
struct Shower {
  explicit Shower(Workshop& maker) : shop(maker) {
    const float usual = shop.dice.pick({0.8f, 0.9f, 0.9f, 1.0f});
    const Vec3f size = shop.size({usual, usual, 2.02f});
    x = std::clamp(size.x, 0.7f, 1.2f) / 2, y = std::clamp(size.y, 0.7f, 1.4f) / 2,
    z = std::clamp(size.z, 1.8f, 2.2f);
    const bool black = shop.style.metal == "black";
    frame = black ? shop.metal("black") : shop.metal("chrome");
    chrome = black ? frame : shop.metal("chrome");
    back = -x;
    high = min(2.0f, z - 0.02f);
  }

  void show_tray(PropPart& b) const;
  void show_panes(PropPart& b) const;
  void show_mixer(PropPart& b) const;
  void show_riser(PropPart& b) const;
  void hang_door(Prop& p) const;
  void show_handle(PropPart& door, float grip) const;

  Workshop& shop;
  float x = 0, y = 0, z = 0;
  std::string frame, chrome;
  float back = 0, high = 0;              // wall behind; top of the riser
  const float tray = 0.05f, t = 0.003f;  // height of the tray, half thickness of glass
};

void Shower::show_tray(PropPart& b) const {
  const auto outer = [&](float in, float at) {
    return ring({-x + in, -y + in}, {x - in, y - in}, 0.015f, at, 5);
  };
  const auto inner = [&](float in, float at) {
    return ring({-x + 0.055f + in, -y + 0.055f + in}, {x - 0.055f - in, y - 0.055f - in}, 0.05f, at,
                5);
  };
  b.show("tray", shop.ceramic({0.91, 0.91, 0.90}),
         loft({outer(0, 0), outer(0, tray - 0.006f), outer(0.006f, tray), inner(-0.006f, tray),
               inner(0.006f, tray - 0.012f), inner(0.05f, tray - 0.017f),
               point_of(outer(0, 0), {0, 0, tray - 0.024f})}));
  b.show("drain", chrome, cylinder(0.055f, tray - 0.026f, tray - 0.016f, 0.003f, 36));
  b.collide_box({-x, -y, 0}, {x, y, tray - 0.02f});
}

void Shower::show_panes(PropPart& b) const {
  for (const float side : {-1.0f, 1.0f}) {
    const float at = side * (y - 0.025f);
    b.show("panes", shop.glass(),
           slab({-x + 0.02f, at - t, tray + 0.01f}, {x - 0.03f, at + t, z}, 0));
    b.show("profiles", frame, slab({-x, at - 0.012f, tray}, {-x + 0.025f, at + 0.012f, z}, 0.002f));
    b.show("profiles", frame,
           slab({-x + 0.025f, at - 0.008f, tray}, {x - 0.02f, at + 0.008f, tray + 0.012f}, 0.002f));
    b.show("profiles", frame,
           slab({x - 0.032f, at - 0.010f, tray}, {x - 0.016f, at + 0.010f, z}, 0.002f));
    b.collide_box({-x, at - 0.010f, tray - 0.02f}, {x - 0.016f, at + 0.010f, z});
  }
  b.show("profiles", frame,
         slab({x - 0.030f, -y + 0.02f, z - 0.018f}, {x - 0.018f, y - 0.02f, z}, 0.002f));
}

void Shower::show_mixer(PropPart& b) const {
  b.show("mixer", chrome,
         bar({back + 0.05f, -0.13f, 1.10f}, {back + 0.05f, 0.13f, 1.10f}, 0.021f, 0.021f, 20));
  for (const float side : {-1.0f, 1.0f}) {
    b.show("mixer", chrome,
           bar({back, side * 0.075f, 1.10f}, {back + 0.012f, side * 0.075f, 1.10f}, 0.032f, 0.030f,
               24));
    b.show("mixer", chrome,
           bar({back, side * 0.075f, 1.10f}, {back + 0.05f, side * 0.075f, 1.10f}, 0.014f, 0.014f,
               14));
    b.show("handles", chrome,
           bar({back + 0.05f, side * 0.134f, 1.10f}, {back + 0.05f, side * 0.175f, 1.10f}, 0.024f,
               0.022f, 18));
  }
}

void Shower::show_riser(PropPart& b) const {
  b.show("riser", chrome,
         tube(smooth_path({{back + 0.05f, 0, 1.11f},
                           {back + 0.05f, 0, 1.5f},
                           {back + 0.05f, 0, high - 0.10f},
                           {back + 0.08f, 0, high - 0.02f},
                           {back + 0.16f, 0, high},
                           {back + 0.36f, 0, high}},
                          5),
              0.011f, 14));
  b.show("riser", chrome,
         bar({back, 0, high - 0.2f}, {back + 0.05f, 0, high - 0.2f}, 0.014f, 0.012f, 14));
  b.show("rose", chrome,
         lathe(rounded({{0, high - 0.045f},
                        {0.11f, high - 0.045f},
                        {0.11f, high - 0.037f},
                        {0.025f, high - 0.03f},
                        {0.018f, high},
                        {0, high}},
                       0.004f),
               40)
             .moved(back + 0.35f, 0, 0));
  b.show("holder", chrome,
         slab({back + 0.03f, -0.02f, 1.475f}, {back + 0.10f, 0.02f, 1.515f}, 0.008f, 2));
  show_hand_shower(&b, chrome, {back + 0.085f, 0, 1.47f});
  b.show("hose", chrome,
         tube(smooth_path({{back + 0.085f, 0, 1.475f},
                           {back + 0.07f, 0.05f, 1.2f},
                           {back + 0.06f, 0.11f, 0.80f},
                           {back + 0.06f, 0.06f, 0.62f},
                           {back + 0.06f, 0.0f, 0.80f},
                           {back + 0.055f, -0.01f, 1.08f}},
                          8),
              0.007f, 10));
}

void Shower::show_handle(PropPart& door, float grip) const {
  const float zg = 0.95f;
  for (const float out : {-2 * t - 0.03f, 0.03f}) {
    door.show("handle", frame,
              bar({out, grip, zg - 0.13f}, {out, grip, zg + 0.13f}, 0.008f, 0.008f, 14));
    for (const float at : {-0.1f, 0.1f})
      door.show(
          "handle", frame,
          bar({out, grip, zg + at}, {out > 0 ? 0 : -2 * t, grip, zg + at}, 0.006f, 0.006f, 10));
    door.collide_capsule({out, grip, zg - 0.12f}, {out, grip, zg + 0.12f}, 0.008f);
  }
}

void Shower::hang_door(Prop& p) const {
  const float side = shop.dice.chance(0.5) ? 1.0f : -1.0f, width = 2 * y - 0.08f,
              tall = z - 0.03f - tray;
  PropPart& door = p.hang("door", {x - 0.022f, side * (y - 0.04f), tray + 0.01f},
                          upright_hinge(-side, 1.7, 0.8));
  const auto span = [&](float a, float c) {
    return std::pair{min(-side * a, -side * c), max(-side * a, -side * c)};
  };
  const auto [y0, y1] = span(0.004f, width - 0.004f);
  door.show("pane", shop.glass(), slab({-2 * t, y0, 0}, {0, y1, tall}, 0));
  const auto [e0, e1] = span(width - 0.014f, width - 0.002f);
  door.show("edge", frame, slab({-2 * t - 0.003f, e0, 0}, {0.003f, e1, tall}, 0.002f));
  for (const float at : {0.18f, tall - 0.25f}) {
    const auto [h0, h1] = span(-0.012f, 0.05f);
    door.show("hinges", frame, slab({-0.014f, h0, at}, {0.007f, h1, at + 0.07f}, 0.003f));
  }
  show_handle(door, -side * (width - 0.07f));
  door.collide_box({-2 * t, y0, 0}, {0, y1, tall});
  door.mass = 2500.0 * 2 * t * width * tall + 1;
}

Prop shower(Workshop& shop) {
  const Shower s(shop);
  Prop p;
  PropPart& b = p.body();
  s.show_tray(b);
  s.show_panes(b);
  s.show_mixer(b);
  s.show_riser(b);
  b.collide_box({s.back, -0.17f, 1.075f}, {s.back + 0.075f, 0.17f, 1.125f});
  b.collide_capsule({s.back + 0.05f, 0, 1.12f}, {s.back + 0.05f, 0, s.high - 0.05f}, 0.012f);
  b.collide_cylinder(0.11f, s.high - 0.045f, s.high, s.back + 0.35f, 0);
  b.mass = 2500.0 * 0.006 * 4 * s.x * s.z + 30;  // glass of 6 mm
  s.hang_door(p);
  p.front = 0.6f;
  return p;
}

constexpr PropKind kBathing[] = {
    {"bathtub", bathtub, "built-in bathtub with mixer and hand shower"},
    {"shower", shower, "glass cubicle with tray, mixer and hinged door"},
};

}  // namespace

PropFamily bathing() { return kBathing; }

}  // namespace gloam
