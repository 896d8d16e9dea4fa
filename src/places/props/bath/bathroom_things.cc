// Small things in bathrooms.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Prop bath_mat(Workshop& shop) {
  const Vec3f size = shop.size({0.50f, 0.75f, 0.014f});
  const float x = std::clamp(size.x, 0.3f, 1.0f) / 2, y = std::clamp(size.y, 0.4f, 1.5f) / 2,
              z = 0.014f;
  const std::string pile = shop.carpet(shop.color(towel_color(shop)));
  Prop p;
  PropPart& b = p.body();
  const auto at = [&](float in, float h) {
    return ring({-x + in, -y + in}, {x - in, y - in}, 0.03f, h, 5);
  };
  b.show("mat", pile,
         loft({at(0.003f, 0), at(0, 0.004f), at(0.001f, z * 0.7f), at(0.006f, z), at(0.055f, z),
               at(0.058f, z - 0.004f), at(0.068f, z - 0.004f), at(0.071f, z),
               point_of(at(0, 0), {0, 0, z})}));
  b.collide_box({-x, -y, 0}, {x, y, z});
  b.mass = 2.2 * 4 * x * y;  // 2,200 g/m²
  return p;
}

Prop toilet_brush(Workshop& shop) {
  const std::string white =
      shop.dice.chance(0.5) ? shop.ceramic(shop.color({0.90, 0.90, 0.88})) : shop.metal("steel");
  Prop p;
  PropPart& b = p.body();
  b.show("holder", white,
         lathe(rounded({{0, 0},
                        {0.046f, 0},
                        {0.050f, 0.004f},
                        {0.046f, 0.13f},
                        {0.043f, 0.132f},
                        {0.041f, 0.13f},
                        {0.042f, 0.01f},
                        {0, 0.01f}},
                       0.003f),
               36));
  b.show("handle", shop.metal("chrome"),
         bar({0.004f, 0, 0.05f}, {0.010f, 0, 0.385f}, 0.006f, 0.007f, 14) +
             ball(0.012f, 14).moved(0.0105f, 0, 0.388f));
  b.show("cap", shop.metal("chrome"),
         cone(0.040f, 0.010f, 0.128f, 0.150f, 0.003f, 30).moved(0.004f, 0, 0));
  b.collide_cylinder(0.050f, 0, 0.13f);
  b.collide_cylinder(0.038f, 0.13f, 0.14f);
  b.collide_capsule({0.006f, 0, 0.15f}, {0.010f, 0, 0.388f}, 0.010f);
  b.mass = 0.75;
  p.loose = true;
  return p;
}

Prop soap_dispenser(Workshop& shop) {
  const Vec3 tint = shop.color(shop.dice.pick<Vec3>(
      {{0.86, 0.85, 0.82}, {0.16, 0.17, 0.18}, {0.42, 0.50, 0.46}, {0.55, 0.38, 0.28}}));
  Prop p;
  PropPart& b = p.body();
  b.show("bottle", shop.ceramic(tint),
         lathe(rounded({{0, 0},
                        {0.034f, 0},
                        {0.036f, 0.004f},
                        {0.036f, 0.105f},
                        {0.028f, 0.125f},
                        {0.014f, 0.132f},
                        {0, 0.132f}},
                       0.006f, 3),
               32));
  const std::string metal = bright_metal(shop);
  b.show("pump", metal,
         cylinder(0.0145f, 0.131f, 0.146f, 0.002f, 24) +
             cylinder(0.004f, 0.145f, 0.172f, 0.001f, 12) +
             cylinder(0.011f, 0.168f, 0.178f, 0.003f, 20));
  b.show(
      "pump", metal,
      tube(smooth_path(
               {{0, 0, 0.174f}, {0.025f, 0, 0.175f}, {0.040f, 0, 0.172f}, {0.045f, 0, 0.163f}}, 4),
           0.0042f, 10));
  b.collide_cylinder(0.036f, 0, 0.125f);
  b.collide_cylinder(0.012f, 0.125f, 0.178f);
  b.mass = 0.55;
  p.loose = true;
  return p;
}

Prop scale(Workshop& shop) {
  const Vec3 tint = shop.color(shop.dice.pick<Vec3>({{0.88, 0.88, 0.87}, {0.05, 0.05, 0.055}}));
  Prop p;
  PropPart& b = p.body();
  const float x = 0.15f, y = 0.15f;
  const auto at = [&](float in, float z) {
    return ring({-x + in, -y + in}, {x - in, y - in}, 0.03f - in * 0.5f, z, 5);
  };
  const Path any = at(0, 0);
  b.show("plate", shop.plastic(tint, 0.06),
         loft({point_of(any, {0, 0, 0.016f}), at(0.002f, 0.016f), at(0, 0.018f), at(0, 0.023f),
               at(0.002f, 0.025f), point_of(any, {0, 0, 0.025f})}));
  b.show("base", shop.plastic({0.30, 0.30, 0.31}),
         loft({point_of(any, {0, 0, 0.006f}), at(0.03f, 0.006f), at(0.012f, 0.016f)}));
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f}) {
      b.show("feet", shop.rubber(),
             cylinder(0.018f, 0, 0.010f, 0.002f, 18).moved(sx * 0.10f, sy * 0.10f, 0));
      b.show("contacts", shop.metal("steel"),
             slab({sx * 0.068f - 0.045f, sy * 0.085f - 0.026f, 0.0245f},
                  {sx * 0.068f + 0.045f, sy * 0.085f + 0.026f, 0.0254f}, 0.0004f));
    }
  b.show("display", shop.plastic({0.42, 0.46, 0.43}, 0.1),
         slab({0.10f, -0.034f, 0.0245f}, {0.132f, 0.034f, 0.0256f}, 0.0005f));
  b.show("digits", shop.paint({0.08, 0.08, 0.08}),
         slab({0.108f, -0.020f, 0.0255f}, {0.124f, -0.016f, 0.0258f}, 0) +
             slab({0.108f, -0.004f, 0.0255f}, {0.124f, 0, 0.0258f}, 0) +
             slab({0.108f, 0.010f, 0.0255f}, {0.111f, 0.020f, 0.0258f}, 0) +
             slab({0.121f, 0.010f, 0.0255f}, {0.124f, 0.020f, 0.0258f}, 0));
  b.collide_box({-x, -y, 0.010f}, {x, y, 0.025f});
  b.collide_box({-0.115f, -0.115f, 0}, {0.115f, 0.115f, 0.010f});
  b.mass = 1.9;
  p.loose = true;
  return p;
}

constexpr PropKind kBathroomThings[] = {
    {"bath_mat", bath_mat, "mat with a deep pile"},
    {"toilet_brush", toilet_brush, "brush in its holder"},
    {"soap_dispenser", soap_dispenser, "pump bottle"},
    {"scale", scale, "bathroom scale"},
};

}  // namespace

PropFamily bathroom_things() { return kBathroomThings; }

}  // namespace gloam
