// Washing machines and dryers.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

// A turned profile (r, x) about the axis through the middle of a porthole: its z becomes +x.
Solid about_x(const Profile& profile, Vec3f middle, int segments = 44) {
  return lathe(profile, segments).turned(Axis::kY, 90).moved(middle);
}

// A front-loader; a dryer has a plain door, no drawer for soap and a grille. The frame is the
// prop's; x, y are half its size, z its height [m].
struct FrontLoader {
  FrontLoader(Workshop& maker, bool is_dryer) : shop(maker), dryer(is_dryer) {
    const Vec3f size = shop.size({0.60f, 0.60f, 0.85f});
    x = std::clamp(size.x, 0.45f, 0.70f) / 2, y = std::clamp(size.y, 0.50f, 0.70f) / 2,
    z = std::clamp(size.z, 0.75f, 0.95f);
    white = shop.paint(
        shop.color(shop.dice.chance(0.75) ? Vec3{0.91, 0.91, 0.90} : Vec3{0.36, 0.37, 0.39}), 0.22);
    dark = shop.plastic({0.05, 0.05, 0.055}, 0.2), steel = shop.metal("steel"),
    chrome = shop.metal("chrome");
    face = x - 0.012f, panel = z - 0.145f;
    port = {face, 0, low + 0.50f * (panel - low) + 0.02f};
    hole = dryer ? 0.19f : 0.175f;
  }

  void show_case(PropPart& b) const;
  void show_inside(PropPart& b) const;
  void show_controls(PropPart& b) const;
  void show_dryer_or_washer(PropPart& b) const;
  void collide(PropPart& b) const;
  void hang_door(Prop& p) const;
  void show_disc(PropPart& door, Vec3f middle, float rim) const;
  void show_porthole(PropPart& door, Vec3f middle) const;

  Workshop& shop;
  const bool dryer;
  float x = 0, y = 0, z = 0;
  std::string white, dark, steel, chrome;
  // Front of the case, bottom of the panel, radius of the hole.
  float face = 0, panel = 0, hole = 0;
  const float low = 0.012f;  // bottom of the case
  Vec3f port;                // middle of the hole
};

void FrontLoader::show_case(PropPart& b) const {
  // The front: a sheet with a round hole, turned up from a level plate.
  const auto square = [&](float in, float at) {
    return ring({-panel + in, -y + in}, {-0.09f - in, y - in}, 0.008f, at, 10);
  };
  const auto round = [&](float r, float at) {
    return ring({-port.z - r, -r}, {-port.z + r, r}, r, at, 10);
  };
  b.show("case", white,
         loft({square(0, -0.01f), square(0, -0.002f), square(0.002f, 0), round(hole + 0.012f, 0),
               round(hole, -0.012f), round(hole, -0.05f)})
             .turned(Axis::kY, 90)
             .moved(face, 0, 0));
  b.show("case", white,
         slab({-x + 0.02f, -y, low}, {face - 0.006f, -y + 0.012f, z - 0.03f}, 0.004f));
  b.show("case", white, slab({-x + 0.02f, y - 0.012f, low}, {face - 0.006f, y, z - 0.03f}, 0.004f));
  b.show("case", white,
         slab({-x + 0.02f, -y + 0.01f, low}, {-x + 0.028f, y - 0.01f, z - 0.03f}, 0));
  b.show("kick", white,
         slab({face - 0.02f, -y + 0.001f, low}, {face - 0.001f, y - 0.001f, 0.087f}, 0.004f));
  b.show("case", white, slab({-x, -y, z - 0.028f}, {x, y, z}, 0.009f, 3));
  b.show("panel", white,
         slab({face - 0.03f, -y, panel + 0.003f}, {x - 0.003f, y, z - 0.030f}, 0.006f, 2));
  b.show("flap", white,
         slab({face - 0.01f, y - 0.16f, 0.022f}, {face + 0.002f, y - 0.05f, 0.078f}, 0.003f));
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f})
      b.show("feet", shop.rubber(),
             cylinder(0.022f, 0, low + 0.004f, 0.002f, 16)
                 .moved(sx * (x - 0.06f), sy * (y - 0.05f), 0));
}

