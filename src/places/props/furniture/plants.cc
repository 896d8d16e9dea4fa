// Plants in pots.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// Along +x, folded at the midrib and drooping towards its tip, its stalk included; seen from both
// sides.
Solid broad_leaf(float length, float droop, float slim) {
  constexpr int kAlong = 8, kAcross = 4;
  const float stalk = 0.16f * length;
  Path points;
  for (int i = 0; i <= kAlong; ++i) {
    const float t = float(i) / kAlong,
                half = slim * length * std::pow(std::sin(kPi * std::pow(t, 0.75f)) + 1e-4f, 0.85f) +
                       0.001f;
    for (int j = 0; j <= kAcross; ++j) {
      const float s = 2 * float(j) / kAcross - 1;
      points.push_back({stalk + length * (t - 0.12f * t * t * t), half * s,
                        -droop * length * t * t + 0.35f * half * std::fabs(s) +
                            0.02f * length * std::sin(14 * t) * s * s});
    }
  }
  // Rows run outwards, columns to +y: the upper side is the back of the grid.
  return sheet(points, kAcross + 1, 0.0008f) +
         tube({{0, 0, 0}, {stalk + 0.01f, 0, 0.001f}}, 0.0024f, 5);
}

// A stiff blade that stands on z = 0, slightly twisted.
Solid blade(float length, float half, float lean, float twist) {
  constexpr int kAlong = 9;
  Path points;
  for (int i = 0; i <= kAlong; ++i) {
    const float t = float(i) / kAlong,
                w = half * std::pow(1 - std::pow(t, 3.0f), 0.8f) *
                        (0.55f + 0.45f * std::sin(kPi * min(1.0f, 0.35f + t))) +
                    0.0006f,
                a = twist * t;
    for (int j = 0; j <= 4; ++j) {
      const float s = 2 * float(j) / 4 - 1, cup = 0.22f * w * s * s;
      points.push_back({lean * length * t * t + cup * std::cos(a) - w * s * std::sin(a),
                        w * s * std::cos(a) + cup * std::sin(a), length * t});
    }
  }
  return sheet(points, 5, 0.0016f);
}

void show_pot(PropPart* b, Workshop& shop, float r, float h) {
  Dice& dice = shop.dice;
  const int kind = dice.integer(0, 2);
  const float foot = dice.pick({0.72f, 0.86f});
  const Vec3 color = shop.color(dice.pick<Vec3>(
      {{0.84, 0.83, 0.80}, {0.20, 0.24, 0.26}, {0.36, 0.44, 0.40}, {0.70, 0.62, 0.50}}));
  const Profile wall = rounded({{0, 0},
                                {foot * r, 0},
                                {0.97f * r, 0.93f * h},
                                {r, 0.94f * h},
                                {r, h},
                                {0.90f * r, h},
                                {0.87f * r, 0.86f * h},
                                {0, 0.86f * h}},
                               0.012f, 3);
  b->show("pot",
          kind == 0   ? shop.paint({0.66, 0.34, 0.22}, 0.85)
          : kind == 1 ? shop.ceramic(color)
                      : shop.concrete(),
          lathe(wall, 44));
  b->show(
      "soil", shop.earth(),
      lathe(rounded({{0.885f * r, 0.868f * h}, {0.5f * r, 0.885f * h}, {0, 0.892f * h}}, 0.02f, 3),
            32));
}

