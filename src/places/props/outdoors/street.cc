// Things in streets and yards.

#include <cmath>
#include <utility>

#include "places/catalogue.h"
#include "places/props/parts/hardware.h"
#include "places/props/parts/labels.h"

namespace gloam {
namespace {

Prop wheelie_bin(Workshop& shop) {
  // 240 l of EN 840: 0.74 x 0.58 x 1.07 m, 13 kg; its lid is hinged at the back.
  const float y = 0.28f, rim = 0.985f, wheel = 0.1f;
  const Vec3 color = shop.color(
      shop.dice.pick({Vec3{0.13, 0.14, 0.15}, Vec3{0.06, 0.20, 0.10}, Vec3{0.05, 0.16, 0.38}}));
  const Vec3 cover = shop.dice.pick({color, color, Vec3{0.80, 0.60, 0.05}, Vec3{0.05, 0.18, 0.42}});
  Prop p;
  PropPart& b = p.body();
  const std::string pe = shop.plastic(color, 0.5);
  // Four leaning walls: an upright trunk that widens from its foot.
  const auto shell = [&](float z0, float z1, float in) {
    const auto ring_at = [&](float z) {
      const float t = (z - 0.02f) / (rim - 0.02f);
      Profile q = rounded_rectangle(0.44f + 0.18f * t - 2 * in, 2 * (0.205f + 0.07f * t) - 2 * in,
                                    0.05f, 3);
      for (Vec2f& v : q) v.x += 0.03f + 0.02f * t;
      return q;
    };
    std::vector<Vec3f> points;
    const Profile low = ring_at(z0), high = ring_at(z1);
    for (const auto& [q, z] : {std::pair{&low, z0}, std::pair{&high, z1}})
      for (size_t i = 0; i <= q->size(); ++i)
        points.push_back({(*q)[i % q->size()].x, (*q)[i % q->size()].y, z});
    return sheet(points, int(low.size()) + 1, 0.004f);
  };
  b.show("body", pe, shell(0.02f, rim, 0));
  Profile floor = rounded_rectangle(0.44f, 0.41f, 0.05f, 3);
  for (Vec2f& v : floor) v.x += 0.03f;
  b.show("body", pe, extrude(floor, 0.0f, 0.025f));
  // Rim with its comb, grip at the back.
  for (const float s : {-1.0f, 1.0f})
    b.show("rim", pe,
           slab({-0.27f, s * y - 0.014f, rim - 0.05f}, {0.37f, s * y + 0.014f, rim}, 0.006f));
  b.show("rim", pe,
         slab({0.345f, -y, rim - 0.05f}, {0.375f, y, rim}, 0.006f) +
             slab({-0.275f, -y, rim - 0.05f}, {-0.255f, y, rim}, 0.006f));
  b.show("rim", pe,
         bar({-0.345f, -0.23f, rim + 0.005f}, {-0.345f, 0.23f, rim + 0.005f}, 0.014f, 0.014f, 12));
  for (const float s : {-1.0f, 1.0f}) {
    b.show("rim", pe,
           slab({-0.35f, s * 0.22f - 0.012f, rim - 0.04f},
                {-0.26f, s * 0.22f + 0.012f, rim + 0.012f}, 0.006f));
    add_wheel(&b, &shop, {-0.21f, s * 0.255f, wheel}, wheel, 0.05f, {0.05, 0.05, 0.052},
              {0.12, 0.12, 0.125});
    b.collide_cylinder(Vec3f{-0.21f, s * 0.23f, wheel}, Vec3f{-0.21f, s * 0.28f, wheel}, wheel);
  }
  b.show("axle", shop.metal("steel"),
         bar({-0.21f, -0.24f, wheel}, {-0.21f, 0.24f, wheel}, 0.011f, 0.011f, 10));
  b.show("label", warning_picture(&shop, 0),
         panel(0.1f, 0.1f).turned(Axis::kY, 9).moved(0.335f, 0, 0.72f));
  b.collide_box({-0.15f, -0.205f, 0}, {0.25f, 0.205f, 0.25f})
      .collide_box({-0.25f, -0.25f, 0.25f}, {0.31f, 0.25f, rim - 0.06f})
      .collide_box({-0.275f, -y - 0.014f, rim - 0.06f}, {0.375f, y + 0.014f, rim})
      .collide_capsule({-0.345f, -0.22f, rim + 0.005f}, {-0.345f, 0.22f, rim + 0.005f}, 0.014f);
  b.mass = 15;
  PropPart& lid = p.hang(
      "lid", {-0.30f, 0, rim + 0.014f},
      {.axis = {0, -1, 0}, .low = 0, .high = 1.9, .initial = 0, .damping = 0.15, .friction = 0.3});
  lid.show("cover", shop.plastic(cover, 0.5),
           plate_y(rounded_outline({{-0.01f, -0.008f},
                                    {0.70f, -0.010f},
                                    {0.70f, 0.015f},
                                    {0.55f, 0.055f},
                                    {0.15f, 0.065f},
                                    {-0.01f, 0.02f}},
                                   0.02f, 4),
                   -y - 0.018f, y + 0.018f));
  for (const float s : {-1.0f, 1.0f})
    lid.show("cover", shop.plastic(cover, 0.5),
             slab({-0.02f, s * 0.16f - 0.03f, -0.012f}, {0.06f, s * 0.16f + 0.03f, 0.03f}, 0.008f));
  lid.collide_box({-0.01f, -y - 0.018f, -0.008f}, {0.70f, y + 0.018f, 0.05f});
  lid.mass = 2;
  return p;
}

Prop waste_container(Workshop& shop) {
  // 1,100 l on four castors, sliding round lid: 1.37 x 1.08 x 1.4 m, 60 kg.
  const float x = 0.50f, y = 0.65f, rim = 1.16f, foot = 0.24f;
  const Vec3 color = shop.color(
      shop.dice.pick({Vec3{0.06, 0.22, 0.12}, Vec3{0.13, 0.14, 0.15}, Vec3{0.05, 0.17, 0.40}}));
  Prop p;
  PropPart& b = p.body();
  const std::string pe = shop.plastic(color, 0.5),
                    lid = shop.plastic(
                        shop.dice.pick({color, Vec3{0.82, 0.60, 0.04}, Vec3{0.06, 0.18, 0.42}}),
                        0.5);
  b.show(
      "body", pe,
      plate_y(rounded_outline({{-x + 0.09f, foot}, {x - 0.09f, foot}, {x, rim}, {-x, rim}}, 0.04f),
              -y + 0.06f, y - 0.06f));
  for (const float s : {-1.0f, 1.0f})
    b.show("body", pe,
           plate_x(rounded_outline(s > 0 ? Profile{{y - 0.15f, foot + 0.02f},
                                                   {y - 0.061f, foot + 0.02f},
                                                   {y, rim},
                                                   {y - 0.15f, rim}}
                                         : Profile{{-y + 0.061f, foot + 0.02f},
                                                   {-y + 0.15f, foot + 0.02f},
                                                   {-y + 0.15f, rim},
                                                   {-y, rim}},
                                   0.02f),
                   -x + 0.07f, x - 0.07f));
  b.show("rim", pe,
         slab({-x - 0.03f, -y - 0.03f, rim - 0.05f}, {x + 0.03f, y + 0.03f, rim}, 0.012f, 2));
  for (int k = 0; k < 5; ++k)
    for (const float s : {-1.0f, 1.0f}) {
      const float at = -y + 0.2f + (2 * y - 0.4f) * float(k) / 4;
      b.show("body", pe,
             beam({s * (x - 0.075f), at, foot + 0.1f}, {s * (x + 0.008f), at, rim - 0.05f}, 0.03f,
                  0.024f, 0.006f));
    }
  Profile dome;
  for (int k = 0; k <= 12; ++k) {
    const float a = kPi * float(k) / 12;
    dome.push_back({(x + 0.02f) * std::cos(a), rim + 0.26f * std::sin(a)});
  }
  b.show("lid", lid, plate_y(dome, -y + 0.03f, y - 0.03f));
  for (const float s : {-1.0f, 1.0f}) {
    Profile wide;
    for (const Vec2f q : dome) wide.push_back({q.x * 1.03f, rim + (q.y - rim) * 1.05f});
    b.show("lid", lid,
           plate_y(wide, s > 0 ? y - 0.07f : -y + 0.02f, s > 0 ? y - 0.02f : -y + 0.07f));
    b.show(
        "trunnions", shop.metal("galvanised"),
        bar({0, s * (y + 0.0f), rim - 0.1f}, {0, s * (y + 0.09f), rim - 0.1f}, 0.02f, 0.02f, 14) +
            bar({0, s * (y + 0.08f), rim - 0.1f}, {0, s * (y + 0.092f), rim - 0.1f}, 0.03f, 0.03f,
                14));
    for (const float e : {-1.0f, 1.0f}) {
      add_caster(&b, &shop, e * 0.33f, s * 0.45f, foot, 0.1f);
      b.collide_cylinder(0.05f, 0, foot, e * 0.33f, s * 0.45f);
    }
  }
  b.show("grip", shop.metal("galvanised"),
         tube(rounded_path({{x + 0.01f, -0.35f, rim - 0.1f},
                            {x + 0.07f, -0.35f, rim - 0.1f},
                            {x + 0.07f, 0.35f, rim - 0.1f},
                            {x + 0.01f, 0.35f, rim - 0.1f}},
                           0.03f),
              0.012f, 8));
  b.collide_box({-x + 0.05f, -y + 0.04f, foot}, {x - 0.05f, y - 0.04f, 0.7f})
      .collide_box({-x - 0.02f, -y - 0.03f, 0.7f}, {x + 0.03f, y + 0.03f, rim})
      .collide_box({-x + 0.06f, -y + 0.02f, rim}, {x - 0.06f, y - 0.02f, rim + 0.2f});
  b.mass = 60 + shop.dice.uniform(0, 120);
  return p;
}

Prop street_lamp(Workshop& shop) {
  // Conical mast with an LED head on a short arm: 8,000 lm, 3000 K.
  const float z = std::clamp(shop.size({1.2f, 0.3f, 6.0f}).z, 3.0f, 12.0f);
  Prop p;
  PropPart& b = p.body();
  const std::string mast = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.13, 0.14, 0.15}, Vec3{0.42, 0.44, 0.45}, Vec3{0.08, 0.14, 0.10}})),
      0.4);
  const float r0 = 0.055f + 0.004f * z, r1 = 0.034f;
  b.show("mast", mast, bar({0, 0, 0}, {0, 0, z}, r0, r1, 24));
  b.show("collar", mast,
         lathe(rounded({{r0 + 0.05f, 0}, {r0 + 0.05f, 0.02f}, {r0 + 0.01f, 0.06f}, {r0, 0.08f}},
                       0.01f),
               24));
  b.show("door", mast, rounded_box({0.012f, 0.085f, 0.4f}, 0.005f).moved(r0 - 0.006f, 0, 0.8f));
  b.show("lock", shop.metal("steel"),
         bar({r0 - 0.004f, 0, 0.95f}, {r0 + 0.004f, 0, 0.95f}, 0.008f, 0.007f, 3));
  b.show("arm", mast,
         tube(smooth_path({{0, 0, z - 0.15f},
                           {0.02f, 0, z - 0.02f},
                           {0.2f, 0, z + 0.045f},
                           {0.5f, 0, z + 0.06f}}),
              0.03f, 12));
  b.show("head", mast,
         plate_y(rounded_outline({{0.42f, z + 0.02f},
                                  {1.02f, z + 0.035f},
                                  {1.04f, z + 0.055f},
                                  {0.9f, z + 0.09f},
                                  {0.5f, z + 0.11f},
                                  {0.42f, z + 0.09f}},
                                 0.02f, 3),
                 -0.14f, 0.14f));
  b.show("lens", shop.glow({1.0, 0.86, 0.68}, 12000),
         slab({0.55f, -0.11f, z + 0.012f}, {0.98f, 0.11f, z + 0.028f}, 0.004f));
  b.collide_cylinder(r0 + 0.01f, 0, 2.0f).collide_cylinder(r0, 2.0f, z);
  b.collide_box({0.42f, -0.14f, z + 0.01f}, {1.04f, 0.14f, z + 0.1f});
  b.mass = 14 * z + 9;
  LightOptions lamp;
  lamp.type = LightType::kRect;
  lamp.position = {0.765, 0, z + 0.010};
  lamp.size = {0.42, 0.2};
  lamp.flux = 8000;
  lamp.temperature = 3000;
  p.lights.push_back(lamp);
  return p;
}

