#include "places/props/parts/joinery.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace gloam {
namespace {

constexpr float kGap = 0.0015f;  // half the gap between two fronts [m]

// Cloth and printed card; display values.
constexpr std::array<Vec3, kBookTints> kTints = {{{0.45, 0.10, 0.08},
                                                  {0.08, 0.19, 0.32},
                                                  {0.72, 0.52, 0.16},
                                                  {0.15, 0.30, 0.20},
                                                  {0.80, 0.76, 0.66},
                                                  {0.10, 0.10, 0.11},
                                                  {0.55, 0.27, 0.13},
                                                  {0.25, 0.40, 0.45},
                                                  {0.62, 0.62, 0.60},
                                                  {0.34, 0.14, 0.24}}};

// Thickness, height, depth [m].
constexpr Vec3f kBooks[] = {{0.018f, 0.21f, 0.14f}, {0.024f, 0.24f, 0.16f}, {0.030f, 0.22f, 0.15f},
                            {0.028f, 0.22f, 0.16f}, {0.038f, 0.27f, 0.19f}, {0.045f, 0.25f, 0.17f},
                            {0.022f, 0.29f, 0.21f}, {0.033f, 0.30f, 0.20f}};

// Part of a cylinder about an axis x = depth - bulge … that a book's back is.
Solid spine(float x, float half_thickness, float bulge, float z0, float z1) {
  constexpr int kSteps = 6;
  Path points;
  for (const float z : {z0, z1}) {
    for (int i = 0; i <= kSteps; ++i) {
      const float a = kPi * (float(i) / kSteps - 0.5f);
      points.push_back({x + bulge * std::cos(a), half_thickness * std::sin(a), z});
    }
  }
  return sheet(points, kSteps + 1);
}

}  // namespace

Vec3f limited(Vec3f size, Vec3f low, Vec3f high) {
  return {std::clamp(size.x, low.x, high.x), std::clamp(size.y, low.y, high.y),
          std::clamp(size.z, low.z, high.z)};
}

Solid standing(const Solid& solid) { return solid.moved(0, 0, -solid.low().z); }

Solid round_legs(float x, float y, float height, float radius_foot, float radius_top, float splay) {
  Solid legs;
  for (const float i : {-1.0f, 1.0f})
    for (const float j : {-1.0f, 1.0f})
      legs += bar({i * (x + splay), j * (y + splay), 0}, {i * x, j * y, height}, radius_foot,
                  radius_top, 16);
  return standing(legs);
}

void collide_legs(PropPart* part, float x, float y, float height, float radius, float middle) {
  for (const float i : {-1.0f, 1.0f})
    for (const float j : {-1.0f, 1.0f})
      part->collide_cylinder(radius, 0, height, i * x + middle, j * y);
}

Solid bow_pull(float length, bool upright) {
  const float h = length / 2;
  const Profile bend = rounded({{0, -h}, {0.028f, -h}, {0.028f, h}, {0, h}}, 0.010f, 3);
  Path path;
  for (const Vec2f p : bend) path.push_back(upright ? Vec3f{p.x, 0, p.y} : Vec3f{p.x, p.y, 0});
  return tube(path, 0.005f, 8);
}

Solid knob_pull(float radius) {
  return lathe(rounded({{0.45f * radius, 0},
                        {0.45f * radius, 0.8f * radius},
                        {radius, 1.0f * radius},
                        {0.95f * radius, 1.7f * radius},
                        {0, 1.8f * radius}},
                       0.3f * radius, 2),
               16)
      .turned(Axis::kY, 90);
}

FrontLook front_look(Workshop& shop, const std::string& material) {
  const int pull = shop.dice.integer(0, 2);
  return {material, pull == 1 && shop.dice.chance(0.4) ? material : shop.metal(), pull};
}

PropPart& add_drawer(Prop* p, Workshop& shop, const std::string& name, float face, Vec2f low,
                     Vec2f high, float depth, const FrontLook& look) {
  constexpr float kFront = 0.018f, kSide = 0.012f;
  const float w = (high.x - low.x) / 2 - kGap, h = (high.y - low.y) / 2 - kGap;
  PropPart& d = p->hang(name, {face, (low.x + high.x) / 2, (low.y + high.y) / 2},
                        {.slides = true,
                         .axis = {1, 0, 0},
                         .high = 0.8 * double(depth),
                         .damping = 6,
                         .friction = 4});
  const bool grip = look.pull == 2;
  const float top = grip ? h - 0.012f : h;
  d.show("front", look.material, slab({0, -w, -h}, {kFront, w, top}, 0.0025f));
  if (grip) {
    // A finger's gap: the front ends lower and its edge is a bevelled strip behind.
    d.show("front", look.material, slab({0, -w, top - 0.002f}, {0.006f, w, h}, 0.0012f));
  } else if (look.pull == 1) {
    const bool two = w > 0.32f;
    for (const float side : {-1.0f, 1.0f})
      if (two || side > 0)
        d.show("pull", look.pull_material,
               knob_pull(0.014f).moved(kFront, two ? side * 0.55f * w : 0, 0));
  } else {
    d.show("pull", look.pull_material,
           bow_pull(min(0.16f, 0.8f * w), false).moved(kFront, 0, min(0.4f * h, 0.03f)));
  }
  // The box behind; its sides leave room for the slides.
  const float bw = w - 0.03f, bh = h - 0.02f;
  const std::string board = shop.wood("birch", Axis::kX);
  for (const float side : {-1.0f, 1.0f})
    d.show("box", board,
           slab({-depth, side * bw - kSide / 2, -bh}, {0, side * bw + kSide / 2, bh * 0.8f}, 0));
  d.show("box", board, slab({-depth, -bw, -bh}, {-depth + kSide, bw, bh * 0.8f}, 0));
  d.show("box", board, slab({-depth, -bw, -bh}, {0, bw, -bh + 0.006f}, 0));
  d.collide_box({0, -w, -h}, {kFront, w, h});
  d.collide_box({-depth, -bw, -bh}, {0, bw, -bh + 0.01f});
  // Boards of 650 kg/m³, and as much again in things inside.
  d.mass = 650.0 * double(4 * w * h * kFront + 2 * depth * (bw * 0.006f + 2 * bh * kSide)) + 1;
  return d;
}

