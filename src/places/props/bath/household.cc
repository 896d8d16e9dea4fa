// Bins, buckets, paper.

#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

Prop paper_roll(Workshop& shop) {
  const std::string wood = shop.wood(Axis::kZ);
  Prop p;
  PropPart& b = p.body();
  b.show("foot", wood, cylinder(0.075f, 0, 0.018f, 0.004f, 36));
  b.show("pole", wood,
         cylinder(0.009f, 0.016f, 0.32f, 0.003f, 16) + ball(0.014f, 14).moved(0, 0, 0.318f));
  const float r = float(shop.dice.uniform(0.045, 0.062));
  b.show(
      "roll", shop.paper({0.90, 0.90, 0.89}),
      sharp_lathe(
          {{0.021f, 0.0185f}, {r, 0.0185f}, {r, 0.278f}, {0.021f, 0.278f}, {0.021f, 0.0185f}}, 40));
  b.show("tube", shop.cardboard(),
         sharp_lathe({{0.0195f, 0.0188f},
                      {0.0208f, 0.0188f},
                      {0.0208f, 0.2783f},
                      {0.0195f, 0.2783f},
                      {0.0195f, 0.0188f}},
                     28));
  Path end;  // the first sheet hangs off a little
  constexpr int kColumns = 6;
  for (const float z : {0.0187f, 0.2778f})
    for (int i = 0; i < kColumns; ++i) {
      const float t = float(i) / (kColumns - 1);
      end.push_back({r + 0.0005f + 0.010f * t * t, -0.045f * t, z});
    }
  b.show("roll", shop.paper({0.90, 0.90, 0.89}), sheet(end, kColumns, 0.0006f));
  b.collide_cylinder(0.075f, 0, 0.018f);
  b.collide_cylinder(r, 0.018f, 0.278f);
  b.collide_cylinder(0.012f, 0.278f, 0.33f);
  b.mass = 0.55;
  p.loose = true;
  return p;
}

Prop waste_bin(Workshop& shop) {
  const bool painted = shop.dice.chance(0.5);
  const std::string steel = shop.metal("steel"),
                    paint = shop.paint(shop.color({0.86, 0.85, 0.82}), 0.3);
  const std::string shell = painted ? paint : steel, dark = shop.plastic({0.04, 0.04, 0.042}, 0.45);
  const float r = float(shop.dice.uniform(0.10, 0.14)),
              h = r * 2 + float(shop.dice.uniform(0.06, 0.22));
  Prop p;
  PropPart& b = p.body();
  b.show("foot", dark, cylinder(r + 0.003f, 0, 0.022f, 0.004f, 40));
  b.show("shell", shell,
         lathe({{r, 0.02f},
                {r, h},
                {r - 0.002f, h + 0.001f},
                {r - 0.004f, h},
                {r - 0.004f, 0.03f},
                {0, 0.03f}},
               44));
  b.show("bucket", shop.plastic({0.12, 0.12, 0.125}, 0.5),
         lathe(rounded({{0, 0.035f},
                        {r - 0.02f, 0.035f},
                        {r - 0.008f, h - 0.012f},
                        {r - 0.001f, h - 0.008f},
                        {r - 0.001f, h - 0.004f},
                        {r - 0.010f, h - 0.006f},
                        {r - 0.022f, 0.037f},
                        {0, 0.037f}},
                       0.002f),
               36));
  b.show("pedal", steel,
         slab({r - 0.01f, -0.022f, 0.006f}, {r + 0.045f, 0.022f, 0.012f}, 0.003f, 2));
  b.show("hinge", dark,
         slab({-r - 0.012f, -0.05f, h - 0.045f}, {-r + 0.004f, 0.05f, h + 0.003f}, 0.004f));
  b.collide_cylinder(r + 0.002f, 0, 0.025f);
  b.collide_cylinder(r, 0.025f, h);
  b.collide_box({r - 0.01f, -0.022f, 0.003f}, {r + 0.045f, 0.022f, 0.014f});
  b.mass = 1.5 + 30 * r * h;
  PropPart& lid =
      p.hang("lid", {-r - 0.004f, 0, h + 0.003f},
             {.axis = {0, -1, 0}, .low = 0, .high = 1.4, .damping = 0.05, .friction = 0.02});
  const Profile dome = rounded({{r - 0.006f, 0},
                                {r + 0.002f, 0.001f},
                                {r + 0.002f, 0.012f},
                                {r * 0.8f, 0.030f},
                                {0, 0.036f}},
                               0.008f, 3);
  lid.show("lid", shell, lathe(dome, 44).moved(r + 0.004f, 0, 0));
  lid.show("inside", dark,
           sharp_lathe({{r - 0.004f, 0.002f}, {0, 0.002f}}, 32)
               .mirrored(Axis::kZ)
               .moved(r + 0.004f, 0, 0.004f));
  lid.collide_cylinder(r + 0.001f, 0.001f, 0.034f, r + 0.004f, 0);
  lid.mass = 0.35;
  p.loose = true;
  return p;
}

