// Carts, trucks and ladders of halls.

#include <cmath>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

Prop pallet_jack(Workshop& shop) {
  // Forks 1.15 m long and 0.54 m over all, lowered to 85 mm; 75 kg.
  const float tip = 0.78f, heel = -0.37f, top = 0.085f, post = -0.45f;
  Prop p;
  PropPart& b = p.body();
  const Vec3 color = shop.color(
      shop.dice.pick({Vec3{0.80, 0.42, 0.02}, Vec3{0.68, 0.08, 0.06}, Vec3{0.05, 0.20, 0.46}}));
  const std::string paint = shop.paint(color, 0.32), black = shop.paint({0.03, 0.03, 0.032}, 0.45);
  for (const float side : {-1.0f, 1.0f}) {
    const float y = side * 0.19f;
    // An inverted trough with a tapered tip.
    Profile plan = rounded_outline({{heel, y - 0.08f},
                                    {tip - 0.10f, y - 0.08f},
                                    {tip, y - 0.035f},
                                    {tip, y + 0.035f},
                                    {tip - 0.10f, y + 0.08f},
                                    {heel, y + 0.08f}},
                                   0.02f, 3);
    b.show("forks", paint, extrude(plan, top - 0.006f, top));
    for (const float edge : {-0.077f, 0.077f})
      b.show("forks", paint,
             slab({heel, y + edge - 0.003f, 0.04f}, {tip - 0.10f, y + edge + 0.003f, top - 0.004f},
                  0.001f));
    const std::string nylon = shop.plastic({0.80, 0.74, 0.58}, 0.4);
    for (const float x : {tip - 0.20f, tip - 0.115f})
      b.show("rollers", nylon,
             bar({x, y - 0.035f, 0.037f}, {x, y + 0.035f, 0.037f}, 0.037f, 0.037f, 20));
    b.show("linkage", black,
           slab({tip - 0.24f, y - 0.045f, 0.03f}, {tip - 0.09f, y - 0.038f, 0.06f}, 0.002f) +
               slab({tip - 0.24f, y + 0.038f, 0.03f}, {tip - 0.09f, y + 0.045f, 0.06f}, 0.002f));
    b.show("linkage", black, beam({heel, y, 0.06f}, {tip - 0.22f, y, 0.05f}, 0.02f, 0.015f));
    b.collide_box({heel, y - 0.08f, 0.035f}, {tip - 0.02f, y + 0.08f, top});
    b.collide_cylinder(Vec3f{tip - 0.16f, y - 0.035f, 0.037f},
                       Vec3f{tip - 0.16f, y + 0.035f, 0.037f}, 0.037f);
    add_wheel(&b, &shop, {post, side * 0.055f, 0.1f}, 0.1f, 0.05f, {0.05, 0.05, 0.052},
              {0.55, 0.55, 0.53});
  }
  b.collide_cylinder(Vec3f{post, -0.08f, 0.1f}, Vec3f{post, 0.08f, 0.1f}, 0.1f);
  // Head between the forks, pump, tiller.
  b.show("head", paint,
         plate_y(rounded_outline({{heel - 0.02f, 0.05f},
                                  {heel + 0.03f, 0.05f},
                                  {heel + 0.03f, 0.09f},
                                  {heel - 0.0f, 0.26f},
                                  {heel - 0.06f, 0.40f},
                                  {heel - 0.10f, 0.40f},
                                  {heel - 0.10f, 0.24f},
                                  {heel - 0.03f, 0.2f}},
                                 0.012f),
                 -0.12f, 0.12f));
  for (const float side : {-1.0f, 1.0f})
    b.show("head", paint,
           plate_y(rounded_outline({{heel, 0.04f},
                                    {heel + 0.05f, 0.04f},
                                    {heel + 0.05f, 0.085f},
                                    {heel - 0.02f, 0.24f},
                                    {heel - 0.05f, 0.24f}},
                                   0.01f),
                   side > 0 ? 0.12f : -0.265f, side > 0 ? 0.265f : -0.12f));
  b.show("pump", black, cylinder(0.042f, 0.19f, 0.33f, 0.006f, 20).moved(post, 0, 0));
  b.show("piston", shop.metal("chrome"),
         cylinder(0.02f, 0.33f, 0.42f, 0.002f, 16).moved(post, 0, 0));
  b.show("pump", black, slab({post - 0.05f, -0.07f, 0.15f}, {post + 0.05f, 0.07f, 0.22f}, 0.012f));
  const Vec3f foot{post - 0.045f, 0, 0.24f}, grip{post - 0.15f, 0, 1.0f};
  b.show("tiller", paint, bar(foot, grip, 0.019f, 0.019f, 14));
  b.show("pump", black,
         bar({post - 0.04f, -0.07f, 0.24f}, {post - 0.04f, 0.07f, 0.24f}, 0.024f, 0.024f, 14));
  const Path loop = rounded_path(
      {grip, grip + Vec3f{-0.005f, 0.115f, 0.03f}, grip + Vec3f{-0.025f, 0.125f, 0.17f},
       grip + Vec3f{-0.03f, 0.10f, 0.215f}, grip + Vec3f{-0.03f, -0.10f, 0.215f},
       grip + Vec3f{-0.025f, -0.125f, 0.17f}, grip + Vec3f{-0.005f, -0.115f, 0.03f}, grip},
      0.04f, 4);
  b.show("grip", shop.rubber({0.045, 0.045, 0.048}), tube(loop, 0.017f, 10));
  b.show(
      "lever", shop.plastic({0.62, 0.06, 0.05}),
      beam(grip + Vec3f{-0.01f, 0, 0.06f}, grip + Vec3f{-0.02f, 0, 0.19f}, 0.024f, 0.012f, 0.004f));
  b.collide_box({heel - 0.12f, -0.265f, 0.08f}, {heel + 0.05f, 0.265f, 0.25f});
  b.collide_capsule(foot, grip, 0.02f);
  b.collide_box({grip.x - 0.05f, -0.14f, grip.z + 0.02f}, {grip.x + 0.02f, 0.14f, grip.z + 0.23f});
  b.mass = 75;
  p.loose = true;
  return p;
}