Prop park_bench(Workshop& shop) {
  const float y = std::clamp(shop.size({0.65f, 1.8f, 0.82f}).y, 0.9f, 3.0f) / 2;
  Prop p;
  PropPart& b = p.body();
  const std::string iron = shop.paint(shop.color({0.06, 0.075, 0.07}), 0.4),
                    wood = shop.wood("oak", Axis::kY);
  const int frames = y > 1.0f ? 3 : 2;
  for (int i = 0; i < frames; ++i) {
    const float at = (-y + 0.2f) + (2 * y - 0.4f) * float(i) / float(frames - 1);
    const auto limb = [&](const Path& path, float r) {
      b.show("frames", iron, tube(smooth_path(path), r, 8).moved(0, at, 0));
    };
    limb({{0.25f, 0, 0.012f}, {0.19f, 0, 0.18f}, {0.20f, 0, 0.32f}, {0.23f, 0, 0.405f}}, 0.019f);
    limb({{-0.28f, 0, 0.012f},
          {-0.17f, 0, 0.20f},
          {-0.16f, 0, 0.38f},
          {-0.22f, 0, 0.60f},
          {-0.30f, 0, 0.82f}},
         0.019f);
    limb({{0.24f, 0, 0.402f}, {0.05f, 0, 0.385f}, {-0.17f, 0, 0.375f}}, 0.017f);
    limb({{0.20f, 0, 0.25f}, {0.02f, 0, 0.30f}, {-0.16f, 0, 0.25f}}, 0.012f);
    limb({{-0.215f, 0, 0.60f},
          {0.02f, 0, 0.64f},
          {0.22f, 0, 0.62f},
          {0.27f, 0, 0.56f},
          {0.22f, 0, 0.41f}},
         0.016f);
    for (const float fx : {0.25f, -0.28f})
      b.show("frames", iron,
             slab({fx - 0.05f, at - 0.03f, 0}, {fx + 0.05f, at + 0.03f, 0.014f}, 0.004f));
    b.collide_box({-0.33f, at - 0.03f, 0}, {0.30f, at + 0.03f, 0.39f});
  }
  for (int i = 0; i < 5; ++i) {
    const float sx = 0.225f - 0.095f * float(i), sz = 0.425f - 0.006f * float(i);
    b.show("slats", wood,
           slab({sx - 0.041f, -y, sz - 0.016f}, {sx + 0.041f, y, sz + 0.016f}, 0.006f, 2));
    for (const float s : {-1.0f, 1.0f})
      b.show("bolts", shop.metal("steel"),
             ball(0.008f, 8).scaled({1, 1, 0.4f}).moved(sx, s * (y - 0.2f), sz + 0.016f));
  }
  for (int i = 0; i < 4; ++i) {
    const float h = 0.50f + 0.095f * float(i), bx = -0.165f - 0.36f * (h - 0.47f);
    b.show("slats", wood,
           slab({-0.014f, -y, -0.04f}, {0.014f, y, 0.04f}, 0.006f, 2)
               .turned(Axis::kY, -20)
               .moved(bx, 0, h));
  }
  b.collide_box({-0.20f, -y, 0.39f}, {0.27f, y, 0.44f});
  b.collide_box({-0.225f, 0, 0.64f}, {0.02f, y, 0.18f}, turn({0, 1, 0}, -0.35));
  b.mass = 20 + 22 * 2 * y;
  p.surfaces.push_back({{-0.12f, -y + 0.05f}, {0.25f, y - 0.05f}, 0.441f});
  p.front = 0.7f;
  return p;
}