Prop bucket(Workshop& shop) {
  const float r = 0.145f, low = 0.108f, h = 0.27f;
  const bool zinc = shop.dice.chance(0.35);
  const std::string plastic = shop.plastic(
      shop.color(shop.dice.pick<Vec3>(
          {{0.10, 0.24, 0.42}, {0.48, 0.13, 0.11}, {0.20, 0.38, 0.25}, {0.38, 0.40, 0.42}})),
      0.4);
  const std::string shell = zinc ? shop.metal("galvanised") : plastic;
  Prop p;
  PropPart& b = p.body();
  b.show("bucket", shell,
         lathe(rounded({{0, 0.006f},
                        {low - 0.012f, 0.006f},
                        {low - 0.010f, 0},
                        {low, 0},
                        {r, h - 0.012f},
                        {r + 0.007f, h - 0.010f},
                        {r + 0.007f, h},
                        {r - 0.002f, h},
                        {low - 0.004f, 0.010f},
                        {0, 0.010f}},
                       0.003f),
               44));
  for (const float side : {-1.0f, 1.0f})
    b.show("ears", shell,
           slab({-0.018f, side * (r - 0.004f) - 0.006f, h - 0.05f},
                {0.018f, side * (r - 0.004f) + 0.008f, h - 0.012f}, 0.005f, 2));
  // Handle, laid down to one side.
  Path bail;
  for (int i = 0; i <= 16; ++i) {
    const float angle = kPi * (float(i) / 16 - 0.5f);
    bail.push_back({(r + 0.012f) * std::cos(angle), (r + 0.004f) * std::sin(angle),
                    h - 0.03f + 0.036f * std::cos(angle)});
  }
  b.show("bail", shop.metal("steel"), tube(bail, 0.0028f, 8));
  b.show("grip", plastic, tube(Path(bail.begin() + 6, bail.begin() + 11), 0.0095f, 12));
  b.collide_cylinder(low, 0, 0.010f);
  constexpr int kSides = 8;
  for (int i = 0; i < kSides; ++i) {
    const float angle = 2 * kPi * float(i) / kSides, mid = (r + low) / 2,
                lean = std::atan2(r - low, h);
    const Quat q = turn({0, 0, 1}, angle), l = turn({0, 1, 0}, lean);
    const Quat both{q.w * l.w - q.z * l.z, q.w * l.x - q.z * l.y, q.w * l.y + q.z * l.x,
                    q.w * l.z + q.z * l.w};
    b.collide_box({mid * std::cos(angle), mid * std::sin(angle), h / 2 + 0.004f},
                  {0.003f, mid * std::tan(kPi / kSides), h / 2 - 0.006f}, both);
  }
  b.mass = zinc ? 1.4 : 0.7;
  p.loose = true;
  return p;
}

constexpr PropKind kHousehold[] = {
    {"paper_roll", paper_roll, "kitchen paper on its stand"},
    {"waste_bin", waste_bin, "pedal bin with a hinged lid"},
    {"bucket", bucket, "bucket of plastic or zinc"},
};

}  // namespace

PropFamily household() { return kHousehold; }

}  // namespace gloam
