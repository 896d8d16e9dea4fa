// Steel arches, rock bolts, a ventilation duct, pipes and cables of a mine.

#include "places/mine/fittings.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

class Fittings {
 public:
  Fittings(const MineOptions& options, const MineRock& rock, double duct_side, Dice* dice,
           Place* place)
      : o_(options), rock_(rock), duct_side_(duct_side), dice_(dice), place_(place) {}

  // Rolled arches in front of the rock, on feet.
  void add_supports(Workshop* shop) {
    if (o_.supports <= 0) return;
    Prop p;
    PropPart& b = p.body();
    const std::string steel = shop->metal("rust");
    const double apart = std::max(o_.supports, 1.0), inset = 0.5 * o_.relief + 0.06;
    for (double s = apart / 2; s < o_.length - 1; s += apart) {
      if (rock_.is_niche(s, 1) || rock_.is_niche(s, -1)) continue;
      // A profile of 12 x 12 cm: flanges across, and a web between them.
      show_ring(&b, steel, s, {inset, inset + 0.012}, 0.06);
      show_ring(&b, steel, s, {inset - 0.108, inset - 0.12}, 0.06);
      show_ring(&b, steel, s, {inset - 0.12, inset}, 0.005);
      const CurvedPath::Station k = rock_.path().at(s);
      for (const float side : {-1.0f, 1.0f})
        b.collide_box(CurvedPath::point(k, side * (rock_.half() - inset + 0.06), rock_.wall() / 2),
                      {0.06f, 0.06f, float(rock_.wall() / 2)}, turn({0, 0, 1}, k.heading));
    }
    if (!b.visuals.empty()) put("support", std::move(p));
  }

  // A closed ring of rectangular section, between two depths before the mean rock, `half` to
  // either side along the path.
  void show_ring(PropPart* part, const std::string& material, double s,
                 std::pair<double, double> depth, double half) {
    const auto at = [&](double ds, double inset, int i) {
      const Vec2f q = rock_.mean(i / 40.0);
      const double shrink = 1 - inset / rock_.half(), low = 1 - inset / o_.height;
      return CurvedPath::point(rock_.path().at(s + ds), q.x * shrink, q.y * low);
    };
    const std::pair<double, double> corners[] = {{-half, depth.second},
                                                 {half, depth.second},
                                                 {half, depth.first},
                                                 {-half, depth.first},
                                                 {-half, depth.second}};
    for (int edge = 0; edge < 4; ++edge) {
      std::vector<Vec3f> points;
      for (const int end : {edge, edge + 1})
        for (int i = 40; i >= 0; --i)
          points.push_back(at(corners[end].first, corners[end].second, i));
      part->show("arches", material, sheet(points, 41));
    }
  }

  // Bolts with plates, in rows around the crown.
  void add_bolts(Workshop* shop) {
    Prop p;
    const std::string plate = shop->metal("galvanised"), rust = shop->metal("rust");
    for (double s = 0.8; s < o_.length - 0.5; s += 1.5)
      for (double u = 0.18; u < 0.83; u += 0.107) {
        const double at = s + dice_->uniform(-0.2, 0.2), turned = u + dice_->uniform(-0.015, 0.015);
        if (rock_.is_niche(at, turned < 0.5 ? 1 : -1, 0.4) && std::abs(turned - 0.5) > 0.15)
          continue;
        const Vec2f q = rock_.surface(at, turned), before = rock_.surface(at, turned - 0.01),
                    after = rock_.surface(at, turned + 0.01);
        const Vec2f chord = after - before;
        const Vec2f along = chord * (1 / std::hypot(chord.x, chord.y));
        const Vec2f inward{-along.y, along.x};
        const CurvedPath::Station k = rock_.path().at(at);
        const auto point = [&](float depth) {
          return CurvedPath::point(k, q.x + inward.x * depth, q.y + inward.y * depth);
        };
        const std::string& metal = dice_->chance(0.3) ? rust : plate;
        p.body().show(metal == rust ? "rusty_plates" : "plates", metal,
                      bar(point(-0.03f), point(0.012f), 0.09f, 0.075f, 4));
        p.body().show("bolts", plate, bar(point(0), point(0.06f), 0.014f, 0.012f, 6));
      }
    put("rock_bolt", std::move(p));
  }

