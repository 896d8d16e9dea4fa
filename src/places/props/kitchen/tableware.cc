// Small things of the table: mugs, bottles, bowls, plates.

#include <cmath>

#include "places/props/parts/joinery.h"

namespace gloam {
namespace {

// Stoneware of 2,300 kg/m³, a wall of 4 mm.
Vec3 glaze(Workshop& shop) {
  return shop.color(shop.dice.pick<Vec3>({{0.86, 0.85, 0.82},
                                          {0.48, 0.20, 0.12},
                                          {0.14, 0.24, 0.34},
                                          {0.40, 0.46, 0.38},
                                          {0.20, 0.20, 0.21},
                                          {0.80, 0.66, 0.42}}));
}

Solid vessel(const Profile& outline, float k, float rounding, int segments = 40) {
  Profile scaled;
  for (const Vec2f at : rounded(outline, rounding, 4)) scaled.push_back({at.x * k, at.y * k});
  return lathe(scaled, segments);
}

Prop mug(Workshop& shop) {
  const float h = limited(shop.size({0.12f, 0.085f, float(shop.dice.uniform(0.085, 0.105))}),
                          {0, 0, 0.06f}, {10, 10, 0.16f})
                      .z,
              k = h / 0.095f;
  const bool straight = shop.dice.chance(0.5);
  const float foot = straight ? 0.039f : 0.030f, rim = 0.041f;
  Prop p;
  PropPart& b = p.body();
  const std::string clay = shop.ceramic(glaze(shop));
  b.show("cup", clay,
         vessel({{0, 0.003f},
                 {foot - 0.006f, 0.003f},
                 {foot - 0.005f, 0},
                 {foot, 0},
                 {rim, 0.093f},
                 {rim - 0.001f, 0.095f},
                 {rim - 0.004f, 0.094f},
                 {foot - 0.003f, 0.008f},
                 {0, 0.007f}},
                k, 0.004f));
  Path grip;
  for (const Vec3f at : smooth_path({{0, rim - 0.004f, 0.076f},
                                     {0, 0.062f, 0.077f},
                                     {0, 0.070f, 0.050f},
                                     {0, 0.058f, 0.024f},
                                     {0, foot - 0.002f, 0.022f}},
                                    7))
    grip.push_back(at * k);
  b.show("cup", clay, tube(grip, 0.0055f * k, 10));
  if (shop.dice.chance(0.5))
    b.show("coffee", shop.plastic({0.10, 0.05, 0.025}, 0.08),
           lathe({{0.0372f * k, 0.074f * k}, {0, 0.074f * k}}, 36));
  b.collide_cylinder(0.039f * k, 0, h);
  b.collide_box(Vec3f{-0.006f, 0.039f, 0.018f} * k, Vec3f{0.006f, 0.070f, 0.082f} * k);
  b.mass = 0.34 * double(k * k);
  p.loose = true;
  return p;
}

// `k` scales the usual size.
void show_wine_bottle(Workshop& shop, PropPart& b, float k) {
  b.show(
      "glass",
      shop.plastic(shop.dice.chance(0.7) ? Vec3{0.11, 0.145, 0.115} : Vec3{0.16, 0.08, 0.03}, 0.06),
      vessel({{0, 0.012f},
              {0.022f, 0.004f},
              {0.030f, 0},
              {0.0375f, 0.004f},
              {0.0375f, 0.19f},
              {0.015f, 0.235f},
              {0.0145f, 0.285f},
              {0.0165f, 0.287f},
              {0.0165f, 0.298f},
              {0.0130f, 0.300f},
              {0, 0.300f}},
             k, 0.014f));
  b.show(
      "capsule",
      shop.paint(shop.dice.pick<Vec3>({{0.30, 0.05, 0.06}, {0.07, 0.07, 0.08}, {0.62, 0.50, 0.24}}),
                 0.3),
      vessel({{0.0150f, 0.25f},
              {0.0153f, 0.285f},
              {0.0172f, 0.287f},
              {0.0172f, 0.3005f},
              {0.0100f, 0.3012f},
              {0, 0.3012f}},
             k, 0.002f, 32));
  b.show("label", shop.paper({0.86, 0.83, 0.74}),
         vessel({{0.0379f, 0.05f}, {0.0379f, 0.14f}}, k, 0, 40));
  b.show("label_band", shop.paper({0.40, 0.12, 0.10}),
         vessel({{0.0381f, 0.112f}, {0.0381f, 0.121f}}, k, 0, 40));
}

void show_water_bottle(Workshop& shop, PropPart& b, float k) {
  b.show("bottle", shop.solid_glass({0.86, 0.93, 0.95}),
         vessel({{0, 0.006f},
                 {0.02f, 0},
                 {0.030f, 0},
                 {0.0335f, 0.008f},
                 {0.0335f, 0.075f},
                 {0.0310f, 0.085f},
                 {0.0335f, 0.095f},
                 {0.0335f, 0.15f},
                 {0.0125f, 0.205f},
                 {0.0125f, 0.215f}},
                k, 0.008f));
  b.show("label",
         shop.paper(
             shop.dice.pick<Vec3>({{0.20, 0.42, 0.62}, {0.22, 0.50, 0.36}, {0.72, 0.30, 0.22}})),
         vessel({{0.0338f, 0.100f}, {0.0338f, 0.145f}}, k, 0, 40));
  b.show(
      "cap", shop.plastic({0.16, 0.36, 0.58}, 0.4),
      vessel(
          {{0.0128f, 0.208f}, {0.0150f, 0.209f}, {0.0150f, 0.228f}, {0.0130f, 0.230f}, {0, 0.230f}},
          k, 0.002f, 28));
  b.show("cap", shop.plastic({0.16, 0.36, 0.58}, 0.4),
         vessel({{0.0125f, 0.203f}, {0.0148f, 0.2035f}, {0.0148f, 0.2065f}, {0.0125f, 0.207f}}, k,
                0.0005f, 28));
}

void show_flask(Workshop& shop, PropPart& b, float k) {
  b.show("flask",
         shop.paint(
             shop.color(shop.dice.pick<Vec3>(
                 {{0.10, 0.22, 0.26}, {0.70, 0.68, 0.64}, {0.50, 0.16, 0.12}, {0.09, 0.09, 0.10}})),
             0.42),
         vessel({{0, 0.002f},
                 {0.028f, 0},
                 {0.0345f, 0},
                 {0.0355f, 0.004f},
                 {0.0355f, 0.185f},
                 {0.0245f, 0.212f},
                 {0.0235f, 0.22f},
                 {0, 0.22f}},
                k, 0.006f));
  b.show("ring", shop.metal("steel"),
         vessel({{0.0225f, 0.214f}, {0.0243f, 0.215f}, {0.0243f, 0.223f}, {0.0225f, 0.224f}}, k,
                0.001f, 36));
  b.show(
      "lid", shop.plastic({0.125, 0.125, 0.127}, 0.5),
      vessel({{0.02f, 0.222f}, {0.026f, 0.224f}, {0.0255f, 0.257f}, {0.022f, 0.260f}, {0, 0.260f}},
             k, 0.004f, 32));
}

Prop bottle(Workshop& shop) {
  const int kind = shop.dice.integer(0, 2);  // wine, water of plastic, flask of steel
  const float usual = kind == 0 ? 0.30f : kind == 1 ? 0.23f : 0.26f;
  const float h = limited(shop.size({0.075f, 0.075f, usual}), {0, 0, 0.12f}, {10, 10, 0.45f}).z,
              k = h / usual;
  Prop p;
  PropPart& b = p.body();
  if (kind == 0)
    show_wine_bottle(shop, b, k);
  else if (kind == 1)
    show_water_bottle(shop, b, k);
  else
    show_flask(shop, b, k);
  const float r = (kind == 1   ? 0.0335f
                   : kind == 0 ? 0.0375f
                               : 0.0355f) *
                  k,
              shoulder = h * (kind == 0   ? 0.65f
                              : kind == 1 ? 0.68f
                                          : 0.74f);
  b.collide_cylinder(r, 0, shoulder);
  b.collide_cylinder((kind == 2 ? 0.026f : 0.016f) * k, shoulder, h);
  b.mass = (kind == 0 ? 1.2 : kind == 1 ? 0.52 : 0.75) * double(k * k * k);
  p.loose = true;
  return p;
}

Prop bowl(Workshop& shop) {
  Dice& dice = shop.dice;
  const float r = limited(shop.size({2 * float(dice.uniform(0.075, 0.14)), 0, 0}), {0.1f, 0, 0},
                          {0.4f, 10, 10})
                      .x /
                  2,
              k = r / 0.15f;
  Prop p;
  PropPart& b = p.body();
  const bool wooden = dice.chance(0.25);
  b.show("bowl", wooden ? shop.wood(Axis::kX) : shop.ceramic(glaze(shop)),
         vessel({{0, 0.004f},
                 {0.052f, 0.004f},
                 {0.055f, 0},
                 {0.064f, 0},
                 {0.066f, 0.006f},
                 {0.125f, 0.045f},
                 {0.150f, 0.083f},
                 {0.145f, 0.084f},
                 {0.118f, 0.05f},
                 {0.06f, 0.014f},
                 {0, 0.012f}},
                k, 0.016f, 48));
  if (r > 0.11f && dice.chance(0.6)) {
    const Vec3f spots[] = {{0.056f, 0.022f, 0.060f},
                           {-0.036f, 0.056f, 0.061f},
                           {-0.034f, -0.054f, 0.060f},
                           {0.046f, -0.056f, 0.061f},
                           {0.006f, 0.0f, 0.112f}};
    for (int i = 0; i < 5; ++i) {
      const bool orange = i % 2 == 0;
      const Vec3f at = spots[i] * k;
      const float q = 0.038f * k;
      b.show(
          orange ? "oranges" : "apples",
          orange ? shop.plastic({0.88, 0.42, 0.06}, 0.45) : shop.plastic({0.56, 0.09, 0.06}, 0.25),
          (orange ? ball(q, 24)
                  : lathe(rounded({{0, -0.78f * q},
                                   {0.5f * q, -q},
                                   {1.12f * q, 0.1f * q},
                                   {0.55f * q, 0.98f * q},
                                   {0, 0.70f * q}},
                                  0.98f * q, 7),
                          26))
              .turned(Axis::kX, float(dice.uniform(-35, 35)))
              .turned(Axis::kZ, float(dice.uniform(0, 360)))
              .moved(at));
      if (!orange)
        b.show("stalks", shop.paint({0.20, 0.13, 0.07}, 0.8),
               tube(smooth_path({at + Vec3f{0, 0, 0.72f * q}, at + Vec3f{0.003f, 0, 1.05f * q},
                                 at + Vec3f{0.007f, 0.002f, 1.25f * q}},
                                3),
                    0.0014f, 6));
    }
    b.mass += 5 * 0.17 * double(k * k * k);
    b.collide_cylinder(0.09f * k, 0.083f * k, 0.10f * k);
  }
  b.collide_cylinder(0.066f * k, 0, 0.02f * k);
  b.collide_cylinder(0.118f * k, 0.02f * k, 0.05f * k);
  b.collide_cylinder(0.146f * k, 0.05f * k, 0.083f * k);
  b.mass += (wooden ? 0.45 : 1.1) * double(k * k);
  p.loose = true;
  return p;
}

Prop plate(Workshop& shop) {
  Dice& dice = shop.dice;
  const float r = limited(shop.size({float(dice.pick({0.20, 0.27})), 0, 0}), {0.12f, 0, 0},
                          {0.35f, 10, 10})
                      .x /
                  2,
              k = r / 0.135f;
  Prop p;
  PropPart& b = p.body();
  const Profile outline = {{0, 0.002f},      {0.070f, 0.002f},  {0.072f, 0},      {0.078f, 0},
                           {0.085f, 0.004f}, {0.132f, 0.019f},  {0.135f, 0.021f}, {0.132f, 0.0225f},
                           {0.090f, 0.011f}, {0.080f, 0.0065f}, {0, 0.006f}};
  const Vec3 color = glaze(shop);
  const int count = dice.chance(0.25) ? dice.integer(2, 5) : 1;
  for (int i = 0; i < count; ++i) {
    const float dy = float(dice.uniform(-0.001, 0.001)), dx = float(dice.uniform(-0.001, 0.001));
    b.show("plate", shop.ceramic(color),
           vessel(outline, k, 0.004f, 56).moved(dx, dy, 0.0072f * k * float(i)));
  }
  const float stack = 0.0072f * k * float(count - 1);
  b.collide_cylinder(0.080f * k, 0, 0.008f * k + stack);
  b.collide_cylinder(0.130f * k, 0.008f * k + stack, 0.022f * k + stack);
  b.mass = 0.62 * double(k * k) * count;
  p.loose = true;
  return p;
}

constexpr PropKind kTableware[] = {
    {"mug", mug, "cup with a handle, some with coffee"},
    {"bottle", bottle, "bottle of wine or water, or a flask"},
    {"bowl", bowl, "bowl, some with fruit"},
    {"plate", plate, "plate, or a few in a stack"},
};

}  // namespace

PropFamily tableware() { return kTableware; }

}  // namespace gloam