Prop mailbox(Workshop& shop) {
  // Yellow or blue box with a domed top on a post.
  Prop p;
  PropPart& b = p.body();
  const std::string paint = shop.paint(
      shop.color(
          shop.dice.pick({Vec3{0.90, 0.62, 0.02}, Vec3{0.05, 0.18, 0.45}, Vec3{0.66, 0.05, 0.05}})),
      0.3);
  const float y = 0.22f, x = 0.17f, low = 0.62f, high = 1.15f;
  Profile side{{-x, low}, {x, low}, {x, high}};
  for (int k = 1; k < 10; ++k) {
    const float a = kPi * float(k) / 10;
    side.push_back({x * std::cos(a), high + x * 0.7f * std::sin(a)});
  }
  side.push_back({-x, high});
  b.show("box", paint, plate_y(side, -y, y));
  Profile brim;
  for (const Vec2f q : side) brim.push_back({q.x * 1.05f, low + (q.y - low) * 1.012f + 0.004f});
  for (const float s : {-1.0f, 1.0f})
    b.show("box", paint,
           plate_y(brim, s > 0 ? y - 0.02f : -y - 0.006f, s > 0 ? y + 0.006f : -y + 0.02f));
  b.show("slot", shop.paint(kSafetyBlack, 0.7),
         slab({x - 0.004f, -0.15f, 1.08f}, {x + 0.0015f, 0.15f, 1.115f}, 0.001f));
  b.show("flap", paint,
         slab({-0.003f, -0.16f, -0.05f}, {0.003f, 0.16f, 0}, 0.002f)
             .turned(Axis::kY, -32)
             .moved(x + 0.003f, 0, 1.13f));
  b.show("hatch", paint,
         slab({x - 0.002f, -0.17f, low + 0.04f}, {x + 0.006f, 0.17f, low + 0.38f}, 0.003f));
  b.show("lock", shop.metal("chrome"),
         bar({x, 0.13f, low + 0.22f}, {x + 0.014f, 0.13f, low + 0.22f}, 0.012f, 0.011f, 16));
  b.show("times", shipping_label(&shop),
         panel(0.16f, 0.112f).moved(x + 0.0066f, -0.04f, low + 0.26f));
  b.show("post", shop.metal("galvanised"),
         slab({-0.04f, -0.04f, 0.01f}, {0.04f, 0.04f, low}, 0.006f, 2) +
             slab({-0.12f, -0.12f, 0}, {0.12f, 0.12f, 0.012f}, 0.003f));
  b.collide_box({-x, -y - 0.006f, low}, {x + 0.01f, y + 0.006f, high + 0.07f})
      .collide_box({-0.04f, -0.04f, 0}, {0.04f, 0.04f, low})
      .collide_box({-0.12f, -0.12f, 0}, {0.12f, 0.12f, 0.012f});
  b.mass = 32;
  p.front = 0.6f;
  return p;
}