void FrontLoader::show_inside(PropPart& b) const {
  b.show("gasket", shop.rubber({0.28, 0.28, 0.29}),
         about_x(rounded({{hole, -0.05f},
                          {hole - 0.022f, -0.03f},
                          {hole - 0.030f, -0.055f},
                          {hole - 0.012f, -0.075f},
                          {hole - 0.03f, -0.10f}},
                         0.012f, 3),
                 port));
  const float r = min(0.24f, min(y - 0.03f, panel - port.z));
  Solid drum = about_x({{0.01f, -2 * x + 0.10f},
                        {r - 0.02f, -2 * x + 0.10f},
                        {r, -2 * x + 0.12f},
                        {r, -0.12f},
                        {hole - 0.03f, -0.09f}},
                       port);
  b.show("drum", steel, drum);
  for (int i = 0; i < 3; ++i)
    b.show("paddles", steel,
           slab({-0.14f, -0.016f, -r}, {0.12f, 0.016f, -r + 0.045f}, 0.014f, 2)
               .turned(Axis::kX, 120 * float(i) + 25)
               .moved(port.x - 0.28f, 0, port.z));
}

void FrontLoader::show_controls(PropPart& b) const {
  const float zc = (panel + z - 0.03f) / 2, fp = x - 0.003f;
  b.show("knob", chrome, knob(0.027f, 0.022f, {fp, 0, zc}));
  b.show("dial", dark,
         about_x(rounded({{0.034f, 0}, {0.033f, 0.002f}, {0, 0.002f}}, 0.001f),
                 {fp - 0.0008f, 0, zc}));
  b.show("display", dark,
         slab({fp - 0.002f, 0.07f, zc - 0.022f}, {fp + 0.001f, y - 0.05f, zc + 0.022f}, 0.001f));
  b.show("digits", shop.glow({1, 0.62, 0.30}, 120),
         slab({fp, 0.088f, zc - 0.008f}, {fp + 0.0013f, 0.092f, zc + 0.008f}, 0) +
             slab({fp, 0.102f, zc - 0.008f}, {fp + 0.0013f, 0.106f, zc + 0.008f}, 0) +
             slab({fp, 0.112f, zc - 0.008f}, {fp + 0.0013f, 0.116f, zc + 0.008f}, 0));
  for (int i = 0; i < 4; ++i)
    b.show("keys", chrome,
           knob(0.006f, 0.002f, {fp + 0.0005f, 0.16f + 0.022f * float(i), zc - 0.008f}));
}

void FrontLoader::show_dryer_or_washer(PropPart& b) const {
  const float fp = x - 0.003f;
  if (dryer) {
    for (int i = 0; i < 7; ++i)
      b.show("grille", dark,
             slab({face - 0.002f, -y + 0.06f, 0.024f + 0.008f * float(i)},
                  {face + 0.0012f, y - 0.22f, 0.028f + 0.008f * float(i)}, 0));
  } else {
    b.show("drawer", white,
           slab({fp - 0.01f, -y + 0.012f, panel + 0.012f}, {fp + 0.006f, -y + 0.20f, z - 0.040f},
                0.004f, 2));
    b.show(
        "grip", dark,
        slab({fp, -y + 0.05f, panel + 0.018f}, {fp + 0.0066f, -y + 0.16f, panel + 0.032f}, 0.002f));
    b.show("hoses", shop.rubber({0.20, 0.20, 0.21}),
           tube(smooth_path({{-x + 0.03f, 0.15f, 0.75f * z},
                             {-x + 0.012f, 0.15f, 0.72f * z},
                             {-x + 0.012f, 0.12f, 0.30f},
                             {-x + 0.012f, 0.05f, 0.02f}},
                            6),
                0.011f, 10));
  }
}

void FrontLoader::collide(PropPart& b) const {
  b.collide_box({-x, -y, 0}, {face - 0.055f, y, z});
  b.collide_box({face - 0.055f, -y, panel}, {x, y, z});
  b.collide_box({face - 0.055f, -y, 0}, {face, y, port.z - hole});
  for (const float side : {-1.0f, 1.0f})
    b.collide_box({face - 0.055f, side > 0 ? hole : -y, port.z - hole},
                  {face, side > 0 ? y : -hole, panel});
  b.mass = dryer ? 46 : 66;
}

