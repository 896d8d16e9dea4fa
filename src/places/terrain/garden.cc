// View from the windows of a house: lawn, a terrace around the walls, a path, a hedge, trees.

#include "places/terrain/garden.h"

#include <algorithm>
#include <cmath>

#include "places/furnish/shell.h"
#include "places/props/outdoors/trees.h"

namespace gloam {
namespace {

constexpr float kGround = -float(kGroundDrop), kTerrace = 1.6f;  // [m]

void add_lawn(Workshop* shop, Place* place) {
  constexpr float kFar = 60;
  Prop p;
  p.label = "lawn";
  // Grass sends back a tenth of the light, not much greener than it is red.
  p.body().show("lawn", shop->carpet({0.33, 0.36, 0.24}),
                slab({-kFar, -kFar, kGround - 0.2f}, {kFar, kFar, kGround}, 0));
  p.body().collide_box({-kFar, -kFar, kGround - 0.5f}, {kFar, kFar, kGround});
  place->put(place->add(std::move(p)), "", {});
}

void add_terrace(const Rect& house, Workshop* shop, Place* place) {
  const Rect r = house.grown(kTerrace);
  const auto f = [](double x) { return static_cast<float>(x); };
  Prop p;
  p.label = "terrace";
  const std::string stone = shop->concrete({0.62, 0.61, 0.58});
  // Slabs of about 0.8 m with open joints.
  const auto piece = [&](double x0, double y0, double x1, double y1) {
    const int columns = static_cast<int>(std::ceil((x1 - x0) / 0.85)),
              rows = static_cast<int>(std::ceil((y1 - y0) / 0.85));
    const double dx = (x1 - x0) / columns, dy = (y1 - y0) / rows;
    for (int i = 0; i < columns * rows; ++i) {
      const int row = i / columns;
      const double x = x0 + i % columns * dx, y = y0 + row * dy;
      p.body().show("slabs", stone,
                    slab({f(x + 0.004), f(y + 0.004), kGround - 0.03f},
                         {f(x + dx - 0.004), f(y + dy - 0.004), kGround + 0.008f}, 0.003f));
    }
    p.body().collide_box({f(x0), f(y0), kGround - 0.05f}, {f(x1), f(y1), kGround + 0.008f});
  };
  piece(r.x0, r.y0, r.x1, house.y0);
  piece(r.x0, house.y1, r.x1, r.y1);
  piece(r.x0, house.y0, house.x0, house.y1);
  piece(house.x1, house.y0, r.x1, house.y1);
  place->put(place->add(std::move(p)), "", {});
}

// A step before the entrance and slabs from there to the gap in the hedge.
void add_path(const Rect& house, double center, double end, Workshop* shop, Place* place) {
  const float x1 = float(house.x0), y = float(center);
  Prop p;
  p.label = "path";
  p.body().show(
      "step", shop->concrete(),
      slab({x1 - 0.6f, y - 0.7f, kGround - 0.05f}, {x1, y + 0.7f, kGround + 0.08f}, 0.01f));
  p.body().collide_box({x1 - 0.6f, y - 0.7f, kGround - 0.05f}, {x1, y + 0.7f, kGround + 0.08f});
  for (float x = x1 - 1.15f; x > float(end); x -= 0.52f)
    p.body().show(
        "slabs", shop->concrete({0.56, 0.54, 0.50}),
        slab({x, y - 0.5f, kGround - 0.03f}, {x + 0.5f, y + 0.5f, kGround + 0.012f}, 0.006f));
  p.body().collide_box({float(end), y - 0.5f, kGround - 0.03f},
                       {x1 - 0.65f, y + 0.5f, kGround + 0.012f});
  place->put(place->add(std::move(p)), "", {});
}

// Leaves all over a dark core.
void add_hedge(const Rect& lot, Workshop* shop, Dice* dice, Place* place) {
  constexpr float kHigh = 1.7f, kHalf = 0.4f;
  Prop p;
  p.label = "hedge";
  Solid leaves[2];
  const auto side = [&](double ax, double ay, double bx, double by) {
    const Vec3f low{float(std::min(ax, bx)) - kHalf, float(std::min(ay, by)) - kHalf, kGround},
        high{float(std::max(ax, bx)) + kHalf, float(std::max(ay, by)) + kHalf, kGround + kHigh};
    p.body().show("core", shop->carpet({0.13, 0.16, 0.09}),
                  slab(low + Vec3f{0.1f, 0.1f, 0}, high - Vec3f{0.1f, 0.1f, 0.1f}, 0.1f));
    p.body().collide_box(low, high);
    const bool along_x = high.x - low.x > high.y - low.y;
    const float length = along_x ? high.x - low.x : high.y - low.y;
    const float around = 2 * kHigh + 2 * kHalf;  // up one face, over the top, down the other
    const int count = int(length * around * 32);
    for (int i = 0; i < count; ++i) {
      const float s = float(dice->uniform(0, length)), t = float(dice->uniform(0, around));
      const bool on_top = std::abs(t - around / 2) < kHalf;
      const float out = t < around / 2 ? -1.0f : 1.0f;
      const float across = on_top ? t - around / 2 : out * (kHalf - float(dice->uniform(0, 0.12)));
      const float z = on_top ? kHigh - float(dice->uniform(0, 0.12))
                             : kHigh * (1 - (std::abs(t - around / 2) - kHalf) / kHigh);
      const float a = float(dice->uniform(0, 2 * kPi)), up = float(dice->uniform(-0.2, 0.9));
      Vec3f d{0.7f * std::cos(a) + (along_x || on_top ? 0 : out * 0.6f),
              0.7f * std::sin(a) + (along_x && !on_top ? out * 0.6f : 0), up};
      const Vec3f at = along_x ? Vec3f{low.x + s, (low.y + high.y) / 2 + across, kGround + z}
                               : Vec3f{(low.x + high.x) / 2 + across, low.y + s, kGround + z};
      add_leaf(at, d, {-std::sin(a), std::cos(a), 0.2f}, float(dice->uniform(0.10, 0.17)),
               &leaves[i % 2]);
    }
  };
  side(lot.x0, lot.y1, lot.x1, lot.y1);
  side(lot.x0, lot.y0, lot.x1, lot.y0);
  side(lot.x1, lot.y0, lot.x1, lot.y1);
  side(lot.x0, 1.0, lot.x0, lot.y1);
  side(lot.x0, lot.y0, lot.x0, -1.0);
  p.body().show("leaves_1", shop->leaf({0.24, 0.31, 0.14}), leaves[0]);
  p.body().show("leaves_2", shop->leaf({0.17, 0.24, 0.11}), leaves[1]);
  place->put(place->add(std::move(p)), "", {});
}

}  // namespace

void add_garden(const FloorPlan& plan, uint64_t seed, Workshop* shop, Place* place) {
  Dice dice(seed, "garden");
  const Rect house = plan.outline.grown(kFacade), lot = plan.outline.grown(7);
  add_lawn(shop, place);
  add_terrace(house, shop, place);
  for (const Opening& o : plan.openings)
    if (o.kind == OpeningKind::kEntrance) add_path(house, o.center, lot.x0, shop, place);
  add_hedge(lot, shop, &dice, place);
  // Two trees in a ring of places around the lot, each turned its own way.
  const int trees[2] = {place->add(make_tree(6.5, shop, &dice)),
                        place->add(make_tree(9, shop, &dice))};
  constexpr int kTrees = 16;
  for (int i = 0; i < kTrees; ++i) {
    const double a = 2 * M_PI * (i + dice.uniform(0.1, 0.9)) / kTrees, out = dice.uniform(4, 13);
    const Vec3 at{lot.x() + (lot.width() / 2 * M_SQRT2 + out) * std::cos(a),
                  lot.y() + (lot.depth() / 2 * M_SQRT2 + out) * std::sin(a), kGround};
    place->put(trees[dice.integer(0, 1)], "", {at, turn({0, 0, 1}, dice.uniform(0, 2 * M_PI))});
  }
}

}  // namespace gloam