// City bicycle along x on its side stand, leaning 8 degrees; wheels of 700 mm. Points are those of
// the upright bicycle, its wheels on the ground [m].
struct Bicycle {
  explicit Bicycle(Workshop& maker) : shop(maker) {
    paint = shop.paint(shop.color(shop.dice.pick({Vec3{0.05, 0.16, 0.22}, Vec3{0.55, 0.06, 0.05},
                                                  Vec3{0.10, 0.10, 0.11}, Vec3{0.62, 0.68, 0.60}})),
                       0.22);
    chrome = shop.metal("chrome"), black = shop.rubber({0.035, 0.035, 0.037});
  }

  Solid lift(const Solid& s) const { return s.turned(Axis::kX, lean).moved(0, 0, 0.0017f); }
  void pipe(PropPart& b, Vec3f from, Vec3f to, float radius) const {
    b.show("frame", paint, lift(bar(from, to, radius, radius, 14)));
  }
  void show_frame(PropPart& b) const;
  void show_side(PropPart& b, float s) const;
  void show_wheel(PropPart& b, float wx) const;
  void show_mudguard(PropPart& b, float wx) const;
  void show_fittings(PropPart& b) const;
  void collide(PropPart& b) const;

  Workshop& shop;
  std::string paint, chrome, black;
  const float r = 0.345f, back = -0.53f, front = 0.53f, lean = 8;  // radius, hubs; [deg]
  const Vec3f bracket{-0.09f, 0, 0.29f}, seat{-0.235f, 0, 0.80f}, head{0.36f, 0, 0.86f},
      fork{0.40f, 0, 0.70f}, rear{back, 0, r}, axle{front, 0, r};
};