Prop hand_truck(Workshop& shop) {
  // Sack truck: two bent tubes, a nose plate, pneumatic wheels behind it.
  const float wide = 0.21f, top = 1.15f;
  Prop p;
  PropPart& b = p.body();
  const std::string paint = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.66, 0.07, 0.05}, Vec3{0.05, 0.18, 0.42}, Vec3{0.10, 0.30, 0.14}})),
      0.32);
  for (const float side : {-1.0f, 1.0f}) {
    const float y = side * wide;
    b.show(
        "frame", paint,
        tube(rounded_path(
                 {{0.02f, y, 0.02f}, {0.0f, y, 0.8f}, {-0.05f, y, 1.0f}, {-0.20f, y, top - 0.04f}},
                 0.12f),
             0.014f, 10));
    b.show("grips", shop.rubber(),
           bar({-0.11f, y, 1.055f}, {-0.215f, y, top - 0.03f}, 0.018f, 0.018f, 12));
    b.show("frame", paint, beam({0.01f, y, 0.42f}, {-0.13f, y, 0.13f}, 0.006f, 0.03f));
    b.show("frame", paint, beam({0.018f, y, 0.10f}, {-0.13f, y, 0.13f}, 0.006f, 0.03f));
    add_wheel(&b, &shop, {-0.13f, side * 0.235f, 0.13f}, 0.13f, 0.075f, {0.04, 0.04, 0.042},
              {0.78, 0.70, 0.10});
    b.collide_cylinder(Vec3f{-0.13f, side * 0.20f, 0.13f}, Vec3f{-0.13f, side * 0.27f, 0.13f},
                       0.13f);
    // Guards over the wheels.
    b.show("frame", paint,
           tube(smooth_path({{0.012f, side * 0.225f, 0.36f},
                             {-0.09f, side * 0.235f, 0.29f},
                             {-0.22f, side * 0.235f, 0.25f}}),
                0.007f, 6));
  }
  for (const float z : {0.22f, 0.45f, 0.68f})
    b.show("frame", paint,
           tube(smooth_path({{0.012f, -wide, z}, {-0.03f, 0, z}, {0.012f, wide, z}}), 0.010f, 8));
  b.show("axle", shop.metal("steel"),
         bar({-0.13f, -0.29f, 0.13f}, {-0.13f, 0.29f, 0.13f}, 0.009f, 0.009f, 10));
  b.show("nose", shop.metal("galvanised"),
         slab({0.02f, -0.22f, 0}, {0.24f, 0.22f, 0.006f}, 0.002f) +
             slab({0.02f, -0.22f, 0}, {0.028f, 0.22f, 0.16f}, 0.002f));
  b.collide_box({0.0f, -0.22f, 0}, {0.24f, 0.22f, 0.006f});
  b.collide_box({-0.02f, -wide - 0.014f, 0.006f}, {0.03f, wide + 0.014f, 0.85f});
  b.collide_box({-0.22f, -wide - 0.018f, 0.85f}, {0.0f, wide + 0.018f, top});
  b.mass = 12;
  return p;
}

