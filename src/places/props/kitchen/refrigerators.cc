// Refrigerators.

#include <algorithm>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Prop refrigerator(Workshop& shop) {
  const Vec3f size = shop.size({0.65f, 0.60f, float(shop.dice.uniform(1.55, 2.0))});
  const float x = std::clamp(size.x, 0.55f, 0.80f) / 2, y = std::clamp(size.y, 0.50f, 0.95f) / 2;
  const float z = std::clamp(size.z, 1.20f, 2.10f), t = 0.05f, leaf = 0.055f;
  const std::string shell = appliance_casing(shop), liner = shop.plastic({0.91, 0.92, 0.92}, 0.3);
  Prop p;
  PropPart& b = p.body();
  const float body = x - leaf - 0.008f, low = 0.04f, split = low + 0.36f * (z - low);
  const auto block = [&](Vec3f from, Vec3f to) {
    b.show("shell", shell, slab(from, to, 0.003f));
    b.collide_box(from, to);
  };
  block({-x + 0.03f, -y, low}, {body, -y + t, z});
  block({-x + 0.03f, y - t, low}, {body, y, z});
  block({-x + 0.03f, -y + t, z - t}, {body, y - t, z});
  block({-x + 0.03f, -y + t, low}, {body, y - t, low + 0.08f});
  block({-x + 0.03f, -y + t, low + 0.08f}, {-x + 0.03f + t, y - t, z - t});
  b.show("liner", liner,
         slab({-x + 0.03f + t, -y + t, split - 0.03f}, {body, y - t, split + 0.03f}, 0.003f));
  b.collide_box({-x + 0.03f + t, -y + t, split - 0.03f}, {body, y - t, split + 0.03f});
  const float back = -x + 0.03f + t, in = y - t;
  const auto line = [&](float z0, float z1) {  // moulded plastic
    b.show("liner", liner, slab({back, -in, z0}, {back + 0.004f, in, z1}, 0));
    b.show("liner", liner, slab({back, -in, z0}, {body, -in + 0.004f, z1}, 0));
    b.show("liner", liner, slab({back, in - 0.004f, z0}, {body, in, z1}, 0));
    b.show("liner", liner, slab({back, -in, z0}, {body, in, z0 + 0.004f}, 0));
    b.show("liner", liner, slab({back, -in, z1 - 0.004f}, {body, in, z1}, 0));
  };
  line(low + 0.08f, split - 0.03f);
  line(split + 0.03f, z - t);
  const int shelves = std::max(2, int((z - split) / 0.27f));
  for (int i = 1; i <= shelves; ++i) {
    const float at = split + 0.03f + (z - t - split - 0.03f) * float(i) / float(shelves + 1);
    b.show("shelves", shop.glass(),
           slab({back + 0.01f, -in + 0.006f, at - 0.005f}, {body - 0.03f, in - 0.006f, at}, 0));
    b.show("trim", liner,
           slab({body - 0.03f, -in + 0.006f, at - 0.010f}, {body - 0.02f, in - 0.006f, at + 0.004f},
                0.003f));
    b.collide_box({back + 0.01f, -in + 0.006f, at - 0.008f}, {body - 0.02f, in - 0.006f, at});
  }
  for (int i = 0; i < 3; ++i) {  // drawers of the freezer
    const float z0 = low + 0.09f + (split - low - 0.12f) * float(i) / 3,
                z1 = z0 + (split - low - 0.12f) / 3 - 0.012f;
    b.show("bins", shop.plastic({0.80, 0.86, 0.90}, 0.15),
           slab({back + 0.01f, -in + 0.01f, z0}, {body - 0.015f, in - 0.01f, z1}, 0.006f));
  }
  b.show("bins", shop.plastic({0.80, 0.86, 0.90}, 0.15),
         slab({back + 0.01f, -in + 0.01f, split + 0.036f},
              {body - 0.03f, in - 0.01f, split + 0.17f}, 0.006f));
  b.show("feet", shop.rubber(),
         slab({-x + 0.06f, -y + 0.02f, 0}, {body - 0.03f, y - 0.02f, low}, 0.002f));
  b.collide_box({-x + 0.06f, -y + 0.02f, 0}, {body - 0.03f, y - 0.02f, low});
  b.show("condenser", shop.metal("black"),
         slab({-x, -y + 0.06f, 0.25f}, {-x + 0.004f, y - 0.06f, z - 0.2f}, 0));
  for (int i = 0; i < 12; ++i)
    b.show("condenser", shop.metal("black"),
           bar({-x + 0.01f, -y + 0.07f, 0.3f + (z - 0.55f) * float(i) / 11},
               {-x + 0.01f, y - 0.07f, 0.3f + (z - 0.55f) * float(i) / 11}, 0.003f, 0.003f, 5));
  for (const float side : {-1.0f, 1.0f})
    b.show("condenser", shop.metal("black"),
           bar({-x + 0.015f, side * (y - 0.1f), 0.4f}, {-x + 0.032f, side * (y - 0.1f), 0.4f},
               0.005f, 0.005f, 6));
  b.mass = 24 + 16 * z;

  const float side = shop.dice.chance(0.5) ? 1.0f : -1.0f;
  const auto hang = [&](const std::string& name, float z0, float z1, float handle) {
    PropPart& door = p.hang(name, {x, side * y, z0}, upright_hinge(-side, 1.9, 0.6));
    const float tall = z1 - z0, y0 = min(0.0f, -side * 2 * y), y1 = y0 + 2 * y,
                yh = -side * (2 * y - 0.05f);
    door.show("door", shell, slab({-leaf, y0, 0}, {0, y1, tall}, 0.008f, 3));
    door.show(
        "seal", shop.rubber({0.55, 0.55, 0.55}),
        slab({-leaf - 0.007f, y0 + 0.015f, 0.015f}, {-leaf, y1 - 0.015f, tall - 0.015f}, 0.003f));
    const std::string metal = shop.metal("steel");
    const float grip = min(0.35f, tall - 0.2f);
    const float h0 = handle > 0 ? 0.10f : tall - 0.10f - grip;
    door.show("handle", metal, bar({0.04f, yh, h0}, {0.04f, yh, h0 + grip}, 0.009f, 0.009f, 14));
    for (const float at : {0.03f, grip - 0.03f})
      door.show("handle", metal,
                bar({-0.002f, yh, h0 + at}, {0.04f, yh, h0 + at}, 0.007f, 0.007f, 10));
    for (int i = 0; i < (handle > 0 ? 3 : 0); ++i) {
      const float at = 0.08f + (tall - 0.2f) * float(i) / 3, a0 = y0 + 0.07f, a1 = y1 - 0.07f;
      door.show("trays", liner,
                slab({-leaf - 0.10f, a0, at}, {-leaf - 0.005f, a1, at + 0.006f}, 0.002f));
      door.show("trays", liner,
                slab({-leaf - 0.10f, a0, at}, {-leaf - 0.094f, a1, at + 0.08f}, 0.002f));
      for (const float end : {a0, a1 - 0.006f})
        door.show(
            "trays", liner,
            slab({-leaf - 0.10f, end, at}, {-leaf - 0.005f, end + 0.006f, at + 0.08f}, 0.002f));
    }
    door.collide_box({-leaf, y0, 0}, {0, y1, tall});
    door.collide_capsule({0.04f, yh, h0}, {0.04f, yh, h0 + grip}, 0.009f);
    door.mass = 9.0 * tall;
  };
  hang("door", split + 0.003f, z, 1);
  hang("freezer_door", low + 0.005f, split - 0.003f, -1);
  p.front = 0.8f;
  return p;
}

constexpr PropKind kRefrigerators[] = {
    {"refrigerator", refrigerator, "refrigerator over a freezer"},
};

}  // namespace

PropFamily refrigerators() { return kRefrigerators; }

}  // namespace gloam
