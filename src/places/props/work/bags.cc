// Bags and shoes.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// From 0 at `from` to 1 at `to`, also downwards.
float smoothstep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// A trainer, its toe towards +x, on z = 0.
void show_shoe(PropPart* b, Workshop& shop, const std::string& upper, const std::string& sole,
               float length, float side, float y, float turned) {
  const float w = 0.35f * length;
  const auto placed = [&](const Solid& s) {
    return (side > 0 ? s : s.mirrored(Axis::kY)).turned(Axis::kZ, turned).moved(0, y, 0);
  };
  // The last's half width inside and outside, and its top line, along the foot from heel to toe.
  constexpr int kAlong = 22, kAround = 22;
  const auto width_at = [&](float t) {
    return w * (0.36f + 0.14f * smoothstep(0.25f, 0.72f, t)) *
               std::pow(max(0.0f, 1 - std::pow(std::fabs(2 * t - 1), t > 0.5f ? 3.2f : 5.0f)),
                        0.5f) +
           0.0005f;
  };
  Profile outline;
  for (int i = 0; i < 2 * kAlong; ++i) {  // there inside the foot, back outside; dense at its ends
    const float a = kPi * float(i) / kAlong, t = 0.5f - 0.5f * std::cos(a);
    outline.push_back({length * (t - 0.5f), (i < kAlong ? -1.0f : 1.0f) * width_at(t) * 1.03f +
                                                0.02f * length * std::sin(kPi * t)});
  }
  b->show("soles", sole, placed(extrude(outline, 0, 0.020f)));
  Path points;
  for (int i = 0; i <= kAlong; ++i) {
    // Closer rows at the heel, whose back is round.
    const float t = std::pow(float(i) / kAlong, 1.4f), half = 0.97f * width_at(t);
    // Top line: the heel's collar, falling to the tongue's foot, then the toe box.
    const float high =
        length *
            (0.10f + 0.12f * smoothstep(0.62f, 0.30f, t) -
             0.015f * std::sin(kPi * min(1.0f, t / 0.3f))) *
            std::pow(max(0.0f, 1 - std::pow(max(0.0f, (t - 0.72f) / 0.28f), 3.0f)), 0.5f) +
        0.016f;
    const bool collar = t < 0.50f;
    for (int j = 0; j <= kAround; ++j) {
      const float a = kPi * (float(j) / kAround - 0.5f), s = std::sin(a), c = std::cos(a);
      float yy = half * (s < 0 ? -1.0f : 1.0f) * std::pow(std::fabs(s), 0.75f),
            zz = 0.016f + (high - 0.016f) * std::pow(max(c, 0.0f), 0.6f);
      if (collar) {  // the opening: its middle sinks
        const float in = smoothstep(0.62f, 0.30f, std::fabs(float(j) / kAround * 2 - 1)) *
                         smoothstep(0.50f, 0.40f, t) * smoothstep(0.04f, 0.10f, t);
        zz -= in * (high - 0.03f) * 0.7f;
        yy *= 1 - 0.15f * in;
      }
      points.push_back({length * 0.985f * (t - 0.5f), yy + 0.02f * length * std::sin(kPi * t), zz});
    }
  }
  b->show("uppers", upper, placed(Solid(sheet(points, kAround + 1))));
  for (int k = 0; k < 5; ++k) {
    const float t = 0.50f + 0.045f * float(k), x = length * (t - 0.5f),
                z = length * (0.10f + 0.12f * smoothstep(0.62f, 0.30f, t)) + 0.016f;
    b->show("laces", shop.fabric({0.84, 0.83, 0.80}, 0.0006),
            placed(tube(smooth_path({{x, -0.018f + 0.02f * length, z - 0.002f},
                                     {x, 0.02f * length, z + 0.003f},
                                     {x, 0.018f + 0.02f * length, z - 0.002f}},
                                    4),
                        0.0022f, 6)));
  }
}