Prop platform_cart(Workshop& shop) {
  const Vec3f size = shop.size({0.6f, 1.0f, 0.95f});
  const float x = std::clamp(size.x, 0.4f, 0.9f) / 2, y = std::clamp(size.y, 0.6f, 1.6f) / 2,
              deck = 0.21f, z = std::clamp(size.z, 0.8f, 1.1f);
  Prop p;
  PropPart& b = p.body();
  const std::string paint = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.05, 0.20, 0.46}, Vec3{0.30, 0.31, 0.32}, Vec3{0.10, 0.32, 0.18}})),
      0.35);
  b.show("deck", shop.wood("birch", Axis::kY),
         slab({-x + 0.006f, -y + 0.006f, deck - 0.012f}, {x - 0.006f, y - 0.006f, deck}, 0.002f));
  for (const float s : {-1.0f, 1.0f}) {
    b.show("frame", paint,
           slab({s * (x - 0.003f) - 0.003f, -y, deck - 0.045f},
                {s * (x - 0.003f) + 0.003f, y, deck + 0.003f}, 0.001f));
    b.show("frame", paint,
           slab({-x, s * (y - 0.003f) - 0.003f, deck - 0.045f},
                {x, s * (y - 0.003f) + 0.003f, deck + 0.003f}, 0.001f));
    for (const float e : {-1.0f, 1.0f}) {
      add_caster(&b, &shop, s * (x - 0.09f), e * (y - 0.11f), deck - 0.012f, 0.08f);
      b.collide_cylinder(0.03f, 0, deck - 0.045f, s * (x - 0.09f), e * (y - 0.11f));
    }
  }
  // Push bar at one end, bent from one tube.
  const float at = -y + 0.03f;
  b.show("bar", paint,
         tube(rounded_path({{-x + 0.04f, at, deck - 0.03f},
                            {-x + 0.04f, at - 0.03f, z - 0.013f},
                            {x - 0.04f, at - 0.03f, z - 0.013f},
                            {x - 0.04f, at, deck - 0.03f}},
                           0.09f, 6),
              0.0135f, 10));
  b.show("bar", paint,
         bar({-x + 0.04f, at - 0.015f, 0.55f}, {x - 0.04f, at - 0.015f, 0.55f}, 0.010f, 0.010f, 8));
  b.collide_box({-x, -y, deck - 0.045f}, {x, y, deck + 0.003f})
      .collide_box({-x + 0.026f, at - 0.045f, deck + 0.003f}, {x - 0.026f, at + 0.012f, z});
  b.mass = 8 + 22 * 4 * x * y;
  p.loose = true;
  p.surfaces.push_back({{-x + 0.02f, -y + 0.08f}, {x - 0.02f, y - 0.02f}, deck + 0.003f});
  return p;
}