void FrontLoader::show_disc(PropPart& door, Vec3f middle, float rim) const {
  door.show("disc", dark,
            about_x(rounded({{rim - 0.05f, 0.022f}, {rim - 0.08f, 0.024f}, {0, 0.026f}}, 0.002f),
                    middle));
  door.show("inner", white,
            about_x(rounded({{0, -0.05f},
                             {hole - 0.03f, -0.05f},
                             {hole - 0.015f, -0.02f},
                             {hole - 0.02f, 0.004f}},
                            0.01f),
                    middle));
}

void FrontLoader::show_porthole(PropPart& door, Vec3f middle) const {
  door.show(
      "glass", shop.glass(),
      about_x(
          rounded({{0, -0.085f}, {0.08f, -0.080f}, {hole - 0.06f, -0.02f}, {hole - 0.035f, 0.012f}},
                  0.03f, 4),
          middle));
  door.show("tint", shop.plastic({0.10, 0.11, 0.12}, 0.06),
            about_x({{hole - 0.034f, 0.014f}, {hole - 0.052f, 0.016f}}, middle));
  door.show(
      "pane", shop.glass(),
      about_x(rounded({{hole - 0.050f, 0.016f}, {0.06f, 0.027f}, {0, 0.029f}}, 0.02f), middle));
}

void FrontLoader::hang_door(Prop& p) const {
  // Hinged on the left, its hinge outside of the ring.
  const float rim = hole + 0.028f, hinge = rim + 0.012f;
  PropPart& door = p.hang("door", {face + 0.008f, -hinge, port.z}, upright_hinge(1, 2.4, 0.3));
  const Vec3f middle{-0.006f, hinge, 0};
  const std::string frame = shop.dice.chance(0.5) ? chrome : white;
  const Profile hoop = rounded({{rim - 0.055f, 0},
                                {rim - 0.004f, 0},
                                {rim, 0.006f},
                                {rim - 0.004f, 0.026f},
                                {rim - 0.025f, 0.034f},
                                {rim - 0.050f, 0.026f},
                                {rim - 0.060f, 0.012f}},
                               0.008f, 3);
  door.show("ring", frame, about_x(hoop, middle, 52));
  if (dryer)
    show_disc(door, middle, rim);
  else
    show_porthole(door, middle);
  door.show("hinge", frame, slab({-0.006f, -0.004f, -0.05f}, {0.012f, 0.03f, 0.05f}, 0.004f, 2));
  door.show("grip", dark,
            slab({0.012f, 2 * rim - 0.02f, -0.045f}, {0.026f, 2 * rim + 0.004f, 0.045f}, 0.006f, 2)
                .moved(0, hinge - rim, 0));
  door.collide_cylinder({-0.004f, hinge, 0}, {0.026f, hinge, 0}, rim);
  if (!dryer) door.collide_cylinder({-0.08f, hinge, 0}, {-0.004f, hinge, 0}, hole - 0.07f);
  door.mass = 2.4;
}

Prop front_loader(Workshop& shop, bool dryer) {
  const FrontLoader m(shop, dryer);
  Prop p;
  PropPart& b = p.body();
  m.show_case(b);
  m.show_inside(b);
  m.show_controls(b);
  m.show_dryer_or_washer(b);
  m.collide(b);
  m.hang_door(p);
  p.surfaces.push_back({{-m.x + 0.03f, -m.y + 0.03f}, {m.x - 0.03f, m.y - 0.03f}, m.z, 0.5f});
  p.front = 0.7f;
  return p;
}

Prop washing_machine(Workshop& shop) { return front_loader(shop, false); }
Prop tumble_dryer(Workshop& shop) { return front_loader(shop, true); }

constexpr PropKind kLaundry[] = {
    {"washing_machine", washing_machine, "front-loading washing machine with a hinged porthole"},
    {"tumble_dryer", tumble_dryer, "tumble dryer with a hinged round door"},
};

}  // namespace

PropFamily laundry() { return kLaundry; }

}  // namespace gloam