void Bicycle::show_frame(PropPart& b) const {
  pipe(b, bracket, seat, 0.016f), pipe(b, bracket, fork, 0.019f),
      pipe(b, seat - Vec3f{0, 0, 0.06f}, head - Vec3f{-0.005f, 0, 0.03f}, 0.016f),
      pipe(b, fork - Vec3f{-0.008f, 0, 0.03f}, head, 0.021f);
}

// Parts of one side: s = -1, 1.
void Bicycle::show_side(PropPart& b, float s) const {
  const Vec3f out{0, s * 0.055f, 0};
  pipe(b, bracket + out * 0.5f, rear + out, 0.009f),
      pipe(b, seat + Vec3f{0.01f, s * 0.02f, -0.05f}, rear + out, 0.008f);
  b.show("frame", paint,
         lift(tube(smooth_path({fork + Vec3f{0.006f, s * 0.045f, -0.02f},
                                fork + Vec3f{0.05f, s * 0.05f, -0.2f}, axle + out}),
                   0.010f, 8)));
  b.show("cranks", chrome,
         lift(beam(bracket + Vec3f{0, s * 0.075f, 0},
                   bracket + Vec3f{s * 0.12f, s * 0.085f, s * -0.12f}, 0.012f, 0.022f, 0.004f)));
  b.show("pedals", black,
         lift(rounded_box({0.09f, 0.085f, 0.022f}, 0.005f)
                  .moved(bracket + Vec3f{s * 0.12f, s * 0.14f, s * -0.12f})));
  b.show("grips", black,
         lift(bar({0.22f, s * 0.29f, 1.06f}, {0.12f, s * 0.30f, 1.05f}, 0.016f, 0.017f, 12)));
  b.show("bars", chrome,
         lift(tube(smooth_path({{0.345f, 0, 1.03f},
                                {0.36f, s * 0.12f, 1.04f},
                                {0.30f, s * 0.26f, 1.065f},
                                {0.14f, s * 0.30f, 1.052f}}),
                   0.0115f, 8)));
  b.show("levers", chrome,
         lift(tube(smooth_path({{0.27f, s * 0.275f, 1.06f},
                                {0.28f, s * 0.29f, 1.03f},
                                {0.17f, s * 0.305f, 1.02f}}),
                   0.005f, 6)));
}

