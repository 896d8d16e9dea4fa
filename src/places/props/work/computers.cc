// Computers and what belongs to them.

#include <cmath>

#include "places/props/parts/hardware.h"
#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// Keys in rows on a plate that lies on z; each row: widths in units of a pitch of 19 mm.
Solid keys(float x_front, float width, float z, float pitch, float tall) {
  static const std::vector<std::vector<float>> kRows = {
      {1.25f, 1.25f, 1.25f, 6.25f, 1.25f, 1.25f, 1.25f, 1.25f},
      {2.25f, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2.75f},
      {1.75f, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2.25f},
      {1.5f, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1.5f},
      {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2}};
  Solid out;
  for (size_t r = 0; r < kRows.size(); ++r) {
    float y = -width / 2;
    for (const float w : kRows[r]) {
      const float x = x_front - pitch * (float(r) + 0.5f), g = 0.0012f;
      out += slab({x - pitch / 2 + g, y + g, z}, {x + pitch / 2 - g, y + w * pitch - g, z + tall},
                  0.0012f);
      y += w * pitch;
    }
  }
  return out;
}

// Sits before its user: the user is at +x, keys read from there with y to the right reversed.
Prop keyboard(Workshop& shop) {
  const bool pale = shop.dice.chance(0.35);
  constexpr float kPitch = 0.019f, kWidth = 15 * kPitch;
  Prop p;
  PropPart& b = p.body();
  b.show("case", shop.plastic(pale ? kSilver : kBlackPlastic, 0.45),
         extrude(rounded_outline({{-0.065f, 0}, {0.065f, 0}, {0.065f, 0.010f}, {-0.065f, 0.020f}},
                                 0.003f, 2),
                 -0.222f, 0.222f)
             .turned(Axis::kX, 90));
  const Solid main = keys(0.052f, kWidth, 0, kPitch, 0.006f);
  const std::string caps =
      shop.plastic(pale ? Vec3{0.86, 0.86, 0.85} : Vec3{0.13, 0.13, 0.135}, 0.5);
  Solid pad;
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 4; ++c)
      pad += rounded_box({kPitch - 0.0024f, kPitch - 0.0024f, 0.006f}, 0.0012f)
                 .moved(0.052f - kPitch * (float(r) + 0.5f),
                        0.142f + kPitch * (float(c) + 0.5f) - 0.005f, 0.003f);
  b.show("keys", caps,
         (main.moved(0, -0.068f, 0) + pad).turned(Axis::kY, 4.4f).moved(0, 0, 0.0145f));
  b.show("cable", shop.plastic(kBlackPlastic, 0.4),
         tube(smooth_path(
                  {{-0.062f, -0.05f, 0.008f}, {-0.09f, -0.05f, 0.003f}, {-0.13f, -0.03f, 0.003f}}),
              0.0022f, 6));
  b.collide_box({-0.065f, -0.222f, 0}, {0.065f, 0.222f, 0.018f});
  b.mass = 0.6;
  p.loose = true;
  return p;
}

Prop laptop(Workshop& shop) {
  Dice& dice = shop.dice;
  const float width = dice.pick({0.305f, 0.325f, 0.356f}), deep = 0.69f * width, thick = 0.009f;
  const double open = dice.uniform(1.70, 2.0);  // between lid and keyboard [rad]
  Prop p;
  PropPart& b = p.body();
  const std::string metal =
      dice.chance(0.6) ? shop.metal("aluminium") : shop.plastic({0.09, 0.09, 0.095}, 0.4);
  const float x = deep / 2, y = width / 2;
  b.show("case", metal, slab({-x, -y, 0.0015f}, {x, y, 0.0015f + thick}, 0.0035f, 2));
  b.show("feet", shop.rubber(), round_legs(x - 0.02f, y - 0.025f, 0.003f, 0.006f, 0.006f, 0));
  const float top = 0.0015f + thick, pitch = 0.92f * width / 15;
  b.show("well", shop.plastic({0.02, 0.02, 0.022}, 0.6),
         slab({x - 0.09f - 5.1f * pitch, -7.6f * pitch, top - 0.001f},
              {x - 0.09f, 7.6f * pitch, top + 0.0002f}, 0));
  b.show("keys", shop.plastic({0.12, 0.12, 0.125}, 0.5),
         keys(x - 0.091f, 15 * pitch, top, pitch, 0.0012f));
  b.show("touchpad", shop.plastic({0.45, 0.45, 0.46}, 0.3),
         slab({x - 0.082f, -0.055f, top - 0.001f}, {x - 0.008f, 0.055f, top + 0.0003f}, 0));
  PropPart& lid = p.hang("lid", {-x + 0.004f, 0, top + 0.002f},
                         {.axis = {0, -1, 0},
                          .low = 0,
                          .high = 2.3,
                          .initial = open,
                          .damping = 0.02,
                          .friction = 0.45});
  // Closed it lies on the keys, from its hinge to +x.
  const float lid_thick = 0.005f;
  lid.show("cover", metal, slab({0, -y, 0}, {deep - 0.004f, y, lid_thick}, 0.002f, 2));
  lid.show("bezel", shop.plastic(kBlackPlastic, 0.4),
           slab({0.006f, -y + 0.003f, -0.0004f}, {deep - 0.007f, y - 0.003f, 0.001f}, 0));
  lid.show("screen", dice.chance(0.5) ? screen_glass(shop) : shop.glow({0.34, 0.46, 0.60}, 120),
           slab({0.016f, -y + 0.008f, -0.0007f}, {deep - 0.012f, y - 0.008f, 0.0f}, 0));
  lid.collide_box({0.004f, -y, -0.0005f}, {deep - 0.004f, y, lid_thick});
  lid.mass = 0.45;
  b.show("hinge", shop.plastic(kBlackPlastic, 0.4),
         bar({-x + 0.004f, -0.4f * width, top + 0.002f}, {-x + 0.004f, 0.4f * width, top + 0.002f},
             0.0042f, 0.0042f, 12));
  b.collide_box({-x, -y, 0}, {x, y, top});
  b.mass = 1.05;
  p.loose = true;
  return p;
}

