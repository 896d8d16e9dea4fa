// Screens and loudspeakers.

#include <cmath>

#include "places/props/parts/hardware.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// A flat screen that faces +x: its bezel, glass and bulging back. `bottom` = of the case.
void show_screen(PropPart* b, Workshop& shop, const std::string& material, float width,
                 float height, float bottom, float rim) {
  const float y = width / 2, top = bottom + height, mid = (bottom + top) / 2;
  b->show("case", material, slab({-0.018f, -y, bottom}, {0.010f, y, top}, 0.004f, 2));
  b->show("case", material,
          rounded_box({0.04f, 0.62f * width, 0.55f * height}, 0.014f, 2)
              .moved(-0.030f, 0, mid - 0.12f * height));
  b->show("screen", screen_glass(shop),
          slab({0.0095f, -y + rim, bottom + 1.6f * rim}, {0.0106f, y - rim, top - rim}, 0));
  // Vents of the back.
  for (int k = 0; k < 7; ++k)
    b->show("vents", shop.plastic({0.008, 0.008, 0.009}, 0.8),
            slab({-0.0506f, -0.2f * width, mid - 0.035f * float(k) * height - 0.002f},
                 {-0.0500f, 0.2f * width, mid - 0.035f * float(k) * height + 0.002f}, 0));
}

Prop television(Workshop& shop) {
  Dice& dice = shop.dice;
  const double inches = dice.pick({43.0, 50.0, 55.0, 65.0});
  const float usual = float(0.0254 * inches * 0.8716) + 0.012f;  // width of a 16:9 diagonal
  const float width = limited(shop.size({0.25f, usual, 1}), {0, 0.5f, 0}, {10, 2.2f, 10}).y,
              height = 0.5625f * width + 0.012f, bottom = 0.07f;
  Prop p;
  PropPart& b = p.body();
  const std::string black = shop.plastic(kBlackPlastic, 0.4);
  show_screen(&b, shop, black, width, height, bottom, 0.007f);
  const float deep = 0.11f + 0.03f * width;
  if (dice.chance(0.5)) {
    for (const float side : {-1.0f, 1.0f}) {
      const float y = side * 0.36f * width;
      b.show(
          "feet", black,
          bar({-0.01f, y, bottom + 0.02f}, {deep, y + side * 0.02f, 0.006f}, 0.007f, 0.006f, 10) +
              bar({-0.01f, y, bottom + 0.02f}, {-deep, y + side * 0.02f, 0.006f}, 0.007f, 0.006f,
                  10));
      b.collide_box({-deep, y - 0.02f, 0}, {deep, y + 0.02f, 0.012f});
      b.collide_box({-0.02f, y - 0.02f, 0.012f}, {0.012f, y + 0.02f, bottom});
    }
  } else {
    b.show("feet", black,
           slab({-deep, -0.20f * width, 0}, {deep, 0.20f * width, 0.010f}, 0.004f, 2));
    b.show("neck", black,
           slab({-0.035f, -0.05f * width, 0.006f}, {-0.012f, 0.05f * width, bottom + 0.05f}, 0.004f,
                2));
    b.collide_box({-deep, -0.20f * width, 0}, {deep, 0.20f * width, 0.010f});
    b.collide_box({-0.035f, -0.05f * width, 0.010f}, {-0.012f, 0.05f * width, bottom});
  }
  b.show("light", shop.glow({0.9, 0.08, 0.05}, 60),
         slab({0.0100f, 0.46f * width, bottom + 0.004f},
              {0.0108f, 0.46f * width + 0.004f, bottom + 0.007f}, 0));
  b.collide_box({-0.05f, -width / 2, bottom}, {0.0106f, width / 2, bottom + height});
  b.mass = 11.0 * double(width);  // 43 inches: 10 kg, 65 inches: 16 kg
  p.loose = true;
  return p;
}

Prop monitor(Workshop& shop) {
  Dice& dice = shop.dice;
  const float width = limited(shop.size({0.2f, float(dice.pick({0.54, 0.61, 0.71})), 0.5f}),
                              {0, 0.4f, 0}, {10, 1.2f, 10})
                          .y;
  const float height = (width > 0.7f ? 0.43f : 0.5625f) * width + 0.02f, bottom = 0.11f;
  Prop p;
  PropPart& b = p.body();
  const std::string body = shop.plastic(dice.chance(0.75) ? kBlackPlastic : kSilver, 0.4);
  show_screen(&b, shop, body, width, height, bottom, 0.008f);
  b.show("stand", body,
         slab({-0.09f, -0.12f, 0}, {0.10f, 0.12f, 0.012f}, 0.005f, 2) +
             slab({-0.068f, -0.03f, 0.01f}, {-0.050f, 0.03f, bottom + 0.6f * height}, 0.006f, 2));
  b.show("cable", shop.plastic(kBlackPlastic, 0.4),
         tube(smooth_path({{-0.055f, 0.05f, bottom + 0.15f * height},
                           {-0.085f, 0.05f, 0.08f},
                           {-0.09f, 0.03f, 0.01f},
                           {-0.12f, 0.06f, 0.004f}}),
              0.003f, 6));
  b.collide_box({-0.09f, -0.12f, 0}, {0.10f, 0.12f, 0.012f});
  b.collide_box({-0.068f, -0.03f, 0.012f}, {-0.05f, 0.03f, bottom + 0.5f * height});
  b.collide_box({-0.05f, -width / 2, bottom}, {0.0106f, width / 2, bottom + height});
  b.mass = 9.0 * double(width);
  p.loose = true;
  return p;
}