Prop tool_trolley(Workshop& shop) {
  // Steel cabinet on castors: seven drawers that slide, a mat in its top.
  const float x = 0.235f, y = 0.35f, foot = 0.14f, top = 0.92f;
  Prop p;
  PropPart& b = p.body();
  const std::string paint = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.62, 0.05, 0.05}, Vec3{0.06, 0.20, 0.42}, Vec3{0.14, 0.15, 0.16}})),
      0.25);
  const std::string dark = shop.paint({0.06, 0.06, 0.065}, 0.4);
  b.show("body", paint,
         slab({-x, -y, foot}, {x - 0.02f, -y + 0.02f, top}, 0.004f) +
             slab({-x, y - 0.02f, foot}, {x - 0.02f, y, top}, 0.004f) +
             slab({-x, -y, foot}, {-x + 0.01f, y, top}, 0.003f) +
             slab({-x, -y, foot}, {x - 0.02f, y, foot + 0.04f}, 0.004f) +
             slab({-x, -y, top - 0.03f}, {x - 0.02f, y, top}, 0.004f));
  b.collide_box({-x, -y, foot}, {x - 0.024f, -y + 0.016f, top})
      .collide_box({-x, y - 0.016f, foot}, {x - 0.024f, y, top})
      .collide_box({-x, -y, foot}, {-x + 0.012f, y, top});
  b.collide_box({-x, -y, top - 0.03f}, {x, y, top + 0.025f})
      .collide_box({-x, -y, 0.0f}, {x - 0.024f, y, foot + 0.04f});
  for (const float s : {-1.0f, 1.0f}) {
    b.show("tray", dark,
           slab({s * (x - 0.008f) - 0.008f, -y, top - 0.005f},
                {s * (x - 0.008f) + 0.008f, y, top + 0.025f}, 0.006f) +
               slab({-x, s * (y - 0.008f) - 0.008f, top - 0.005f},
                    {x, s * (y - 0.008f) + 0.008f, top + 0.025f}, 0.006f));
    for (const float e : {-1.0f, 1.0f})
      add_caster(&b, &shop, s * (x - 0.06f), e * (y - 0.07f), foot, 0.055f);
  }
  b.show("mat", shop.rubber({0.06, 0.06, 0.065}),
         slab({-x + 0.012f, -y + 0.012f, top}, {x - 0.012f, y - 0.012f, top + 0.004f}, 0.001f));
  b.show("handle", shop.metal("chrome"),
         tube(rounded_path({{-0.12f, -y, top - 0.10f},
                            {-0.12f, -y - 0.05f, top - 0.10f},
                            {0.12f, -y - 0.05f, top - 0.10f},
                            {0.12f, -y, top - 0.10f}},
                           0.03f),
              0.011f, 10));
  const float heights[] = {0.075f, 0.075f, 0.075f, 0.075f, 0.10f, 0.15f, 0.15f};
  float z = top - 0.036f;
  for (int i = 0; i < 7; ++i) {
    const float h = heights[i];
    PropPart& d = p.hang("drawer_" + std::to_string(i + 1), {x - 0.02f, 0, z - h / 2},
                         {.slides = true,
                          .axis = {1, 0, 0},
                          .low = 0,
                          .high = 0.38,
                          .initial = 0,
                          .damping = 6,
                          .friction = 3});
    const float half = h / 2 - 0.002f, wide = y - 0.024f;
    d.show("front", paint, slab({0, -wide, -half}, {0.016f, wide, half}, 0.003f));
    d.show("grip", shop.metal("aluminium"),
           plate_y(rounded_outline({{0.014f, half - 0.022f},
                                    {0.028f, half - 0.022f},
                                    {0.028f, half - 0.002f},
                                    {0.014f, half - 0.002f}},
                                   0.005f, 2),
                   -wide + 0.01f, wide - 0.01f));
    d.show(
        "box", shop.metal("galvanised"),
        slab({-0.40f, -wide + 0.012f, -half + 0.004f}, {0, wide - 0.012f, -half + 0.006f}, 0) +
            slab({-0.40f, -wide + 0.012f, -half + 0.004f}, {0, -wide + 0.014f, half - 0.012f}, 0) +
            slab({-0.40f, wide - 0.014f, -half + 0.004f}, {0, wide - 0.012f, half - 0.012f}, 0) +
            slab({-0.40f, -wide + 0.012f, -half + 0.004f}, {-0.398f, wide - 0.012f, half - 0.012f},
                 0));
    d.collide_box({0, -wide, -half}, {0.026f, wide, half})
        .collide_box({-0.40f, -wide + 0.012f, -half + 0.004f}, {0, wide - 0.012f, -half + 0.012f});
    d.mass = 2.5 + 20 * h;
    z -= h;
  }
  b.mass = 38;
  p.front = 0.6f;
  p.surfaces.push_back({{-x + 0.02f, -y + 0.02f}, {x - 0.02f, y - 0.02f}, top + 0.025f});
  return p;
}

