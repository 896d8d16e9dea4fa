// Buildings on open country: fences, weathered barns of boards.

#include <array>
#include <cmath>

#include "base/check.h"
#include "places/terrain/terrain_parts.h"

namespace gloam {
namespace {

constexpr double kFenceBay = 2.5, kInside = 0.6;  // bay of the fence; distance from the border [m]
constexpr float kEaves = 2.5f, kRidge = 3.7f, kDoor = 0.95f;  // barn: heights, half a door [m]

// One wall of boards along y at x = 0, its lower corners at y0 and y1; outside is +x.
void show_boards(PropPart* b, const std::string& wood, float y0, float y1, float low, float high,
                 bool gable, const Pose& X, Dice* dice) {
  const auto put = [&](Solid s) {
    s = s.turned(Axis::kZ, float(2 * std::atan2(X.q.z, X.q.w) * 180 / M_PI))
            .moved(float(X.p.x), float(X.p.y), 0);
    b->show("boards", wood, s);
  };
  for (float y = y0; y < y1 - 0.05f;) {
    const float wide = min(float(dice->uniform(0.13, 0.2)), y1 - y),
                lean = float(dice->uniform(-0.5, 0.5));
    const float middle = y + wide / 2, half = (y1 - y0) / 2 + 1e-3f;
    const float top =
        gable ? kEaves + (kRidge - kEaves) * (1 - std::abs(middle) / max(half, 2.0f)) : high;
    const float foot = low + float(dice->uniform(0, 0.12)),
                proud = float(dice->uniform(-0.006, 0.008));
    const bool missing = dice->chance(0.04);
    if (!missing && top > foot + 0.2f)
      put(slab({proud, -wide / 2 + 0.004f, foot}, {proud + 0.022f, wide / 2 - 0.004f, top}, 0.002f)
              .turned(Axis::kX, lean)
              .moved(0, middle, 0));
    y += wide;
  }
}

Prop make_barn(const BuildingSite& site, Workshop* shop, Dice* dice) {
  const float hx = float(site.half_x), hy = float(site.half_y);
  Prop p;
  p.label = "barn";
  PropPart& b = p.body();
  const std::string wood = shop->weathered_boards(Axis::kZ),
                    beam = shop->weathered_boards(Axis::kX), stone = shop->bedrock(),
                    sheet_metal = shop->rusty_sheet();
  const auto at = [](double x, double y, double yaw) {
    return Pose{{x, y, 0}, turn({0, 0, 1}, yaw)};
  };
  // Eaves run along y; gables are at +-y; the door is in the front, +x.
  show_boards(&b, wood, -hy, hy, 0.25f, kEaves, false, at(-hx, 0, M_PI), dice);
  show_boards(&b, wood, -hy, -kDoor, 0.25f, kEaves, false, at(hx, 0, 0), dice);
  show_boards(&b, wood, kDoor, hy, 0.25f, kEaves, false, at(hx, 0, 0), dice);
  show_boards(&b, wood, -kDoor, kDoor, 2.15f, kEaves, false, at(hx, 0, 0), dice);
  show_boards(&b, wood, -hx, hx, 0.25f, kEaves, true, at(0, hy, M_PI / 2), dice);
  show_boards(&b, wood, -hx, hx, 0.25f, kEaves, true, at(0, -hy, -M_PI / 2), dice);
  const auto wall = [&](Vec3f low, Vec3f high) {
    b.collide_box({low.x, low.y, -0.5f}, high);
    b.show(
        "base", stone,
        slab({low.x - 0.05f, low.y - 0.05f, -0.5f}, {high.x + 0.05f, high.y + 0.05f, 0.3f}, 0.03f));
  };
  wall({-hx - 0.06f, -hy, 0}, {-hx + 0.06f, hy, kEaves});
  wall({hx - 0.06f, -hy, 0}, {hx + 0.06f, -kDoor, kEaves});
  wall({hx - 0.06f, kDoor, 0}, {hx + 0.06f, hy, kEaves});
  wall({-hx, -hy - 0.06f, 0}, {hx, -hy + 0.06f, kEaves});
  wall({-hx, hy - 0.06f, 0}, {hx, hy + 0.06f, kEaves});
  for (const float x : {-hx + 0.12f, hx - 0.12f})
    for (const float y : {-hy + 0.12f, hy - 0.12f})
      b.show("posts", wood,
             slab({x - 0.07f, y - 0.07f, -0.4f}, {x + 0.07f, y + 0.07f, kEaves}, 0.006f));
  for (const float y : {-kDoor - 0.06f, kDoor + 0.06f})
    b.show("posts", wood,
           slab({hx - 0.08f, y - 0.06f, -0.4f}, {hx + 0.07f, y + 0.06f, 2.2f}, 0.006f));
  b.show("beams", beam,
         slab({hx - 0.08f, -kDoor - 0.1f, 2.1f}, {hx + 0.08f, kDoor + 0.1f, 2.25f}, 0.006f));
  // Corrugated sheets, one slope each, with overhang.
  const float out = 0.35f, slope = (kRidge - kEaves) / hx;
  for (const float side : {-1.0f, 1.0f}) {
    const float edge = hy + 0.3f;
    const int waves = int(2 * edge / 0.076f), columns = waves * 4 + 1;
    Path points;
    for (int r = 0; r <= 1; ++r)
      for (int c = 0; c < columns; ++c) {
        const float y = -edge + 2 * edge * float(c) / float(columns - 1);
        const float x = side * (r == 0 ? hx + out : 0.0f);
        const float z =
            kRidge + 0.03f - slope * std::abs(x) + 0.009f * std::sin(kPi / 2 * float(c));
        points.push_back({x, y, z});
      }
    b.show("roof", sheet_metal, sheet(points, columns, 0.001f));
    const float angle = std::atan(slope), length = std::hypot(hx + out, slope * (hx + out));
    b.collide_box({side * (hx + out) / 2, 0, kRidge - slope * (hx + out) / 2},
                  {length / 2, edge, 0.02f}, turn({0, 1, 0}, side * angle));
  }
  b.mass = 4000;
  return p;
}

}  // namespace

void add_fence(const Landscape& land, uint64_t seed, Workshop* shop, Place* place) {
  const Rect r = land.area().grown(-kInside);
  const std::string wood = shop->weathered_boards(Axis::kX),
                    post_wood = shop->weathered_boards(Axis::kZ), steel = shop->metal("galvanised");
  Prop p;
  p.label = "fence";
  PropPart& b = p.body();
  const std::array<Vec2f, 5> corners = {Vec2f{float(r.x0), float(r.y0)},
                                        {float(r.x1), float(r.y0)},
                                        {float(r.x1), float(r.y1)},
                                        {float(r.x0), float(r.y1)},
                                        {float(r.x0), float(r.y0)}};
  Dice dice(seed, "fence");
  for (size_t side = 0; side < 4; ++side) {
    const Vec2f from = corners[side], to = corners[side + 1];
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const int bays = std::max(1, static_cast<int>(std::lround(length / kFenceBay)));
    for (int i = 0; i < bays; ++i) {
      const auto point = [&](int k) {
        const float t = float(k) / float(bays);
        const Vec2f q = from + (to - from) * t;
        return Vec3f{q.x, q.y, float(land.height(q.x, q.y))};
      };
      const Vec3f a = point(i), e = point(i + 1);
      const float lean_x = float(dice.uniform(-0.02, 0.02)),
                  lean_y = float(dice.uniform(-0.02, 0.02));
      b.show("posts", post_wood,
             bar(a + Vec3f{0, 0, -0.4f}, a + Vec3f{lean_x, lean_y, 1.22f}, 0.058f, 0.05f, 8));
      const Vec3f middle = (a + e) * 0.5f;
      // Across the road a gate of tubes, closed.
      const bool gate =
          land.from_road(middle.x, middle.y) < land.road_width() / 2 + length / bays / 2;
      if (gate)
        for (const float z : {0.2f, 0.42f, 0.64f, 0.86f, 1.08f})
          b.show("gate", steel, bar(a + Vec3f{0, 0, z}, e + Vec3f{0, 0, z}, 0.02f, 0.02f, 10));
      else
        for (const float z : {0.4f, 0.76f, 1.1f}) {
          const float sag = float(dice.uniform(-0.03, 0.03));
          b.show("rails", wood,
                 bar(a + Vec3f{0, 0, z}, e + Vec3f{0, 0, z + sag}, 0.036f, 0.032f, 7));
        }
      const float run = std::hypot(e.x - a.x, e.y - a.y), rise = std::abs(e.z - a.z);
      b.collide_box(middle + Vec3f{0, 0, 0.5f}, {run / 2 + 0.02f, 0.05f, 0.7f + rise / 2},
                    turn({0, 0, 1}, std::atan2(double(e.y - a.y), double(e.x - a.x))));
    }
  }
  place->put(place->add(std::move(p)), "", {});
}

void add_barns(const Landscape& land, uint64_t seed, Workshop* shop, Place* place) {
  Dice dice(seed, "barns");
  for (const BuildingSite& site : land.sites()) {
    const Quat q = turn({0, 0, 1}, site.heading);
    place->put(place->add(make_barn(site, shop, &dice)), "", {{site.x, site.y, site.z}, q});
    // Along the back wall, so that the way in stays free.
    const char* kinds[] = {"drum", "pallet", "crate"};
    for (int i = 0; i < 3; ++i) {
      const uint64_t variant = static_cast<uint64_t>(dice.integer(0, 3));
      const Result<int> made = place->make({kinds[i], variant});
      GLOAM_CHECK(made.ok(), made.error().message.c_str());
      const double x = -site.half_x + 0.9, y = (i - 1) * (site.half_y - 0.9);
      const double c = std::cos(site.heading), s = std::sin(site.heading);
      place->put(*made, "", {{site.x + c * x - s * y, site.y + s * x + c * y, site.z}, q});
    }
  }
}

}  // namespace gloam