  void add_services(Workshop* shop) {
    Prop p;
    PropPart& b = p.body();
    const double inset = o_.relief + 0.08, end = o_.length - 1;
    // The duct hangs beside the crown; lamps hang on the other side.
    const double radius = o_.height >= 3.4 ? 0.35 : 0.22;
    const double left = duct_side_ * rock_.half() * 0.36;
    const double z = rock_.crown(left) - o_.relief - radius - 0.1;
    b.show("duct", shop->fabric({0.62, 0.42, 0.09}, 0.004),
           rock_.path().cable(2, end, {left, z}, radius, 20));
    const std::string strap = shop->rubber(), steel = shop->metal("galvanised");
    for (double s = 2.5; s < end; s += 2.5) {
      const CurvedPath::Station k = rock_.path().at(s);
      b.show("straps", strap,
             rock_.path().cable(s - 0.02, s + 0.02, {left, z}, radius + 0.006, 20));
      b.show("hangers", steel,
             bar(CurvedPath::point(k, left, z + radius),
                 CurvedPath::point(k, left, rock_.crown(left) + o_.relief), 0.006f, 0.006f, 5));
    }
    const double wall = -duct_side_ * (rock_.half() - inset);
    const std::pair<double, std::string> pipes[] = {{1.55, shop->paint({0.10, 0.23, 0.45}, 0.5)},
                                                    {1.80, shop->metal("galvanised")}};
    for (const auto& [height, look] : pipes) {
      const double at = std::min(height, rock_.wall() + 0.3 * (height - 1.2));
      b.show(height < 1.7 ? "water_pipe" : "air_pipe", look,
             rock_.path().cable(0.5, end, {wall, at}, height < 1.7 ? 0.055 : 0.08, 12));
      for (double s = 2; s < end; s += 3)
        if (!rock_.is_niche(s, -duct_side_)) {
          const CurvedPath::Station k = rock_.path().at(s);
          b.show("brackets", steel,
                 bar(CurvedPath::point(k, wall, at - 0.07),
                     CurvedPath::point(k, wall * 1.3, at - 0.02), 0.012f, 0.012f, 5));
        }
    }
    for (int i = 0; i < 3; ++i)
      b.show("cables", shop->rubber({0.05, 0.05, 0.055}),
             sagging(duct_side_ * (rock_.half() - inset), 1.75 + 0.07 * i, 0.05 + 0.03 * i));
    put("pipe", std::move(p));
  }

  // A cable along a wall that hangs from a hook every two metres.
  Solid sagging(double left, double z, double sag) const {
    Path path;
    const double height = std::min(z, rock_.wall() + 0.3);
    for (double s = 0.6; s < o_.length - 0.6; s += 0.25) {
      const double t = std::fmod(s, 2.0) - 1;
      path.push_back(CurvedPath::point(rock_.path().at(s), left, height - sag * (1 - t * t)));
    }
    return tube(path, 0.014f, 8);
  }

 private:
  void put(const std::string& label, Prop prop) {
    prop.label = label;
    place_->put(place_->add(std::move(prop)), "", {});
  }

  const MineOptions& o_;
  const MineRock& rock_;
  double duct_side_;
  Dice* dice_;
  Place* place_;
};

}  // namespace

void add_fittings(const MineOptions& options, const MineRock& rock, double duct_side,
                  Workshop* shop, Dice* dice, Place* place) {
  Fittings fittings(options, rock, duct_side, dice, place);
  fittings.add_supports(shop);
  fittings.add_bolts(shop);
  fittings.add_services(shop);
}

}  // namespace gloam