// One cone in its ring, on the plane x = at.x, facing +x.
void show_driver(PropPart* b, Workshop& shop, Vec3 cone, Vec3f at, float r) {
  b->show("rings", shop.plastic({0.125, 0.125, 0.127}, 0.35),
          lathe(rounded({{1.02f * r, 0}, {r, 0.008f}, {0.88f * r, 0.008f}, {0.86f * r, 0.001f}},
                        0.003f, 3),
                36)
              .turned(Axis::kY, 90)
              .moved(at));
  // From the rim inwards: surround, cone, with its front to +x.
  b->show("cones", shop.paper(cone),
          lathe(rounded({{0.88f * r, 0.004f},
                         {0.81f * r, 0.0085f},
                         {0.74f * r, 0.0055f},
                         {0.28f * r, 0.001f},
                         {0, 0.001f}},
                        0.06f * r, 3),
                36)
              .turned(Axis::kY, 90)
              .moved(at));
  b->show("caps", shop.plastic({0.125, 0.125, 0.127}, 0.3),
          ball(0.28f * r, 20)
              .scaled({1, 1, 0.3f})
              .turned(Axis::kY, 90)
              .moved(at + Vec3f{0.001f, 0, 0}));
}

Prop speaker(Workshop& shop) {
  Vec3f size = limited(
      shop.size(shop.dice.chance(0.6) ? Vec3f{0.26f, 0.19f, 0.32f} : Vec3f{0.30f, 0.20f, 0.95f}),
      {0.1f, 0.09f, 0.14f}, {0.45f, 0.35f, 1.3f});
  size.z = max(size.z, 0.22f + 0.72f * size.y);  // room for the cones
  const float x = size.x / 2, y = size.y / 2, z = size.z, foot = 0.006f;
  Prop p;
  PropPart& b = p.body();
  b.show("box",
         shop.dice.chance(0.6) ? shop.wood(Axis::kZ)
                               : shop.paint(shop.color({0.145, 0.145, 0.15}), 0.35),
         slab({-x, -y, foot}, {x - 0.012f, y, z}, 0.004f, 2));
  b.show(
      "baffle", shop.plastic({0.125, 0.125, 0.128}, 0.5),
      slab({x - 0.013f, -y + 0.002f, foot + 0.002f}, {x - 0.005f, y - 0.002f, z - 0.002f}, 0.003f));
  const float r = 0.72f * y, face = x - 0.005f;
  const int count = std::clamp(int((z - 0.205f) / (2 * r + 0.02f)), 1, 3);
  const Vec3 cone =
      shop.dice.pick<Vec3>({{0.24, 0.24, 0.25}, {0.72, 0.58, 0.24}, {0.70, 0.70, 0.69}});
  show_driver(&b, shop, cone, {face, 0, z - 0.05f - 0.035f}, min(0.034f, 0.3f * y + 0.008f));
  for (int k = 0; k < count; ++k)
    show_driver(&b, shop, cone, {face, 0, z - 0.145f - r - (2 * r + 0.02f) * float(k)}, r);
  b.show("port", shop.plastic({0.008, 0.008, 0.009}, 0.9),
         cylinder(min(0.3f * y, 0.034f), 0, 0.0012f, 0.0003f, 24)
             .turned(Axis::kY, 90)
             .moved(face, 0, foot + 0.04f));
  b.show("feet", shop.rubber(),
         round_legs(x - 0.03f, y - 0.025f, foot + 0.001f, 0.010f, 0.010f, 0));
  b.collide_box({-x, -y, 0}, {x - 0.003f, y, z});
  b.mass = 330.0 * double(size.x * size.y * size.z) + 0.5;  // a cabinet of 4 kg for 12 l
  p.loose = true;
  return p;
}

constexpr PropKind kElectronics[] = {
    {"television", television, "flat television on feet, 43 to 65 inches"},
    {"monitor", monitor, "computer screen on a stand"},
    {"speaker", speaker, "loudspeaker, for shelves or floors"},
};

}  // namespace

PropFamily electronics() { return kElectronics; }

}  // namespace gloam
