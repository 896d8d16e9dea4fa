// Food and its containers: bowls, jars, spices, bottles.

#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Solid banana() {
  const float z = 0.018f;
  Solid out;
  for (int i = 0; i < 3; ++i) {
    Path middle;
    for (int k = 0; k <= 6; ++k) {
      const float a = -0.9f + 0.30f * float(k);
      middle.push_back({0.10f * std::sin(a), 0.10f - 0.10f * std::cos(a), z});
    }
    Solid one;
    const float thick[] = {0.006f, 0.013f, 0.017f, 0.018f, 0.017f, 0.012f, 0.004f};
    for (int k = 0; k < 6; ++k)
      one += bar(middle[size_t(k)], middle[size_t(k) + 1], thick[k], thick[k + 1], 8);
    out += one.turned(Axis::kZ, float(i - 1) * 13).moved(0, 0.004f * float(i), 0);
  }
  return out;
}

Prop fruit_bowl(Workshop& shop) {
  Prop p;
  PropPart& b = p.body();
  const float r = float(shop.dice.uniform(0.13, 0.16));
  const bool wooden = shop.dice.chance(0.4);
  const std::string ware =
      wooden ? shop.wood(Axis::kX) : shop.ceramic(shop.color({0.87, 0.86, 0.83}));
  b.show("bowl", ware,
         lathe(rounded({{0, 0},
                        {0.058f, 0},
                        {r, 0.078f},
                        {r - 0.008f, 0.080f},
                        {0.052f, 0.010f},
                        {0, 0.010f}},
                       0.014f, 4),
               44));
  struct Kind {
    Vec3 color;
    float roughness;
    bool apple;
  };
  const Kind kinds[] = {{{0.90, 0.47, 0.08}, 0.45, false},
                        {{0.58, 0.09, 0.07}, 0.25, true},
                        {{0.52, 0.62, 0.16}, 0.28, true},
                        {{0.90, 0.76, 0.14}, 0.4, false}};
  const float out = r * 0.40f;
  for (int i = 0; i < 6; ++i) {
    const float angle = 2 * kPi * float(i) / 5 + float(shop.dice.uniform(-0.1, 0.1));
    const Vec3f at =
        i < 5 ? Vec3f{out * std::cos(angle), out * std::sin(angle), 0.056f} : Vec3f{0, 0, 0.098f};
    const int kind = shop.dice.integer(0, 3);
    const Kind& k = kinds[kind];
    const float s = 0.036f;
    const Solid fruit = k.apple     ? lathe({{0, -0.026f},
                                             {0.012f, -0.031f},
                                             {0.026f, -0.024f},
                                             {0.036f, -0.004f},
                                             {0.037f, 0.010f},
                                             {0.030f, 0.026f},
                                             {0.016f, 0.031f},
                                             {0.006f, 0.027f},
                                             {0, 0.021f}},
                                            22)
                        : kind == 3 ? lathe({{0, -0.046f},
                                             {0.007f, -0.043f},
                                             {0.012f, -0.036f},
                                             {0.027f, -0.020f},
                                             {0.031f, 0},
                                             {0.027f, 0.020f},
                                             {0.014f, 0.034f},
                                             {0, 0.039f}},
                                            20)
                                          .turned(Axis::kX, 80)
                                    : ball(s, 22).scaled({1, 1, 0.94f});
    const float lean = float(shop.dice.uniform(-25, 25)), spin = float(shop.dice.uniform(0, 360));
    b.show("fruit_" + std::to_string(kind), shop.plastic(k.color, k.roughness),
           fruit.turned(Axis::kX, lean).turned(Axis::kZ, spin).moved(at));
    if (k.apple)
      b.show("stalks", shop.plastic({0.20, 0.13, 0.07}, 0.8),
             bar({0, 0, 0.020f}, {0.003f, 0, 0.040f}, 0.0012f, 0.0018f, 6)
                 .turned(Axis::kX, lean)
                 .turned(Axis::kZ, spin)
                 .moved(at));
  }
  if (shop.dice.chance(0.6))
    b.show("bananas", shop.plastic({0.88, 0.70, 0.14}, 0.5),
           banana().turned(Axis::kX, 60).turned(Axis::kZ, 40).moved(-0.01f, -0.055f, 0.086f));
  b.collide_cylinder(0.058f, 0, 0.02f);
  b.collide_cylinder(0.10f, 0.02f, 0.05f);
  b.collide_cylinder(r, 0.05f, 0.08f);
  b.collide_sphere({0, 0, 0.085f}, 0.05f);
  b.mass = 0.9 + 6 * 0.17;
  p.loose = true;
  return p;
}