Prop potted_plant(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size = limited(shop.size({0.6f, 0.6f, float(dice.uniform(0.75, 1.45))}),
                             {0.15f, 0.15f, 0.18f}, {1.2f, 1.2f, 2.4f});
  const float z = size.z, r = std::clamp(0.135f * z, 0.055f, 0.20f), pot = 1.75f * r,
              soil = 0.88f * pot;
  Prop p;
  PropPart& b = p.body();
  show_pot(&b, shop, r, pot);
  const Vec3 green = dice.pick<Vec3>({{0.16, 0.30, 0.10}, {0.20, 0.34, 0.14}, {0.13, 0.26, 0.12}});
  const std::string leaf = shop.leaf(green);
  const int kind = dice.integer(0, 2);
  const std::string bark = shop.paint({0.34, 0.26, 0.17}, 0.9);
  if (kind == 0) {
    // Rubber plant: three stems with broad leaves in a spiral.
    for (int k = 0; k < 3; ++k) {
      const float a = 2.1f * float(k) + float(dice.uniform(0, 0.8)),
                  top = z * (0.96f - 0.17f * float(k));
      const float c = std::cos(a), s = std::sin(a), out = 0.09f * z;
      const Path stem = smooth_path({{0.25f * r * c, 0.25f * r * s, soil - 0.03f},
                                     {0.4f * r * c, 0.4f * r * s, soil + 0.4f * (top - soil)},
                                     {out * c, out * s, top - 0.03f}},
                                    8);
      b.show("stems", bark, tube(stem, 0.006f + 0.003f * z, 8));
      const int count = std::max(7, int(15 * z));
      for (int j = 0; j < count; ++j) {
        const float t = 0.25f + 0.75f * float(j + 1) / float(count);
        const Vec3f at = stem[size_t(min(float(stem.size() - 1), t * float(stem.size() - 1)))];
        const float length = z * float(dice.uniform(0.18, 0.25)) * (1.12f - 0.35f * t),
                    lift = float(dice.uniform(15, 40)) + (t > 0.93f ? 35.0f : 0.0f);
        b.show(
            "leaves", leaf,
            broad_leaf(length, float(dice.uniform(0.2, 0.5)), 0.34f)
                .turned(Axis::kY, -lift)
                .turned(Axis::kZ, 137.5f * float(j) + a * 180 / kPi + float(dice.uniform(-15, 15)))
                .moved(at));
      }
    }
  } else if (kind == 1) {
    // Snake plant: upright blades with pale edges.
    const std::string edge = shop.leaf({0.55, 0.55, 0.22});
    const int count = dice.integer(11, 16);
    for (int k = 0; k < count; ++k) {
      const float a = 2.4f * float(k), out = 0.62f * r * std::sqrt(float(k) / float(count)),
                  length = (z - soil) * float(dice.uniform(0.55, 1.0)) *
                           (1.0f - 0.25f * float(k) / float(count)),
                  half = 0.016f + 0.017f * z * float(dice.uniform(0.8, 1.2));
      const float lean = float(dice.uniform(0.03, 0.22)) * (0.3f + float(k) / float(count)),
                  twist = float(dice.uniform(-0.6, 0.6));
      const auto placed = [&](const Solid& s, float sink) {
        return s.turned(Axis::kZ, a * 180 / kPi)
            .moved(out * std::cos(a), out * std::sin(a), soil - sink);
      };
      b.show("edges", edge, placed(blade(length, half, lean, twist), 0.02f));
      b.show("leaves", leaf,
             placed(blade(0.992f * length, 0.84f * half, lean, twist)
                        .scaled({1, 1, 1})
                        .moved(0.0012f, 0, 0),
                    0.02f));
      b.show(
          "leaves", leaf,
          placed(blade(0.992f * length, 0.84f * half, lean, twist).moved(-0.0012f, 0, 0), 0.02f));
    }
  } else {
    // Dracaena: a cane with tufts of long arching leaves.
    const int canes = dice.integer(1, 3);
    for (int k = 0; k < canes; ++k) {
      const float a = 2.2f * float(k) + 0.5f, c = std::cos(a), s = std::sin(a),
                  top = soil + (z - soil) * (0.70f - 0.20f * float(k)),
                  out = canes > 1 ? 0.4f * r : 0.0f;
      b.show("stems", bark,
             tube(smooth_path({{out * c, out * s, soil - 0.03f},
                               {1.2f * out * c, 1.2f * out * s, (soil + top) / 2},
                               {1.5f * out * c, 1.5f * out * s, top}}),
                  0.008f + 0.009f * z, 10));
      constexpr int kLeaves = 30;
      for (int j = 0; j < kLeaves; ++j) {
        const float t = float(j) / kLeaves,
                    length = 0.42f * (z - soil) * float(dice.uniform(0.8, 1.1)),
                    lift = 8 + 72 * t + float(dice.uniform(-8, 8));
        b.show("leaves", leaf,
               broad_leaf(length, 0.75f * (1.05f - t), 0.052f)
                   .turned(Axis::kY, -lift)
                   .turned(Axis::kZ, 137.5f * float(j) + float(dice.uniform(-10, 10)))
                   .moved(1.5f * out * c, 1.5f * out * s, top - 0.05f * z * (1 - t) + 0.01f));
      }
    }
  }
  b.collide_cylinder(0.92f * r, 0, pot);
  b.collide_cylinder(kind == 1 ? 0.75f * r : 0.05f, pot, 0.92f * z);
  b.mass = 900.0 * M_PI * double(r * r * pot) + 0.5;  // moist earth and clay, 900 kg/m³ of the pot
  p.loose = z < 0.6f;
  return p;
}

constexpr PropKind kPlants[] = {
    {"potted_plant", potted_plant, "rubber plant, snake plant or dracaena in a pot, by its height"},
};

}  // namespace

PropFamily plants() { return kPlants; }

}  // namespace gloam