Prop printer(Workshop& shop) {
  Prop p;
  PropPart& b = p.body();
  const bool black = shop.dice.chance(0.4);
  const std::string body = shop.plastic(black ? Vec3{0.125, 0.125, 0.128} : Vec3{0.80, 0.80, 0.79},
                                        0.45),
                    dark = shop.plastic({0.135, 0.135, 0.138}, 0.4);
  b.show("case", body,
         slab({-0.18f, -0.225f, 0.006f}, {0.14f, 0.225f, 0.055f}, 0.008f, 2) +
             slab({-0.18f, -0.225f, 0.145f}, {0.17f, 0.225f, 0.19f}, 0.012f, 2) +
             slab({-0.18f, -0.225f, 0.05f}, {0.14f, -0.165f, 0.15f}, 0.006f) +
             slab({-0.18f, 0.165f, 0.05f}, {0.14f, 0.225f, 0.15f}, 0.006f) +
             slab({-0.18f, -0.17f, 0.05f}, {-0.02f, 0.17f, 0.15f}, 0));
  b.show("slot", shop.plastic({0.01, 0.01, 0.011}, 0.9),
         slab({-0.021f, -0.165f, 0.056f}, {-0.019f, 0.165f, 0.145f}, 0));
  b.show("lid", dark, slab({-0.17f, -0.215f, 0.190f}, {0.125f, 0.215f, 0.207f}, 0.006f, 2));
  b.show("panel", dark,
         slab({-0.01f, -0.105f, -0.004f}, {0.002f, 0.105f, 0.022f}, 0.002f)
             .turned(Axis::kY, -20)
             .moved(0.168f, 0, 0.158f));
  b.show("display", shop.glow({0.30, 0.48, 0.66}, 90),
         slab({0.0018f, -0.035f, -0.001f}, {0.0024f, 0.035f, 0.020f}, 0)
             .turned(Axis::kY, -20)
             .moved(0.168f, 0, 0.158f));
  b.show("tray", dark, slab({-0.015f, -0.13f, 0.056f}, {0.21f, 0.13f, 0.061f}, 0.002f));
  for (int k = 0; k < 3; ++k)
    b.show("sheets", shop.paper({0.88, 0.88, 0.87}),
           slab({0.005f, -0.105f, 0.0f}, {0.205f, 0.105f, 0.0006f}, 0)
               .turned(Axis::kZ, 1.5f * float(k - 1))
               .moved(0, 0, 0.0612f + 0.0007f * float(k)));
  b.show("feet", shop.rubber(),
         round_legs(0.13f, 0.18f, 0.008f, 0.012f, 0.012f, 0).moved(-0.02f, 0, 0));
  b.collide_box({-0.18f, -0.225f, 0}, {0.14f, 0.225f, 0.055f});
  b.collide_box({-0.18f, -0.225f, 0.055f}, {-0.02f, 0.225f, 0.145f});
  b.collide_box({-0.18f, -0.225f, 0.145f}, {0.17f, 0.225f, 0.205f});
  b.collide_box({0.14f, -0.13f, 0.05f}, {0.21f, 0.13f, 0.063f});
  b.mass = 6.5;
  p.loose = true;
  p.front = 0.1f;
  return p;
}

constexpr PropKind kComputers[] = {
    {"laptop", laptop, "laptop computer, its lid turns"},
    {"keyboard", keyboard, "computer keyboard"},
    {"printer", printer, "desktop printer"},
};

}  // namespace

PropFamily computers() { return kComputers; }

}  // namespace gloam
