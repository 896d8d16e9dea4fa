// Broom and vacuum cleaner.

#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

// Leans against the wall behind it.
Prop broom(Workshop& shop) {
  const float lean = 11;  // from upright [deg]
  const std::string wood = shop.wood("pine", Axis::kZ);
  const Vec3 dye = shop.color(
      shop.dice.pick<Vec3>({{0.35, 0.24, 0.13}, {0.16, 0.30, 0.42}, {0.50, 0.12, 0.10}}));
  PropPart upright;
  upright.show("pole", wood,
               bar({0, 0, 0.075f}, {0, 0, 1.42f}, 0.0125f, 0.0115f, 16) +
                   ball(0.0125f, 14).moved(0, 0, 1.42f));
  upright.show("collar", shop.plastic({0.08, 0.08, 0.085}),
               cone(0.024f, 0.015f, 0.10f, 0.165f, 0.004f, 20));
  upright.show("head", shop.wood("birch", Axis::kY),
               slab({-0.028f, -0.15f, 0.075f}, {0.028f, 0.15f, 0.108f}, 0.010f, 3));
  for (int row = -3; row <= 3; ++row)
    for (int i = 0; i < 26; ++i) {
      const float y = -0.141f + 0.282f * float(i) / 25, x = 0.0068f * float(row), out = 1.25f;
      const float jitter = float(shop.dice.uniform(-0.003, 0.003));
      upright.show(
          "bristles", shop.fabric(dye, 0.0008),
          tube({{x, y, 0.08f}, {x * out + jitter, y * 1.05f + jitter, 0.006f + std::fabs(jitter)}},
               0.0038f, 4));
    }
  Prop p;
  PropPart& b = p.body();
  const float foot = 1.42f * std::sin(lean * kPi / 180) / 2, drop = 0.016f;
  for (const PropVisual& v : upright.visuals)
    b.show(v.name, v.material, Solid(v.mesh).turned(Axis::kY, -lean).moved(foot, 0, drop - 0.012f));
  const Vec3f up{-std::sin(lean * kPi / 180), 0, std::cos(lean * kPi / 180)},
      at{foot, 0, drop - 0.012f};
  b.collide_capsule(at + up * 0.13f, at + up * 1.42f, 0.0125f);
  b.collide_box(at + up * 0.058f, {0.03f, 0.15f, 0.048f}, turn({0, 1, 0}, -lean * M_PI / 180));
  b.mass = 0.9;
  return p;
}

