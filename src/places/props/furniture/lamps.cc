// Lamps that stand. What shines is a sphere of light inside; a cloth shade that it lights through
// glows too.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// Luminance of a shade of this area through which `share` of the flux comes, on both faces.
double shade_luminance(double flux, double share, double area) {
  return share * flux / (2 * M_PI * area);
}

std::string cloth_glow(Workshop& shop, double luminance) {
  return shop.glow(shop.color(shop.dice.pick<Vec3>({{0.93, 0.82, 0.66}, {0.92, 0.86, 0.76}})),
                   std::round(luminance));
}

// A cloth shade about z with its rings, spider and bulb.
void add_shade(Prop* p, Workshop& shop, float r0, float r1, float z0, float z1, double flux,
               const std::string& metal) {
  PropPart& b = p->body();
  const double area = M_PI * double((r0 + r1) * std::hypot(r0 - r1, z1 - z0));
  b.show("shade", cloth_glow(shop, shade_luminance(flux, 0.45, area)), shade(r0, r1, z0, z1));
  for (const float end : {0.0f, 1.0f}) {
    const float r = (end > 0 ? r1 : r0) - 0.0005f, z = end > 0 ? z1 : z0;
    Path ring;
    for (int k = 0; k <= 40; ++k)
      ring.push_back(
          {r * std::cos(2 * kPi * float(k) / 40), r * std::sin(2 * kPi * float(k) / 40), z});
    b.show("shade_rings", metal, tube(ring, 0.0024f, 6));
  }
  for (int k = 0; k < 3; ++k) {
    const float a = 2 * kPi * float(k) / 3;
    b.show("shade_rings", metal,
           tube({{0, 0, z0 + 0.35f * (z1 - z0)},
                 {0.99f * (r0 + 0.12f * (r1 - r0)) * std::cos(a),
                  0.99f * (r0 + 0.12f * (r1 - r0)) * std::sin(a), z0 + 0.12f * (z1 - z0)}},
                0.0016f, 5));
  }
  b.show("socket", shop.plastic({0.125, 0.125, 0.127}),
         cylinder(0.018f, z0 + 0.12f * (z1 - z0), z0 + 0.42f * (z1 - z0), 0.003f, 18));
  add_bulb(p, {0, 0, z0 + 0.42f * (z1 - z0) + 0.03f}, flux, 2700);
}

Prop floor_lamp(Workshop& shop) {
  Dice& dice = shop.dice;
  const float z = limited(shop.size({0.4f, 0.4f, float(dice.uniform(1.45, 1.68))}), {0, 0, 1.1f},
                          {10, 10, 2.0f})
                      .z;
  const std::string metal = shop.metal(dice.pick<const char*>({"black", "brass", "steel"}));
  Prop p;
  PropPart& b = p.body();
  if (dice.chance(0.35)) {
    // Three wooden legs.
    for (int k = 0; k < 3; ++k) {
      const float a = 2 * kPi * float(k) / 3, c = std::cos(a), s = std::sin(a);
      const Solid leg =
          bar({0.24f * c, 0.24f * s, 0}, {0.025f * c, 0.025f * s, z - 0.30f}, 0.011f, 0.014f, 14);
      b.show("legs", shop.wood(Axis::kZ), standing(leg));
      b.collide_cylinder({0.222f * c, 0.222f * s, 0.08f}, {0.03f * c, 0.03f * s, z - 0.31f},
                         0.013f);
      b.collide_cylinder(0.013f, 0, 0.09f, 0.232f * c, 0.232f * s);
    }
    b.show("hub", metal, cylinder(0.045f, z - 0.33f, z - 0.285f, 0.004f, 28));
  } else {
    b.show("stand", metal,
           lathe(rounded({{0, 0},
                          {0.145f, 0},
                          {0.143f, 0.016f},
                          {0.02f, 0.024f},
                          {0.0105f, 0.04f},
                          {0.0105f, z - 0.26f},
                          {0.02f, z - 0.255f},
                          {0.02f, z - 0.22f},
                          {0, z - 0.22f}},
                         0.006f, 3),
                 40));
    b.collide_cylinder(0.145f, 0, 0.02f);
    b.collide_cylinder(0.012f, 0.02f, z - 0.27f);
  }
  const float r0 = float(dice.uniform(0.19, 0.23)), r1 = r0 - float(dice.uniform(0.0, 0.08));
  b.show("stand_neck", metal, cylinder(0.008f, z - 0.29f, z - 0.20f, 0.001f, 12));
  add_shade(&p, shop, r0, r1, z - 0.27f, z, 806, metal);
  b.show(
      "cable", shop.plastic({0.125, 0.125, 0.127}),
      tube(smooth_path({{-0.13f, 0, 0.008f}, {-0.17f, 0.01f, 0.0035f}, {-0.21f, 0.02f, 0.0035f}}),
           0.003f, 6));
  b.collide_cylinder(0.97f * (r0 + r1) / 2, z - 0.27f, z);
  b.mass = 5;
  p.loose = true;
  return p;
}