Prop shoes(Workshop& shop) {
  Dice& dice = shop.dice;
  const float length =
      limited(shop.size({float(dice.uniform(0.25, 0.30)), 0, 0}), {0.15f, 0, 0}, {0.33f, 10, 10}).x;
  Prop p;
  PropPart& b = p.body();
  const Vec3 color = shop.color(dice.pick<Vec3>({{0.12, 0.13, 0.15},
                                                 {0.80, 0.79, 0.76},
                                                 {0.20, 0.28, 0.42},
                                                 {0.36, 0.22, 0.13},
                                                 {0.50, 0.14, 0.12}}));
  const std::string upper = dice.chance(0.5) ? shop.leather(color) : shop.fabric(color, 0.0009),
                    sole = shop.rubber(dice.chance(0.6) ? Vec3{0.80, 0.79, 0.76}
                                                        : Vec3{0.135, 0.135, 0.137});
  for (const float side : {-1.0f, 1.0f}) {
    const float y = side * 0.24f * length, turned = float(dice.uniform(-6, 6));
    show_shoe(&b, shop, upper, sole, length, side, y, turned);
    const Quat q = turn({0, 0, 1}, double(turned) * M_PI / 180);
    b.collide_box({0, y + side * 0.015f * length, 0.135f * length},
                  {0.46f * length, 0.155f * length, 0.135f * length}, q);
  }
  b.mass = 0.7;
  p.loose = true;
  return p;
}

Prop backpack(Workshop& shop) {
  Dice& dice = shop.dice;
  const float z = limited(shop.size({0.2f, 0.3f, float(dice.uniform(0.42, 0.50))}), {0, 0, 0.3f},
                          {10, 10, 0.65f})
                      .z,
              k = z / 0.46f;
  Prop p;
  PropPart& b = p.body();
  const Vec3 color = shop.color(dice.pick<Vec3>({{0.13, 0.15, 0.18},
                                                 {0.18, 0.28, 0.30},
                                                 {0.42, 0.16, 0.13},
                                                 {0.36, 0.37, 0.30},
                                                 {0.55, 0.45, 0.30}}));
  const std::string cloth = shop.fabric(color, 0.0012),
                    dark = shop.fabric({color.x * 0.45, color.y * 0.45, color.z * 0.45}, 0.0012);
  const auto piece = [&](Vec3f size, Vec3f at, float radius, float bulge) {
    const Solid s = cushion(size * k, bulge, radius * k, dice.seed(), 1, 0.004f * k);
    return s.moved(at.x * k, at.y * k,
                   at.z * k - (at.z - size.z / 2 < 0.002f ? s.low().z + size.z / 2 * k : 0));
  };
  const Solid main = piece({0.17f, 0.29f, 0.45f}, {-0.01f, 0, 0.225f}, 0.055f, 0.22f);
  b.show("body", cloth, main.scaled({1, 1, z / main.high().z}));
  b.show("pocket", cloth, piece({0.07f, 0.235f, 0.22f}, {0.088f, 0, 0.135f}, 0.03f, 0.20f));
  for (const float s : {-1.0f, 1.0f}) {
    b.show("side_pockets", dark,
           piece({0.10f, 0.02f, 0.15f}, {-0.01f, s * 0.149f, 0.10f}, 0.009f, 0.5f));
    b.show("straps", dark, [&] {
      // Padded bands along the back.
      Path points;
      const Path line = smooth_path({{-0.085f, 0.055f, 0.42f},
                                     {-0.135f, 0.065f, 0.37f},
                                     {-0.140f, 0.085f, 0.24f},
                                     {-0.115f, 0.105f, 0.10f},
                                     {-0.085f, 0.115f, 0.04f}},
                                    6);
      for (const Vec3f at : line)
        for (const float side : {1.0f, -1.0f})
          points.push_back(Vec3f{at.x, s * at.y + 0.028f * side, at.z} * k);
      return sheet(points, 2, 0.010f * k);
    }());
  }
  const std::string zip = shop.metal("steel");
  // Zips: over the shoulders of the bag and of its pocket.
  const auto zip_line = [&](float x, float y, float top, float side_low, float r) {
    Path out;
    for (const Vec2f at : rounded({{-y, side_low}, {-y, top}, {y, top}, {y, side_low}}, 0.06f, 5))
      out.push_back(Vec3f{x, at.x, at.y} * k);
    return tube(out, r * k, 6);
  };
  b.show("zips", shop.plastic({0.115, 0.115, 0.117}, 0.4),
         zip_line(0.030f, 0.143f, 0.443f, 0.20f, 0.0032f) +
             zip_line(0.120f, 0.098f, 0.225f, 0.12f, 0.0030f));
  b.show("pullers", zip,
         slab(Vec3f{0.121f, -0.100f, 0.085f} * k, Vec3f{0.124f, -0.094f, 0.118f} * k, 0.001f));
  b.show("handle", dark,
         tube(smooth_path({Vec3f{-0.075f, -0.04f, 0.435f} * k, Vec3f{-0.085f, -0.025f, 0.462f} * k,
                           Vec3f{-0.085f, 0.025f, 0.462f} * k, Vec3f{-0.075f, 0.04f, 0.435f} * k}),
              0.006f * k, 8));
  b.show("patch", shop.leather({0.42, 0.26, 0.15}),
         slab(Vec3f{0.094f, -0.03f, 0.30f} * k, Vec3f{0.099f, 0.03f, 0.335f} * k, 0.001f)
             .turned(Axis::kY, -3));
  b.collide_box(Vec3f{-0.095f, -0.14f, 0} * k, Vec3f{0.08f, 0.14f, 0.44f} * k);
  b.collide_box(Vec3f{0.08f, -0.11f, 0.02f} * k, Vec3f{0.122f, 0.11f, 0.24f} * k);
  b.mass = 3.0 * double(k * k);
  p.loose = true;
  return p;
}

