// A drift of a mine: rock and muck, lamps, and goods along one wall and in niches.

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "places/generators.h"
#include "places/mine/fittings.h"
#include "places/mine/rock.h"

namespace gloam {
namespace {

constexpr double kBeyond = 3;  // of the path beyond both faces [m]

std::vector<Niche> draw_niches(const MineOptions& o, Dice* dice) {
  std::vector<Niche> niches;
  if (o.niches <= 0) return niches;
  const double apart = std::max(o.niches, 12.0);
  double side = dice->chance(0.5) ? 1 : -1;
  for (double s = apart * dice->uniform(0.3, 0.6); s < o.length - 4;
       s += apart * dice->uniform(0.8, 1.2)) {
    const Niche niche{s, side, dice->uniform(3, 5), dice->uniform(1.4, 2.6)};
    side = -side;
    if (s > 4) niches.push_back(niche);
  }
  return niches;
}

class MineBuilder {
 public:
  explicit MineBuilder(const MineOptions& options)
      : o_(options),
        dice_(options.seed, "mine"),
        place_("mine"),
        path_({o_.length, o_.curve, kBeyond}, &dice_),
        rock_(o_, path_, draw_niches(o_, &dice_)),
        duct_side_(dice_.chance(0.5) ? 1 : -1) {}

  Place build() {
    Workshop shop({"mine", o_.seed}, place_.style, &place_.materials);
    add_rock(&shop);
    add_floor(&shop);
    add_fittings(o_, rock_, duct_side_, &shop, &dice_, &place_);
    add_lamps(&shop);
    add_clutter();
    add_niche_goods();
    place_.regions = path_.regions("drift", o_.width, o_.height);
    place_.ev100 = 4;
    return std::move(place_);
  }

 private:
  void put(const std::string& label, Prop prop) {
    prop.label = label;
    place_.put(place_.add(std::move(prop)), "", {});
  }

  void add_rock(Workshop* shop) {
    Prop p;
    const std::string rock = shop->blasted_rock();
    p.body().show("rock", rock, rock_.walls(0, o_.length));
    for (const bool west : {true, false}) p.body().show("rock", rock, rock_.face(west));
    rock_.add_colliders(&p.body());
    put("wall", std::move(p));
  }

  void add_floor(Workshop* shop) {
    Prop floor;
    PropPart& b = floor.body();
    const float wide = float(rock_.half() + 3.2);
    b.show("muck", shop->soil({0.150, 0.138, 0.122}, {0.052, 0.047, 0.041}),
           path_.strip(-kBeyond, o_.length + kBeyond, {wide, 0}, {-wide, 0}));
    const std::string track = shop->soil({0.088, 0.080, 0.070}, {0.046, 0.042, 0.037});
    const double gauge = std::min(0.85, rock_.half() * 0.5);
    for (const double side : {-1.0, 1.0})
      b.show("tracks", track,
             path_.strip(0, o_.length, {float(side * gauge + 0.2), 0.002f},
                         {float(side * gauge - 0.2), 0.002f}));
    path_.collide_ground(&b, 10);
    put("floor", std::move(floor));

    Prop water;
    const std::string wet = shop->water();
    for (double s = dice_.uniform(2, 8); s < o_.length - 2; s += dice_.uniform(5, 14)) {
      const double left = dice_.uniform(-0.7, 0.7) * rock_.half();
      water.body().show("puddles", wet, puddle(s, left, dice_.uniform(0.3, 0.9)));
    }
    if (!water.body().visuals.empty()) put("puddle", std::move(water));
  }

  // A thin sheet with a ragged edge.
  Solid puddle(double s, double left, double radius) {
    const SmoothNoise edge(dice_.seed());
    std::vector<Vec3f> points;
    for (int ring = 0; ring < 2; ++ring)
      for (int i = 0; i <= 60; ++i) {
        const double angle = 2 * M_PI * (i % 60) / 60;
        const double r =
            ring * radius * (1 + 0.35 * edge(2 * std::cos(angle), 2 * std::sin(angle)));
        points.push_back(CurvedPath::point(path_.at(s + 1.6 * r * std::cos(angle)),
                                           left + r * std::sin(angle), 0.004));
      }
    return sheet(points, 61);
  }