Prop table_lamp(Workshop& shop) {
  Dice& dice = shop.dice;
  const float z = limited(shop.size({0.26f, 0.26f, float(dice.uniform(0.38, 0.50))}), {0, 0, 0.28f},
                          {10, 10, 0.7f})
                      .z;
  const float k = z / 0.44f, foot = 0.58f * z;
  Prop p;
  PropPart& b = p.body();
  const Vec3 glaze = dice.pick<Vec3>(
      {{0.48, 0.17, 0.09}, {0.10, 0.22, 0.30}, {0.84, 0.82, 0.78}, {0.28, 0.33, 0.27}});
  const int form = dice.integer(0, 2);
  const Profile forms[3] = {{{0, 0},
                             {0.07f, 0},
                             {0.085f, 0.08f},
                             {0.03f, 0.17f},
                             {0.014f, 0.20f},
                             {0.012f, 0.255f},
                             {0, 0.255f}},
                            {{0, 0},
                             {0.052f, 0},
                             {0.105f, 0.10f},
                             {0.05f, 0.19f},
                             {0.014f, 0.205f},
                             {0.012f, 0.255f},
                             {0, 0.255f}},
                            {{0, 0},
                             {0.075f, 0},
                             {0.072f, 0.018f},
                             {0.018f, 0.03f},
                             {0.026f, 0.13f},
                             {0.012f, 0.22f},
                             {0.012f, 0.255f},
                             {0, 0.255f}}};
  Profile outline;
  for (const Vec2f at : rounded(forms[form], form == 2 ? 0.02f : 0.04f, 5))
    outline.push_back({at.x * k, at.y * k});
  b.show("foot", form == 2 ? shop.wood(Axis::kZ) : shop.ceramic(glaze), lathe(outline, 36));
  const float r0 = 0.135f * k, r1 = float(dice.uniform(0.085, 0.125)) * k;
  const std::string metal = shop.metal("brass");
  b.show("neck", metal, cylinder(0.009f * k, foot - 0.01f, foot + 0.03f, 0.001f, 14));
  add_shade(&p, shop, r0, r1, foot - 0.01f, z, 470, metal);
  b.show("cable", shop.plastic({0.80, 0.79, 0.76}),
         tube(smooth_path({{-0.06f * k, 0, 0.006f},
                           {-0.10f * k, 0.005f, 0.003f},
                           {-0.14f * k, 0.02f, 0.003f}}),
              0.0026f, 6));
  b.collide_cylinder(0.073f * k, 0, 0.16f * k);
  b.collide_cylinder(0.03f * k, 0.16f * k, foot - 0.01f);
  b.collide_cylinder((r0 + r1) / 2, foot - 0.01f, z);
  b.mass = 2.2 * double(k * k);
  p.loose = true;
  return p;
}

Prop desk_lamp(Workshop& shop) {
  Dice& dice = shop.dice;
  Prop p;
  PropPart& b = p.body();
  const bool brass = dice.chance(0.25);
  const std::string color = shop.paint(
      shop.color(dice.pick<Vec3>(
          {{0.10, 0.10, 0.105}, {0.84, 0.83, 0.80}, {0.16, 0.34, 0.36}, {0.62, 0.16, 0.10}})),
      0.35);
  const std::string metal = brass ? shop.metal("brass") : shop.metal("steel");
  const Vec3f low{-0.03f, 0, 0.045f}, elbow{-0.14f, 0, 0.36f}, head{0.13f, 0, 0.47f};
  b.show("base", color,
         lathe(rounded({{0, 0},
                        {0.085f, 0},
                        {0.084f, 0.016f},
                        {0.02f, 0.026f},
                        {0.016f, 0.045f},
                        {0, 0.045f}},
                       0.008f, 3),
               36)
             .moved(-0.03f, 0, 0));
  for (const float side : {-0.011f, 0.011f}) {
    b.show("arms", metal,
           bar(low + Vec3f{0, side, 0}, elbow + Vec3f{0, side, 0}, 0.0045f, 0.0045f, 10));
    b.show("arms", metal,
           bar(elbow + Vec3f{0, side, 0}, head + Vec3f{0, side, 0}, 0.0045f, 0.0045f, 10));
  }
  for (const Vec3f at : {low, elbow, head})
    b.show("joints", color,
           cylinder(0.013f, -0.018f, 0.018f, 0.003f, 18).turned(Axis::kX, 90).moved(at));
  // The head: a bell about an axis that leans forward.
  const Profile bell = rounded({{0, 0.03f},
                                {0.024f, 0.028f},
                                {0.066f, -0.045f},
                                {0.068f, -0.045f},
                                {0.026f, 0.03f},
                                {0.022f, 0.085f},
                                {0, 0.085f}},
                               0.012f, 3);
  const float lean = -18;
  b.show("head", color,
         lathe(bell, 32).turned(Axis::kY, lean).moved(head + Vec3f{0.025f, 0, -0.035f}));
  b.show("cable", shop.plastic({0.125, 0.125, 0.127}),
         tube(smooth_path({{-0.105f, 0, 0.008f}, {-0.14f, 0, 0.0032f}, {-0.18f, 0.02f, 0.0032f}}),
              0.003f, 6));
  LightOptions light;
  light.type = LightType::kDisk;
  const float a = lean * kPi / 180;
  const Vec3f mouth =
      head + Vec3f{0.025f, 0, -0.035f} + Vec3f{-std::sin(a), 0, -std::cos(a)} * 0.030f;
  light.position = {mouth.x, mouth.y, mouth.z};
  light.look_at = Vec3{mouth.x - std::sin(a), 0, mouth.z - std::cos(a)};
  light.radius = 0.045;
  light.flux = 450;
  light.temperature = 3500;
  p.lights.push_back(std::move(light));
  b.collide_cylinder(0.085f, 0, 0.022f, -0.03f, 0);
  b.collide_capsule(low, elbow, 0.016f);
  b.collide_capsule(elbow, head, 0.016f);
  b.collide_sphere(head + Vec3f{0.025f, 0, -0.025f}, 0.06f);
  b.mass = 1.6;
  p.loose = true;
  return p;
}

constexpr PropKind kLamps[] = {
    {"floor_lamp", floor_lamp, "standing lamp with a cloth shade"},
    {"table_lamp", table_lamp, "lamp with a shade for tables"},
    {"desk_lamp", desk_lamp, "lamp on a jointed arm"},
};

}  // namespace

PropFamily lamps() { return kLamps; }

}  // namespace gloam
