// Toilets and washbasins.

#include <algorithm>
#include <cmath>

#include "places/props/parts/fittings.h"

namespace gloam {
namespace {

std::string china(Workshop& shop) { return shop.ceramic(shop.color({0.92, 0.92, 0.90})); }

// Seat, or its lid when it has no hole: a flat oval from z0 to z1 with soft edges.
Solid seat_plate(float z0, float z1, bool hole) {
  const auto at = [](float in, float z) {
    return oval(0.06f, 0.275f - in, 0.19f - in, 0.183f - in, z, 2.2f);
  };
  const auto inner = [](float out, float z) {
    return oval(0.09f, 0.165f + out, 0.155f + out, 0.105f + out, z);
  };
  const float r = 0.006f;
  std::vector<Path> rings;
  if (hole)
    rings = {inner(0, z0 + r), inner(r, z0)};
  else
    rings = {point_of(at(0, 0), {0.06f, 0, z0})};
  for (const Path& ring :
       {at(r, z0), at(0, z0 + r), at(0, z1 - r), at(0.3f * r, z1 - 0.3f * r), at(r, z1)})
    rings.push_back(ring);
  if (hole)
    rings.insert(rings.end(), {inner(r, z1), inner(0, z1 - r), inner(0, z0 + r)});
  else
    rings.insert(rings.end(),
                 {at(0.06f, z1 + 0.004f), point_of(at(0, 0), {0.06f, 0, z1 + 0.005f})});
  return loft(rings);
}

Prop toilet(Workshop& shop) {
  const std::string white = china(shop), seat = shop.plastic({0.90, 0.90, 0.89}, 0.18),
                    chrome = shop.metal("chrome");
  Prop p;
  PropPart& b = p.body();
  const bool tall = shop.dice.chance(0.5);  // an upright cistern, else a low and deep one
  const float top = tall ? 0.80f : 0.74f, side = tall ? 0.175f : 0.195f;
  b.show(
      "bowl", white,
      loft({oval(-0.05f, 0.25f, 0.25f, 0.120f, 0, 2.8f),
            oval(-0.05f, 0.25f, 0.25f, 0.120f, 0.02f, 2.8f),
            oval(-0.05f, 0.245f, 0.25f, 0.114f, 0.03f, 2.8f),
            oval(-0.05f, 0.235f, 0.26f, 0.108f, 0.14f, 2.7f),
            oval(-0.02f, 0.25f, 0.28f, 0.130f, 0.24f, 2.5f),
            oval(0.03f, 0.275f, 0.27f, 0.165f, 0.31f, 2.4f),
            oval(0.055f, 0.275f, 0.24f, 0.181f, 0.36f, 2.3f),
            oval(0.06f, 0.272f, 0.235f, 0.182f, 0.395f, 2.2f),
            oval(0.06f, 0.268f, 0.23f, 0.178f, 0.403f, 2.2f),
            oval(0.085f, 0.190f, 0.180f, 0.130f, 0.403f),
            oval(0.085f, 0.183f, 0.173f, 0.123f, 0.396f),
            oval(0.085f, 0.183f, 0.173f, 0.123f, 0.375f),
            oval(0.08f, 0.170f, 0.165f, 0.115f, 0.33f), oval(0.06f, 0.120f, 0.130f, 0.085f, 0.25f),
            oval(0.03f, 0.060f, 0.075f, 0.055f, 0.20f),
            point_of(oval(0, 1, 1, 1, 0), {0.02f, 0, 0.17f})}));
  b.show("water", shop.plastic({0.62, 0.68, 0.69}, 0.02),
         loft({oval(0.045f, 0.082f, 0.098f, 0.066f, 0.225f),
               point_of(oval(0, 1, 1, 1, 0), {0.045f, 0, 0.225f})}));
  b.show("bowl", white, slab({-0.33f, -0.155f, 0.27f}, {-0.11f, 0.155f, 0.402f}, 0.03f, 3));
  b.show("cistern", white, slab({-0.33f, -side, 0.396f}, {-0.165f, side, top - 0.03f}, 0.022f, 4));
  b.show("cistern_lid", white,
         slab({-0.333f, -side - 0.005f, top - 0.032f}, {-0.158f, side + 0.005f, top - 0.002f},
              0.010f, 3));
  b.show("button", chrome,
         cylinder(0.026f, top - 0.004f, top + 0.002f, 0.001f, 28).moved(-0.245f, 0, 0));
  b.show("button", chrome,
         slab({-0.268f, -0.0006f, top + 0.0015f}, {-0.222f, 0.0006f, top + 0.0025f}, 0));
  b.show("seat", seat, seat_plate(0.408f, 0.424f, true));
  for (const float y : {-0.075f, 0.075f}) {
    b.show("hinges", chrome,
           bar({-0.135f, y - 0.02f, 0.425f}, {-0.135f, y + 0.02f, 0.425f}, 0.009f, 0.009f, 14));
    b.show("hinges", chrome, cylinder(0.012f, 0.402f, 0.422f, 0.002f, 14).moved(-0.135f, y, 0));
    b.show("bolts", shop.plastic({0.88, 0.88, 0.87}),
           ball(0.009f, 12).moved(-0.12f, y * 1.5f, 0.02f));
  }
  b.show("stop_valve", chrome,
         bar({-0.333f, -0.15f, 0.20f}, {-0.29f, -0.15f, 0.20f}, 0.010f, 0.010f, 12));
  b.show("stop_valve", chrome,
         tube(smooth_path({{-0.295f, -0.15f, 0.20f},
                           {-0.285f, -0.15f, 0.24f},
                           {-0.27f, -0.14f, 0.33f},
                           {-0.26f, -0.13f, 0.40f}},
                          4),
              0.005f, 8));
  b.collide_box({-0.30f, -0.115f, 0}, {0.19f, 0.115f, 0.27f});
  b.collide_box({-0.33f, -0.155f, 0.27f}, {0.14f, 0.155f, 0.402f});
  b.collide_cylinder(0.182f, 0.30f, 0.424f, 0.145f, 0);
  b.collide_box({-0.333f, -side, 0.402f}, {-0.16f, side, top});
  b.mass = 28;
  PropPart& lid = p.hang("lid", {-0.135f, 0, 0.432f},
                         {.axis = {0, -1, 0},
                          .low = 0,
                          .high = 1.6,
                          .initial = shop.dice.chance(0.25) ? 1.6 : 0.0,
                          .damping = 0.8,
                          .friction = 0.1});
  lid.show("lid", seat, seat_plate(-0.005f, 0.010f, false).moved(0.135f, 0, 0));
  lid.collide_box({0.01f, -0.15f, -0.005f}, {0.30f, 0.15f, 0.012f});
  lid.collide_cylinder(0.17f, -0.005f, 0.012f, 0.295f, 0);
  lid.mass = 1.6;
  p.front = 0.6f;
  return p;
}

// Basin whose rim is at z; returns the middle of its drain.
Vec3f show_basin(Workshop& shop, PropPart* b, float x, float y, float z) {
  const auto outer = [&](float in, float at) {
    return ring({-x, -y + in}, {x - in, y - in}, 0.05f, at, 6);
  };
  const auto inner = [&](float in, float at) {
    return ring({-x + 0.13f + in, -y + 0.055f + in}, {x - 0.045f - in, y - 0.055f - in}, 0.12f, at,
                6);
  };
  const Vec3f drain{0.045f, 0, z - 0.135f};
  b->show("basin", china(shop),
          loft({point_of(outer(0, 0), {0, 0, z - 0.165f}),
                ring({-x, -0.14f}, {x - 0.16f, 0.14f}, 0.05f, z - 0.165f, 6),
                ring({-x, -y + 0.08f}, {x - 0.09f, y - 0.08f}, 0.06f, z - 0.13f, 6),
                outer(0.012f, z - 0.06f), outer(0, z - 0.045f), outer(0, z - 0.010f),
                outer(0.003f, z - 0.003f), outer(0.010f, z), inner(-0.008f, z),
                inner(0, z - 0.003f), inner(0.006f, z - 0.012f), inner(0.03f, z - 0.08f),
                inner(0.06f, z - 0.118f), inner(0.10f, z - 0.130f), point_of(outer(0, 0), drain)}));
  const std::string chrome = shop.metal("chrome");
  b->show(
      "drain", chrome,
      cylinder(0.024f, drain.z - 0.002f, drain.z + 0.006f, 0.002f, 24).moved(drain.x, drain.y, 0));
  b->show("overflow", chrome,
          cylinder(0.010f, 0, 0.003f, 0.001f, 18)
              .turned(Axis::kY, 75)
              .moved(-x + 0.155f, 0, z - 0.05f));
  return drain;
}

Prop washbasin(Workshop& shop) {
  const Vec3f size = shop.size({0.48f, float(shop.dice.uniform(0.52, 0.68)), 0.85f});
  const float x = std::clamp(size.x, 0.40f, 0.60f) / 2, y = std::clamp(size.y, 0.45f, 1.0f) / 2,
              z = std::clamp(size.z, 0.70f, 0.95f);
  Prop p;
  PropPart& b = p.body();
  const Vec3f drain = show_basin(shop, &b, x, y, z);
  const std::string chrome = shop.metal("chrome");
  show_tap(shop, &b, {-x + 0.065f, 0, z - 0.001f}, 0.17f, 0.13f);
  if (shop.dice.chance(0.5)) {
    // Pedestal, half a column that hides the trap.
    const auto at = [&](float front, float half, float h) {
      return oval(-0.06f, front, x - 0.09f, half, h, 2.6f);
    };
    b.show("pedestal", china(shop),
           loft({at(0.15f, 0.105f, 0), at(0.15f, 0.105f, 0.015f), at(0.135f, 0.090f, 0.03f),
                 at(0.115f, 0.078f, 0.25f), at(0.118f, 0.080f, 0.5f), at(0.16f, 0.115f, z - 0.16f),
                 at(0.16f, 0.115f, z - 0.13f)}));
    b.collide_box({-x + 0.06f, -0.085f, 0}, {0.065f, 0.085f, z - 0.16f});
    b.mass = 17 + 12 * y;
  } else {
    const float low = z - 0.52f, high = z - 0.17f, w = y - 0.03f, front = x - 0.02f;
    add_carcass(&b, "carcass", shop.paint(shop.style.cabinet, 0.4), {-x, -w, low},
                {front - kFrontBoard - 0.002f, w, high});
    hang_drawer(shop, &p, "drawer", {front, -w, low}, 2 * w, high - low, 2 * x - 0.16f);
    b.show("trap", chrome,  // over the drawer's box
           tube(smooth_path({{drain.x, 0, drain.z},
                             {drain.x, 0, z - 0.24f},
                             {drain.x - 0.04f, 0, z - 0.27f},
                             {drain.x - 0.08f, 0, z - 0.24f},
                             {-x + 0.01f, 0, z - 0.23f}},
                            5),
                0.016f, 12));
    b.mass = 20 + 22 * y;
  }
  b.collide_box({-x, -y, z - 0.045f}, {-x + 0.13f, y, z});
  b.collide_box({x - 0.045f, -y, z - 0.06f}, {x, y, z});
  for (const float side : {-1.0f, 1.0f})
    b.collide_box({-x + 0.13f, side * (y - 0.03f) - 0.03f, z - 0.06f},
                  {x - 0.045f, side * (y - 0.03f) + 0.03f, z});
  b.collide_box({-x, -y + 0.08f, z - 0.165f}, {x - 0.09f, y - 0.08f, z - 0.128f});
  p.surfaces.push_back({{-x + 0.02f, 0.08f}, {-x + 0.12f, y - 0.04f}, z, 0.3f});
  p.front = 0.6f;
  return p;
}

constexpr PropKind kSanitary[] = {
    {"toilet", toilet, "toilet with cistern and hinged lid"},
    {"washbasin", washbasin, "washbasin on a pedestal or over a drawer, with tap"},
};

}  // namespace

PropFamily sanitary() { return kSanitary; }

}  // namespace gloam