void Bicycle::show_wheel(PropPart& b, float wx) const {
  Path loop, rim;
  for (int k = 0; k <= 48; ++k) {
    const float a = 2 * kPi * float(k) / 48;
    loop.push_back({wx + (r - 0.019f) * std::cos(a), 0, r + (r - 0.019f) * std::sin(a)});
    rim.push_back({wx + (r - 0.042f) * std::cos(a), 0, r + (r - 0.042f) * std::sin(a)});
  }
  b.show("tyres", shop.rubber(), lift(tube(loop, 0.019f, 10)));
  b.show("rims", shop.metal("aluminium"), lift(tube(rim, 0.010f, 6)));
  b.show("hubs", shop.metal("aluminium"),
         lift(bar({wx, -0.05f, r}, {wx, 0.05f, r}, 0.018f, 0.018f, 14)));
  for (int k = 0; k < 28; ++k) {
    const float a = 2 * kPi * float(k) / 28, s = k % 2 == 0 ? 1.0f : -1.0f,
                twist = (k / 2) % 2 == 0 ? 0.5f : -0.5f;
    b.show("spokes", chrome,
           lift(tube(
               {{wx + 0.018f * std::cos(a + twist), s * 0.035f, r + 0.018f * std::sin(a + twist)},
                {wx + (r - 0.048f) * std::cos(a), 0, r + (r - 0.048f) * std::sin(a)}},
               0.001f, 3)));
  }
}