Prop step_ladder(Workshop& shop) {
  // Aluminium, flat treads in front, a platform, open like an A.
  const float height = std::clamp(
      shop.size({0.9f, 0.5f, 0.25f * float(shop.dice.integer(3, 6)) + 0.65f}).z, 0.9f, 3.2f);
  const float platform = height - 0.62f, half = 0.16f + 0.07f * height, slope = 0.28f;
  const int steps = std::max(2, int(platform / 0.235f + 0.5f));
  const float front = platform * slope + 0.10f, back = -platform * slope - 0.10f;
  Prop p;
  PropPart& b = p.body();
  const std::string alu = shop.metal("aluminium"), black = shop.plastic({0.04, 0.04, 0.042}, 0.5);
  const std::string accent = shop.plastic(shop.color({0.75, 0.12, 0.03}), 0.4);
  const auto side_at = [&](float z) { return half - 0.06f * z / height; };
  for (const float s : {-1.0f, 1.0f}) {
    const Vec3f low{front, s * half, 0.02f}, high{0.10f, s * side_at(platform), platform};
    b.show("rails", alu, beam(low, high + Vec3f{0, 0, 0.02f}, 0.022f, 0.06f));
    const Vec3f blow{back, s * half, 0.02f}, bhigh{-0.12f, s * side_at(platform), platform};
    b.show("rails", alu, beam(blow, bhigh, 0.02f, 0.04f));
    b.show("feet", black,
           rounded_box({0.07f, 0.032f, 0.05f}, 0.006f).moved(front, s * half, 0.025f) +
               rounded_box({0.05f, 0.03f, 0.05f}, 0.006f).moved(back, s * half, 0.025f));
    b.show("hoop", alu,
           tube(rounded_path({{0.10f, s * side_at(platform), platform - 0.05f},
                              {-0.08f, s * (side_at(platform) - 0.01f), height - 0.013f},
                              {-0.08f, 0, height - 0.013f}},
                             0.06f),
                0.0125f, 10));
    b.show("stays", alu,
           bar({front * 0.6f, s * (half - 0.012f), platform * 0.45f},
               {back * 0.6f, s * (half - 0.012f), platform * 0.45f}, 0.005f, 0.005f, 6));
    b.collide_box((low + high) * 0.5f, {0.03f, 0.013f, length(high - low) / 2},
                  turn({0, 1, 0}, std::atan2(high.x - low.x, high.z - low.z)));
    b.collide_box((blow + bhigh) * 0.5f, {0.02f, 0.012f, length(bhigh - blow) / 2},
                  turn({0, 1, 0}, std::atan2(bhigh.x - blow.x, bhigh.z - blow.z)));
  }
  for (int i = 1; i < steps; ++i) {
    const float t = float(i) / float(steps), z = platform * t, x = front + (0.10f - front) * t,
                y = side_at(z) - 0.010f;
    b.show("treads", alu, slab({x - 0.05f, -y, z - 0.028f}, {x + 0.035f, y, z}, 0.004f));
    for (int k = 0; k < 4; ++k)
      b.show("grooves", black,
             slab({x - 0.042f + 0.02f * float(k), -y + 0.006f, z - 0.001f},
                  {x - 0.036f + 0.02f * float(k), y - 0.006f, z + 0.0012f}, 0));
  }
  b.show("platform", accent,
         slab({-0.15f, -side_at(platform) - 0.012f, platform - 0.025f},
              {0.14f, side_at(platform) + 0.012f, platform + 0.004f}, 0.008f, 2));
  for (const float z : {0.25f, platform * 0.7f}) {
    const float t = z / platform, x = back + (-0.12f - back) * t;
    b.show("rails", alu, bar({x, -side_at(z), z}, {x, side_at(z), z}, 0.011f, 0.011f, 8));
  }
  b.collide_box({-0.15f, -side_at(platform), platform - 0.025f},
                {0.14f, side_at(platform), platform + 0.004f});
  b.collide_capsule({-0.08f, -side_at(platform) + 0.05f, height - 0.013f},
                    {-0.08f, side_at(platform) - 0.05f, height - 0.013f}, 0.0125f);
  b.mass = 3 + 3.2 * height;
  p.front = 0.4f;
  return p;
}

constexpr PropKind kCarts[] = {
    {"pallet_jack", pallet_jack, "hand pallet truck"},
    {"hand_truck", hand_truck, "sack truck with two wheels"},
    {"platform_cart", platform_cart, "flat cart with a push bar"},
    {"tool_trolley", tool_trolley, "cabinet of drawers on castors"},
    {"step_ladder", step_ladder, "aluminium steps with a platform"},
};

}  // namespace

PropFamily carts() { return kCarts; }

}  // namespace gloam