// Jar about z with a lid of steel; what is in it fills it to `full`.
void show_jar(Workshop& shop, PropPart* b, Vec3f at, float r, float h, float full, Vec3 content) {
  const int segments = r < 0.03f ? 14 : 28;
  b->show(
      "glass", shop.glass(),
      lathe(
          rounded({{0, 0}, {r, 0}, {r, h * 0.82f}, {r * 0.86f, h * 0.88f}, {r * 0.86f, h * 0.92f}},
                  r * 0.18f, 3),
          segments)
          .moved(at));
  b->show("lids", shop.metal("steel"),
          lathe(rounded({{r * 0.90f, h * 0.88f}, {r * 0.92f, h * 0.88f}, {r * 0.92f, h}, {0, h}},
                        0.003f),
                segments)
              .moved(at));
  const float in = r - 0.002f;
  b->show("content_" + std::to_string(int(content.x * 999 + content.y * 99)), shop.carpet(content),
          lathe(rounded({{0, 0.003f}, {in, 0.003f}, {in, h * full}, {0, h * full}}, r * 0.15f, 2),
                segments)
              .moved(at));
}

const std::initializer_list<Vec3> kDry = {{0.86, 0.82, 0.72},
                                          {0.62, 0.42, 0.22},
                                          {0.30, 0.17, 0.09},
                                          {0.80, 0.62, 0.30},
                                          {0.62, 0.40, 0.26}};

Prop jar(Workshop& shop) {
  const float r = float(shop.dice.uniform(0.04, 0.06)), h = float(shop.dice.uniform(0.12, 0.24));
  Prop p;
  PropPart& b = p.body();
  const Vec3 content = shop.color(shop.dice.pick(kDry));
  show_jar(shop, &b, {}, r, h, float(shop.dice.uniform(0.35, 0.78)), content);
  b.collide_cylinder(r, 0, h * 0.86f);
  b.collide_cylinder(r * 0.92f, h * 0.86f, h);
  b.mass = 900.0 * kPi * r * r * h;
  p.loose = true;
  return p;
}

Prop spice_rack(Workshop& shop) {
  Prop p;
  PropPart& b = p.body();
  const float x = 0.075f, y = 0.16f, r = 0.021f;
  const std::string wood = shop.wood(Axis::kY), upright = shop.wood(Axis::kZ);
  for (const float side : {-1.0f, 1.0f})
    b.show("sides", upright,
           extrude({{-x, 0}, {x, 0}, {x, 0.06f}, {0.02f, 0.075f}, {-0.02f, 0.21f}, {-x, 0.23f}},
                   -0.006f, 0.006f)
               .turned(Axis::kX, 90)
               .moved(0, side * (y - 0.006f), 0));
  const float levels[] = {0.02f, 0.115f};
  for (int row = 0; row < 2; ++row) {
    const float z = levels[row], front = row == 0 ? x : -0.002f, back = row == 0 ? 0.012f : -x;
    b.show("shelves", wood, slab({back, -y + 0.012f, z - 0.01f}, {front, y - 0.012f, z}, 0.0015f));
    b.show(
        "shelves", wood,
        slab({front - 0.007f, -y + 0.012f, z + 0.018f}, {front, y - 0.012f, z + 0.034f}, 0.002f));
    for (int i = 0; i < 6; ++i) {
      const float at = -y + 0.036f + (2 * y - 0.072f) * float(i) / 5;
      const Vec3 content = shop.dice.pick(kDry);
      show_jar(shop, &b, {(front + back) / 2 - 0.003f, at, z}, r, 0.088f,
               float(shop.dice.uniform(0.3, 0.75)), content);
      b.show("labels", shop.paper({0.90, 0.88, 0.82}),
             lathe({{r + 0.0004f, 0.022f}, {r + 0.0004f, 0.050f}}, 24)
                 .moved((front + back) / 2 - 0.003f, at, z));
    }
  }
  b.show("back", wood, slab({-x, -y + 0.012f, 0.005f}, {-x + 0.004f, y - 0.012f, 0.20f}, 0.001f));
  b.collide_box({-x, -y, 0}, {x, y, 0.105f});
  b.collide_box({-x, -y, 0.105f}, {0.01f, y, 0.215f});
  b.mass = 0.6 + 12 * 0.11;
  p.loose = true;
  return p;
}