void Bicycle::show_mudguard(PropPart& b, float wx) const {
  std::vector<Vec3f> guard;
  const float from = wx < 0 ? 0.6f : 0.9f, to = wx < 0 ? 3.5f : 2.9f;
  for (int k = 0; k <= 14; ++k)
    for (const float s : {-1.0f, 0.0f, 1.0f}) {
      const float a = from + (to - from) * float(k) / 14, q = r + 0.014f - 0.010f * s * s;
      guard.push_back({wx + q * std::cos(a), s * 0.026f, r + q * std::sin(a)});
    }
  b.show("guards", shop.plastic(kSafetyBlack, 0.3), lift(sheet(guard, 3, 0.0015f)));
}

void Bicycle::show_fittings(PropPart& b) const {
  b.show(
      "post", chrome,
      lift(bar(seat - Vec3f{0, 0, 0.02f}, seat + Vec3f{-0.035f, 0, 0.12f}, 0.0125f, 0.0125f, 12) +
           bar(head, {0.345f, 0, 1.035f}, 0.0115f, 0.0115f, 12)));
  b.show("saddle", shop.leather({0.10, 0.06, 0.035}),
         lift(cushion({0.26f, 0.19f, 0.06f}, 0.15f, 0.025f, 5, 1, 0)
                  .moved(seat + Vec3f{-0.07f, 0, 0.145f}) +
              cushion({0.16f, 0.055f, 0.05f}, 0.1f, 0.022f, 6, 1, 0)
                  .moved(seat + Vec3f{0.07f, 0, 0.15f})));
  b.show("rings", chrome,
         lift(ring(0.075f, 0.088f, -0.002f, 0.002f, 32)
                  .turned(Axis::kX, 90)
                  .moved(bracket + Vec3f{0, -0.06f, 0})));
  b.show("guard_chain", shop.plastic(kSafetyBlack, 0.3),
         lift(beam(bracket + Vec3f{0.02f, -0.062f, 0.03f}, rear + Vec3f{-0.02f, -0.062f, 0.0f},
                   0.022f, 0.11f, 0.01f)));
  b.show("lamp", chrome, lift(bar({0.39f, 0, 0.93f}, {0.44f, 0, 0.93f}, 0.02f, 0.035f, 18)));
  b.show("carrier", shop.metal("black"),
         lift(tube(rounded_path({{-0.30f, 0.05f, 0.735f},
                                 {-0.68f, 0.05f, 0.735f},
                                 {-0.68f, -0.05f, 0.735f},
                                 {-0.30f, -0.05f, 0.735f}},
                                0.03f),
                   0.005f, 6) +
              bar({-0.66f, 0.05f, 0.735f}, {back, 0.06f, r}, 0.004f, 0.004f, 6) +
              bar({-0.66f, -0.05f, 0.735f}, {back, -0.06f, r}, 0.004f, 0.004f, 6)));
  // Leans to -y, where the stand is.
  b.show("stand", shop.metal("black"),
         bar({-0.14f, -0.03f, 0.27f}, {-0.10f, -0.185f, 0.006f}, 0.008f, 0.007f, 8));
}

void Bicycle::collide(PropPart& b) const {
  const auto at = [&](Vec3f q) {
    const float c = std::cos(lean * kPi / 180), s = std::sin(lean * kPi / 180);
    return Vec3f{q.x, c * q.y - s * q.z, s * q.y + c * q.z + 0.0017f};
  };
  for (const float wx : {back, front})
    b.collide_cylinder(at({wx, -0.012f, r}), at({wx, 0.012f, r}), r);
  b.collide_capsule(at(bracket), at(seat + Vec3f{-0.03f, 0, 0.1f}), 0.02f)
      .collide_capsule(at(bracket), at(fork), 0.02f)
      .collide_capsule(at(seat), at(head), 0.02f);
  b.collide_capsule(at({0.2f, -0.29f, 1.055f}), at({0.2f, 0.29f, 1.055f}), 0.02f)
      .collide_sphere(at(seat + Vec3f{-0.05f, 0, 0.13f}), 0.06f);
}

Prop bicycle(Workshop& shop) {
  const Bicycle m(shop);
  Prop p;
  PropPart& b = p.body();
  m.show_frame(b);
  for (const float side : {-1.0f, 1.0f}) m.show_side(b, side);
  for (const float hub : {m.back, m.front}) {
    m.show_wheel(b, hub);
    m.show_mudguard(b, hub);
  }
  m.show_fittings(b);
  m.collide(b);
  b.mass = 16;
  return p;
}

