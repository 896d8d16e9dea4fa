// Plants outdoors: broadleaves, conifers, bushes.

#include "places/props/outdoors/trees.h"

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {

// Two triangles, pointed at both ends, of that length along `d`.
void add_leaf(Vec3f at, Vec3f d, Vec3f side, float length, Solid* leaves) {
  const Vec3f points[4] = {at, at + (d + side * 0.6f) * (length / 2),
                           at + (d - side * 0.6f) * (length / 2), at + d * length};
  *leaves += sheet(points, 2);
}

// A broadleaf of that height; leaves in clouds around the ends of its boughs.
Prop make_tree(double high, Workshop* shop, Dice* dice) {
  const float h = float(high), fork = 0.3f * h, crown = 0.30f * h;
  Prop p;
  p.label = "tree";
  const std::string bark = shop->earth();
  p.body().show("trunk", bark, bar({0, 0, -0.1f}, {0, 0, fork}, 0.035f * h, 0.024f * h, 12));
  Solid leaves[2];
  constexpr int kBoughs = 13, kLeaves = 380;
  for (int i = 0; i < kBoughs; ++i) {
    // Spread evenly over a sphere about the crown's middle, by the golden angle.
    const float t = (float(i) + 0.5f) / kBoughs, a = 2.39996f * float(i), z = 1 - 1.5f * t,
                r = std::sqrt(std::max(0.0f, 1 - z * z));
    const Vec3f end{0.62f * crown * r * std::cos(a), 0.62f * crown * r * std::sin(a),
                    h - 1.15f * crown + 0.75f * crown * z};
    p.body().show("boughs", bark, bar({0, 0, fork - 0.05f}, end, 0.012f * h, 0.004f * h, 6));
    const float cloud = crown * float(dice->uniform(0.42, 0.58));
    for (int k = 0; k < kLeaves; ++k) {
      const float u = float(dice->uniform(-1, 1)), b = float(dice->uniform(0, 2 * kPi)),
                  q = std::sqrt(1 - u * u);
      const Vec3f out{q * std::cos(b), q * std::sin(b), u};
      const float deep = cloud * std::sqrt(float(dice->uniform(0.35, 1)));
      add_leaf(end + out * deep, out + Vec3f{0, 0, -0.35f}, {-std::sin(b), std::cos(b), 0.3f},
               float(dice->uniform(0.18, 0.30)), &leaves[k % 2]);
    }
  }
  p.body().show("leaves_1", shop->leaf({0.28, 0.35, 0.15}), leaves[0]);
  p.body().show("leaves_2", shop->leaf({0.19, 0.27, 0.11}), leaves[1]);
  p.body().collide_cylinder(0.035f * h, 0, fork);
  p.body().mass = 600 * M_PI * std::pow(0.03 * high, 2) * high;  // [kg/m³] of green wood
  return p;
}

namespace {

// Mass of twigs and leaves in the box around a crown [kg].
double foliage_mass(const Prop& p) {
  constexpr double kDensity = 3;  // [kg/m³]
  const Prop::Box box = p.bounds();
  const Vec3f size = box.high - box.low;
  return kDensity * double(size.x * size.y * size.z);
}

Prop tree(Workshop& shop) {
  const float high = limited(shop.size({6, 6, 7.5f}), {1, 1, 3}, {30, 30, 25}).z;
  return make_tree(high, &shop, &shop.dice);
}

// Boughs that hang, thick with sprays of needles, each at a height of its own.
Prop conifer(Workshop& shop) {
  Dice& dice = shop.dice;
  const float h = limited(shop.size({4, 4, 9}), {1, 1, 2}, {20, 20, 30}).z, wide = 0.2f * h;
  Prop p;
  const std::string bark = shop.earth();
  p.body().show("trunk", bark, bar({0, 0, -0.15f}, {0, 0, 0.98f * h}, 0.02f * h, 0.002f * h, 10));
  Solid needles;
  const int whorls = 36;
  for (int i = 0; i < whorls; ++i) {
    const float t = float(i) / float(whorls - 1);
    const int count = 9 - int(4 * t);
    for (int k = 0; k < count; ++k) {
      const float z = h * (0.12f + 0.84f * t + 0.024f * (1 - t) * float(dice.uniform(-1, 1))),
                  a = 2 * kPi * (float(k) + float(dice.uniform(0, 0.8))) / float(count) + float(i),
                  reach = wide * (1 - 0.93f * t) * float(dice.uniform(0.6, 1.15)) + 0.12f;
      const Vec3f out{std::cos(a), std::sin(a),
                      -0.28f + 0.35f * t + float(dice.uniform(-0.15, 0.1))},
          side{-std::sin(a), std::cos(a), 0};
      const int sprays = 3 + int(reach / 0.13f);
      for (int s = 0; s < sprays; ++s) {
        const float at = reach * (0.12f + 0.88f * float(s) / float(sprays)),
                    length = (0.34f + 0.28f * (reach - at)) * float(dice.uniform(0.7, 1.1));
        for (const float way : {-1.0f, 0.0f, 1.0f})
          add_leaf(Vec3f{0, 0, z} + out * at, normalize(out + side * (0.8f * way)),
                   normalize(side + Vec3f{0, 0, float(dice.uniform(-0.5, 0.5))}) * 0.55f, length,
                   &needles);
      }
    }
  }
  p.body().show("needles", shop.blades("needles", {0.035, 0.058, 0.022}, {0.018, 0.032, 0.014}),
                needles);
  p.body().collide_cylinder(0.02f * h, 0, 0.5f * h);
  p.body().mass = 500 * M_PI * std::pow(0.014 * h, 2) * h + foliage_mass(p);  // [kg/m³] of wood
  return p;
}

Prop bush(Workshop& shop) {
  Dice& dice = shop.dice;
  const Vec3f size = limited(shop.size({1.6f, 1.6f, 1.3f}), {0.3f, 0.3f, 0.3f}, {5, 5, 4});
  Prop p;
  Solid leaves;
  for (int i = 0; i < 9; ++i) {
    const float a = 2.4f * float(i), r = 0.3f * std::sqrt(float(i) / 9);
    const Vec3f end{size.x * r * std::cos(a), size.y * r * std::sin(a),
                    size.z * (0.75f - 0.6f * r) * float(dice.uniform(0.75, 1))};
    p.body().show("stems", shop.earth(),
                  bar({0.1f * end.x, 0.1f * end.y, -0.1f}, end, 0.014f, 0.005f, 5));
    for (int k = 0; k < 260; ++k) {
      const float b = float(dice.uniform(0, 2 * kPi)), u = float(dice.uniform(-1, 1)),
                  q = std::sqrt(1 - u * u),
                  deep = 0.25f * size.z * std::cbrt(float(dice.uniform(0.1, 1)));
      const Vec3f out{q * std::cos(b), q * std::sin(b), u};
      const float length = float(dice.uniform(0.04, 0.085));
      const Vec3f at = end + out * deep;
      if (at.z > 0.03f) add_leaf(at, out, {-std::sin(b), std::cos(b), 0.4f}, length, &leaves);
    }
  }
  p.body().show("leaves", shop.blades("bush_leaves", {0.062, 0.085, 0.026}, {0.032, 0.050, 0.017}),
                leaves);
  p.body().collide_cylinder(0.3f * min(size.x, size.y), 0, 0.7f * size.z);
  p.body().mass = foliage_mass(p);
  return p;
}

constexpr PropKind kTrees[] = {{"tree", tree, "broadleaf in leaf"},
                               {"conifer", conifer, "spruce or fir"},
                               {"bush", bush, "round bush in leaf"}};

}  // namespace

PropFamily trees() { return kTrees; }

}  // namespace gloam