// Leans at nothing: it lies flat.
Prop laptop_bag(Workshop& shop) {
  Dice& dice = shop.dice;
  Prop p;
  PropPart& b = p.body();
  const Vec3 color = shop.color(dice.pick<Vec3>(
      {{0.09, 0.09, 0.10}, {0.24, 0.26, 0.28}, {0.16, 0.20, 0.28}, {0.34, 0.22, 0.13}}));
  const std::string cloth = dice.chance(0.4) ? shop.leather(color) : shop.fabric(color, 0.0012),
                    dark = shop.fabric({color.x * 0.5, color.y * 0.5, color.z * 0.5}, 0.0011);
  const auto flat = [&](Vec3f size, float bulge, float x, float z) {
    const Solid s = cushion(size, bulge, 0.45f * size.z, dice.seed(), 1, 0.0015f);
    return s.moved(x, 0, z - s.low().z);
  };
  b.show("body", cloth, flat({0.29f, 0.40f, 0.060f}, 0.12f, 0, 0));
  b.show("pocket", cloth, flat({0.21f, 0.36f, 0.022f}, 0.35f, 0.025f, 0.055f));
  Path zip;
  for (const Vec2f at : rounded_rectangle(0.294f, 0.404f, 0.04f, 5))
    zip.push_back({at.x, at.y, 0.034f});
  zip.push_back(zip.front());
  b.show("zip", shop.plastic({0.11, 0.11, 0.112}, 0.4), tube(zip, 0.0032f, 6));
  for (const float s : {-1.0f, 1.0f}) {
    b.show("handles", dark,
           tube(smooth_path({{-0.13f, -0.075f, 0.034f + 0.012f * s},
                             {-0.185f, -0.06f, 0.028f + 0.012f * s},
                             {-0.195f, 0, 0.024f + 0.010f * s},
                             {-0.185f, 0.06f, 0.028f + 0.012f * s},
                             {-0.13f, 0.075f, 0.034f + 0.012f * s}}),
                0.0065f, 8));
    b.show("rings", shop.metal("steel"),
           tube({{-0.125f, s * 0.203f, 0.030f},
                 {-0.125f, s * 0.222f, 0.030f},
                 {-0.095f, s * 0.222f, 0.030f},
                 {-0.095f, s * 0.203f, 0.030f}},
                0.002f, 6));
  }
  b.collide_box({-0.142f, -0.197f, 0}, {0.142f, 0.197f, 0.066f});
  b.mass = 2.4;  // with a computer in it
  p.loose = true;
  return p;
}

constexpr PropKind kBags[] = {
    {"shoes", shoes, "pair of trainers"},
    {"backpack", backpack, "backpack that stands"},
    {"laptop_bag", laptop_bag, "bag for a laptop, lying flat"},
};

}  // namespace

PropFamily bags() { return kBags; }

}  // namespace gloam