Prop planter(Workshop& shop) {
  const Vec3f size = shop.size({0.5f, 1.0f, 0.5f});
  const float x = std::clamp(size.x, 0.3f, 1.5f) / 2, y = std::clamp(size.y, 0.3f, 3.0f) / 2,
              z = std::clamp(size.z, 0.3f, 1.0f), wall = 0.05f;
  Prop p;
  PropPart& b = p.body();
  const std::string stone = shop.concrete();
  for (const float s : {-1.0f, 1.0f}) {
    b.show("box", stone,
           slab({s > 0 ? x - wall : -x, -y, 0.03f}, {s > 0 ? x : -x + wall, y, z}, 0.008f, 2) +
               slab({-x + 0.01f, s > 0 ? y - wall : -y, 0.03f},
                    {x - 0.01f, s > 0 ? y : -y + wall, z}, 0.008f, 2));
    b.show("feet", stone,
           slab({-x + 0.04f, s * (y - 0.12f) - 0.05f, 0},
                {x - 0.04f, s * (y - 0.12f) + 0.05f, 0.04f}, 0.004f));
  }
  b.show("earth", shop.earth(),
         slab({-x + 0.03f, -y + 0.03f, 0.03f}, {x - 0.03f, y - 0.03f, z - 0.06f}, 0));
  // A low hedge: leaves along twigs.
  const std::string leaf = shop.leaf(
      shop.dice.pick({Vec3{0.16, 0.32, 0.10}, Vec3{0.20, 0.36, 0.12}, Vec3{0.12, 0.28, 0.14}}));
  const int twigs = std::clamp(int(4 * x * y * 130), 12, 160);
  for (int i = 0; i < twigs; ++i) {
    const Vec3f foot{float(shop.dice.uniform(-x + 0.09, x - 0.09)),
                     float(shop.dice.uniform(-y + 0.09, y - 0.09)), z - 0.07f};
    const float tall = float(shop.dice.uniform(0.2, 0.42)),
                dx = float(shop.dice.uniform(-0.10, 0.10)),
                dy = float(shop.dice.uniform(-0.10, 0.10));
    const Vec3f tip = foot + Vec3f{dx, dy, tall};
    b.show("twigs", shop.wood("walnut", Axis::kZ), tube({foot, tip}, 0.003f, 4));
    for (int k = 0; k < 14; ++k) {
      const float t = 0.15f + 0.85f * float(k) / 13, a = 2.4f * float(k) + float(i),
                  up = float(shop.dice.uniform(0.1, 0.9)),
                  l = float(shop.dice.uniform(0.04, 0.065));
      const Vec3f at = foot + (tip - foot) * t, d{std::cos(a), std::sin(a), up},
                  side{-std::sin(a), std::cos(a), 0.15f};
      const Vec3f points[6] = {at - side * 0.001f,
                               at + side * 0.001f,
                               at + d * (l * 0.5f) - side * (l * 0.24f),
                               at + d * (l * 0.5f) + side * (l * 0.24f),
                               at + d * l - side * 0.001f,
                               at + d * l + side * 0.001f};
      b.show("leaves", leaf, sheet(points, 2));
    }
  }
  b.collide_box({-x, -y, 0.0f}, {x, y, z});
  b.mass = 2300.0 * 2 * wall * (2 * x + 2 * y) * z + 1300.0 * 4 * x * y * (z - 0.1);
  return p;
}

constexpr PropKind kStreet[] = {
    {"wheelie_bin", wheelie_bin, "wheelie bin of 240 l with a hinged lid"},
    {"waste_container", waste_container, "waste container of 1,100 l"},
    {"street_lamp", street_lamp, "mast with an LED head of 8,000 lm"},
    {"park_bench", park_bench, "oak slats on iron frames"},
    {"mailbox", mailbox, "letter box on a post"},
    {"bicycle", bicycle, "city bicycle on its side stand"},
    {"planter", planter, "concrete trough with a low hedge"},
};

}  // namespace

PropFamily street() { return kStreet; }

}  // namespace gloam