Prop vacuum_cleaner(Workshop& shop) {
  const Vec3 tint = shop.color(shop.dice.pick<Vec3>(
      {{0.50, 0.08, 0.07}, {0.10, 0.20, 0.38}, {0.16, 0.17, 0.18}, {0.78, 0.77, 0.74}}));
  const std::string shell = shop.plastic(tint, 0.12), dark = shop.plastic({0.06, 0.06, 0.065}, 0.4),
                    chrome = shop.metal("chrome");
  Prop p;
  PropPart& b = p.body();
  const auto hull = [](float in, float z) {
    return oval(-0.02f, 0.20f - in, 0.19f - in, 0.135f - 0.8f * in, z, 2.6f);
  };
  b.show("chassis", dark,
         loft({point_of(hull(0, 0), {0, 0, 0.03f}), hull(0.02f, 0.03f), hull(0, 0.05f),
               hull(0, 0.085f), hull(0.004f, 0.09f)}));
  b.show("shell", shell,
         loft({hull(0.004f, 0.088f), hull(0.005f, 0.12f), hull(0.02f, 0.17f), hull(0.05f, 0.21f),
               hull(0.10f, 0.232f), point_of(hull(0, 0), {-0.02f, 0, 0.238f})}));
  b.show("bumper", shop.rubber(),
         loft({hull(-0.004f, 0.052f), hull(-0.009f, 0.056f), hull(-0.009f, 0.070f),
               hull(-0.004f, 0.074f)}));
  for (const float side : {-1.0f, 1.0f}) {
    const Profile wheel =
        rounded({{0, -0.018f}, {0.070f, -0.018f}, {0.070f, 0.012f}, {0.05f, 0.018f}, {0, 0.020f}},
                0.008f, 3);
    b.show("wheels", dark,
           lathe(wheel, 32).turned(Axis::kX, -side * 90).moved(-0.11f, side * 0.135f, 0.070f));
    b.show("hubs", chrome,
           lathe(rounded({{0.035f, 0.018f}, {0.03f, 0.024f}, {0, 0.026f}}, 0.004f), 24)
               .turned(Axis::kX, -side * 90)
               .moved(-0.11f, side * 0.135f, 0.070f));
    b.collide_box({-0.17f, side * 0.135f - 0.02f, 0}, {-0.05f, side * 0.135f + 0.02f, 0.14f});
    b.show("vents", dark,
           slab({-0.16f, side * 0.06f - 0.02f, 0.196f}, {-0.10f, side * 0.06f + 0.02f, 0.2f}, 0));
  }
  b.show(
      "caster", dark,
      lathe(rounded({{0, -0.012f}, {0.022f, -0.012f}, {0.022f, 0.012f}, {0, 0.012f}}, 0.004f), 20)
          .turned(Axis::kX, 90)
          .moved(0.12f, 0, 0.022f));
  b.show("handle", dark,
         tube(smooth_path({{0.09f, 0, 0.215f},
                           {0.08f, 0, 0.255f},
                           {0.02f, 0, 0.268f},
                           {-0.07f, 0, 0.262f},
                           {-0.09f, 0, 0.222f}},
                          5),
              0.011f, 12));
  b.show("switch", chrome,
         cylinder(0.022f, 0, 0.006f, 0.002f, 24).turned(Axis::kY, -14).moved(-0.135f, 0, 0.208f));
  // Hose to a wand that is parked upright at the back, its floor head on the ground.
  b.show("socket", dark, bar({0.13f, 0, 0.155f}, {0.185f, 0, 0.185f}, 0.030f, 0.024f, 20));
  Path hose = smooth_path({{0.18f, 0, 0.183f},
                           {0.26f, 0.02f, 0.26f},
                           {0.30f, 0.10f, 0.42f},
                           {0.24f, 0.17f, 0.66f},
                           {0.05f, 0.16f, 0.86f},
                           {-0.13f, 0.07f, 0.98f},
                           {-0.21f, 0, 0.985f}},
                          12);
  Solid ribs;
  for (size_t i = 0; i + 1 < hose.size(); ++i)
    ribs += tube({hose[i], hose[i] + (hose[i + 1] - hose[i]) * 0.5f}, 0.0185f, 9);
  b.show("hose", shop.plastic({0.10, 0.10, 0.105}, 0.5), tube(hose, 0.0165f, 12) + ribs);
  const Vec3f head{-0.275f, 0, 0.05f}, grip{-0.225f, 0, 0.93f};
  b.show("wand", chrome, bar(head, grip, 0.0165f, 0.0165f, 18));
  b.show("joint", dark,
         bar(head + (grip - head) * 0.48f, head + (grip - head) * 0.54f, 0.020f, 0.020f, 18));
  b.show("grip", dark,
         tube(smooth_path({grip,
                           {-0.222f, 0, 0.97f},
                           {-0.235f, 0, 1.02f},
                           {-0.285f, 0, 1.06f},
                           {-0.33f, 0, 1.05f}},
                          5),
              0.017f, 14));
  b.show("grip", dark, tube({{-0.21f, 0, 0.985f}, {-0.24f, 0, 1.0f}}, 0.019f, 14));
  b.show("floor_head", dark,
         slab({-0.325f, -0.135f, 0.004f}, {-0.215f, 0.135f, 0.034f}, 0.012f, 3));
  b.show("floor_head", dark,
         bar({-0.27f, 0, 0.02f}, head + Vec3f{0.002f, 0, 0.05f}, 0.024f, 0.021f, 16));
  b.show("brush", shop.carpet({0.12, 0.12, 0.12}),
         slab({-0.315f, -0.13f, 0}, {-0.225f, 0.13f, 0.008f}, 0.001f));
  b.collide_box({-0.325f, -0.135f, 0}, {-0.215f, 0.135f, 0.034f});
  b.collide_capsule(head, grip, 0.018f);
  b.collide_box({-0.19f, -0.105f, 0.03f}, {0.16f, 0.105f, 0.20f});
  b.collide_box({-0.10f, -0.075f, 0.20f}, {0.08f, 0.075f, 0.265f});
  b.collide_box({0.105f, -0.02f, 0}, {0.14f, 0.02f, 0.03f});
  b.mass = 6.5;
  p.loose = true;
  return p;
}

constexpr PropKind kCleaning[] = {
    {"broom", broom, "broom that leans on the wall behind it"},
    {"vacuum_cleaner", vacuum_cleaner, "canister vacuum cleaner with its wand parked upright"},
};

}  // namespace

PropFamily cleaning() { return kCleaning; }

}  // namespace gloam