Prop wine_bottle(Workshop& shop) {
  const bool red = shop.dice.chance(0.6);
  Prop p;
  PropPart& b = p.body();
  // Bordeaux bottle, 0.75 l.
  b.show("glass", shop.plastic(red ? Vec3{0.025, 0.04, 0.02} : Vec3{0.10, 0.13, 0.05}, 0.05),
         lathe(rounded({{0, 0.012f},
                        {0.030f, 0},
                        {0.0375f, 0.004f},
                        {0.0375f, 0.195f},
                        {0.030f, 0.220f},
                        {0.0148f, 0.240f},
                        {0.0138f, 0.285f},
                        {0.0150f, 0.288f},
                        {0.0150f, 0.298f},
                        {0, 0.298f}},
                       0.009f, 3),
               32));
  b.show("capsule",
         shop.paint(shop.color(red ? Vec3{0.30, 0.03, 0.05} : Vec3{0.62, 0.52, 0.25}), 0.3),
         lathe({{0.0148f, 0.242f},
                {0.0144f, 0.284f},
                {0.0156f, 0.287f},
                {0.0156f, 0.2985f},
                {0.0145f, 0.3f},
                {0, 0.3f}},
               24));
  Path label;
  constexpr int kColumns = 17;
  for (const float z : {0.070f, 0.160f})
    for (int i = 0; i < kColumns; ++i) {
      const float a = 1.1f * (2 * float(i) / (kColumns - 1) - 1);
      label.push_back({0.0379f * std::cos(a), 0.0379f * std::sin(a), z});
    }
  b.show("label", shop.paper({0.88, 0.85, 0.76}), sheet(label, kColumns));
  for (Vec3f& v : label) v = {v.x * 1.003f, v.y * 0.95f, v.z < 0.1f ? 0.128f : 0.136f};
  b.show("stripe", shop.paint(red ? Vec3{0.35, 0.05, 0.06} : Vec3{0.55, 0.45, 0.18}, 0.3),
         sheet(label, kColumns));
  for (Vec3f& v : label) v = {v.x, v.y * 0.7f, v.z < 0.132f ? 0.095f : 0.099f};
  b.show("print", shop.paint({0.08, 0.08, 0.08}, 0.6), sheet(label, kColumns));
  b.collide_cylinder(0.0375f, 0, 0.205f);
  b.collide_cylinder(0.0155f, 0.205f, 0.30f);
  b.mass = 1.25;
  p.loose = true;
  return p;
}

constexpr PropKind kKitchenStores[] = {
    {"fruit_bowl", fruit_bowl, "bowl of fruit"},
    {"jar", jar, "glass jar with lid, of dry food"},
    {"spice_rack", spice_rack, "two steps of small jars"},
    {"wine_bottle", wine_bottle, "bottle of wine"},
};

}  // namespace

PropFamily kitchen_stores() { return kKitchenStores; }

}  // namespace gloam