  int make(const std::string& kind, std::optional<Vec3> size = {}, int variants = 6) {
    const Result<int> made =
        place_.make({kind, static_cast<uint64_t>(dice_.integer(0, variants - 1)), size});
    GLOAM_CHECK(made.ok(), made.error().message.c_str());
    return *made;
  }

  void add_lamps(Workshop* shop) {
    const int lit = make("strip_lamp", Vec3{0.09, 1.27, 0.09}, 1);
    Prop out = place_.prop(lit);
    out.lights.clear();
    for (PropVisual& visual : out.body().visuals)
      if (visual.name == "cover") visual.material = shop->plastic({0.36, 0.36, 0.35}, 0.5);
    out.label = "lamp";
    const int dark = place_.add(std::move(out));
    const double left = -duct_side_ * rock_.half() * 0.3, z = rock_.crown(left) - o_.relief - 0.1;
    Prop chains;
    const std::string steel = shop->metal("galvanised");
    for (double s = std::min(o_.lamps / 2, 3.0); s < o_.length - 1; s += o_.lamps) {
      place_.put(dice_.chance(o_.failed) ? dark : lit, "", path_.pose(s, left, z, M_PI / 2));
      for (const double ds : {-0.5, 0.5}) {
        const CurvedPath::Station k = path_.at(s + ds);
        chains.body().show(
            "chains", steel,
            bar(CurvedPath::point(k, left, z),
                CurvedPath::point(k, left, rock_.crown(left) + o_.relief), 0.004f, 0.004f, 5));
      }
    }
    put("chain", std::move(chains));
  }

  // Along one wall, so that the rest of the floor stays free.
  void add_clutter() {
    const double side = dice_.chance(0.5) ? 1 : -1;
    const int count = static_cast<int>(o_.clutter * o_.length / 2.5);
    double s = 2;
    for (int i = 0; i < count; ++i) {
      s += dice_.uniform(0.7, 1.3) * o_.length / (count + 1);
      if (s > o_.length - 2.5) break;
      if (std::abs(s - o_.length / 4) < 2.5 || rock_.is_niche(s, side, 1)) continue;
      const auto kind = dice_.pick<const char*>(
          {"rock", "rock", "rock", "rock", "drum", "pallet", "cable_reel", "traffic_cone"});
      const double scale = dice_.uniform(0.6, 1.6);
      const bool is_rock = std::string(kind) == "rock";
      const int thing =
          is_rock ? make(kind, Vec3{0.34 * scale, 0.28 * scale, 0.24 * scale}) : make(kind);
      const Prop::Box box = place_.prop(thing).bounds();
      const double reach =
          std::hypot(std::max(-box.low.x, box.high.x), std::max(-box.low.y, box.high.y));
      const double clear =
          rock_.clear(s - reach - 1, s + reach + 1, side) - (o_.supports > 0 ? 0.25 : 0.05);
      if (clear - 2 * reach < 0.6 - rock_.half()) continue;  // no way past it
      const bool loose = place_.prop(thing).loose && dice_.chance(o_.loose);
      place_.put(thing, "", path_.pose(s, side * (clear - reach), 0, dice_.uniform(-3, 3)), loose);
    }
  }

  void add_niche_goods() {
    for (const Niche& niche : rock_.niches()) {
      if (!dice_.chance(0.4 + 0.5 * o_.clutter)) continue;
      const int thing = make(dice_.pick<const char*>({"pallet", "drum", "cable_reel", "boulder"}));
      const Prop::Box box = place_.prop(thing).bounds();
      const double reach =
          std::hypot(std::max(-box.low.x, box.high.x), std::max(-box.low.y, box.high.y));
      const double clear = rock_.clear(niche.s - reach - 1, niche.s + reach + 1, niche.side);
      if (clear - 2 * reach < 0.6 - rock_.half()) continue;
      place_.put(
          thing, "",
          path_.pose(niche.s, niche.side * (clear - reach - 0.05), 0, dice_.uniform(-0.4, 0.4)));
    }
  }

  const MineOptions& o_;
  Dice dice_;
  Place place_;
  CurvedPath path_;
  MineRock rock_;
  double duct_side_;  // of the ventilation duct: +1 left, -1 right; pipes run along the other wall
};

}  // namespace

Result<Place> make_mine(const MineOptions& options) { return MineBuilder(options).build(); }

}  // namespace gloam