PropPart& add_door(Prop* p, const std::string& name, float face, Vec2f low, Vec2f high,
                   bool hinge_at_low_y, const FrontLook& look, float thickness) {
  const float w = high.x - low.x - 2 * kGap, h = (high.y - low.y) / 2 - kGap;
  const float side = hinge_at_low_y ? 1.0f : -1.0f;
  // The axis lies on the outer edge of the leaf's face: opening, it stays in front of its piece.
  PropPart& d = p->hang(
      name, {face + thickness, hinge_at_low_y ? low.x + kGap : high.x - kGap, (low.y + high.y) / 2},
      {.axis = {0, 0, hinge_at_low_y ? -1.0 : 1.0}, .high = 1.9, .damping = 0.4, .friction = 0.15});
  const float y0 = min(0.0f, side * w), y1 = max(0.0f, side * w);
  d.show("leaf", look.material, slab({-thickness, y0, -h}, {0, y1, h}, 0.003f));
  const float at = side * (w - 0.035f), z = h > 0.6f ? -0.05f : 0.35f * h;
  if (look.pull == 1) {
    d.show("pull", look.pull_material, knob_pull(0.014f).moved(0, at, z));
  } else {
    d.show("pull", look.pull_material,
           bow_pull(h > 0.6f ? 0.20f : min(0.12f, 0.6f * h), true).moved(0, at, z));
  }
  d.collide_box({-thickness, y0, -h}, {0, y1, h});
  d.mass = 650.0 * double(thickness * w * 2 * h);  // boards of 650 kg/m³
  return d;
}

Solid shade(float radius_low, float radius_high, float z0, float z1) {
  constexpr float t = 0.0015f;
  return sharp_lathe({{radius_low - t, z0},
                      {radius_low, z0},
                      {radius_high, z1},
                      {radius_high - t, z1},
                      {radius_low - t, z0}},
                     40);
}

void add_bulb(Prop* p, Vec3f at, double flux, double temperature, double radius) {
  LightOptions light;
  light.type = LightType::kSphere;
  light.position = {at.x, at.y, at.z};
  light.flux = flux;
  light.temperature = temperature;
  light.radius = radius;
  p->lights.push_back(std::move(light));
}

void show_book(PropPart* part, Workshop& shop, Vec3f size, Vec3f at, float lean_degrees,
               float turn_degrees, int tint, bool lying) {
  const float d = size.x / 2, w = size.y / 2, h = size.z, bulge = 0.22f * size.y;
  const auto placed = [&](Solid s) {
    if (lying) s = s.turned(Axis::kX, 90).moved(0, h / 2, w);
    return s.turned(Axis::kX, lean_degrees).turned(Axis::kZ, turn_degrees).moved(at);
  };
  const float inside = d - bulge;
  Solid cover = slab({-d, -w, 0}, {inside, -w + 0.0025f, h}, 0) +
                slab({-d, w - 0.0025f, 0}, {inside, w, h}, 0) + spine(inside, w, bulge, 0, h);
  part->show(fmt::format("books_{}", tint), shop.plastic(kTints[size_t(tint)], 0.6),
             placed(std::move(cover)));
  // Gold or white print on the back.
  const float z = h * (0.55f + 0.05f * float(tint % 5));
  part->show("titles", shop.paper({0.80, 0.72, 0.50}),
             placed(spine(inside + 0.0004f, 0.72f * w, 0.9f * bulge + 0.0004f, z, z + 0.14f * h)));
  part->show("pages", shop.paper({0.86, 0.82, 0.73}),
             placed(slab({-d + 0.003f, -w + 0.002f, 0.003f}, {inside, w - 0.002f, h - 0.003f}, 0)));
}

float show_books(PropPart* part, Workshop& shop, Vec3f low, float width, float height, float depth,
                 float share) {
  Dice& dice = shop.dice;
  float y = low.y + 0.004f;
  const float end = low.y + width * share;
  int tint = dice.integer(0, kBookTints - 1);
  float lean_space = 0;
  while (true) {
    const Vec3f kind = kBooks[dice.integer(0, 7)];
    const float tall = min(kind.y * float(dice.uniform(0.94, 1.04)), height - 0.02f),
                deep = min(kind.z, depth - 0.01f);
    if (y + kind.x > end) break;
    // Sets of one colour stand together.
    if (dice.chance(0.7)) tint = dice.integer(0, kBookTints - 1);
    show_book(part, shop, {deep, kind.x, tall},
              {low.x - deep / 2 - float(dice.uniform(0.004, 0.022)), y + kind.x / 2, low.z}, 0, 0,
              tint);
    y += kind.x + 0.0012f;
    lean_space = end - y;
  }
  // The last one leans where there is room.
  if (width * (1 - share) > 0.08f && lean_space >= 0) {
    constexpr float kLean = 14;
    const float rad = kLean * kPi / 180, tall = min(0.22f, height - 0.03f);
    show_book(part, shop, {0.15f, 0.026f, tall},
              {low.x - 0.09f, y + tall * std::sin(rad) + 0.013f * std::cos(rad) + 0.001f,
               low.z + 0.013f * std::sin(rad)},
              kLean, 0, tint);
    y += tall * std::sin(rad) + 0.03f;
  }
  return y;
}

}  // namespace gloam
