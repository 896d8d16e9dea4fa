// A corridor of a public building: legs at right angles, locked doors, what stands in corridors.

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "places/furnish/interior.h"
#include "places/generators.h"

namespace gloam {
namespace {

constexpr double kDoorPitch = 4.6, kDoorWidth = 0.95;  // [m]
constexpr double kOriginOffset = 1.2;                  // from the western end to the origin

class HallwayPlanner {
 public:
  explicit HallwayPlanner(const HallwayOptions& options)
      : o_(options), dice_(options.seed, "hallway.plan") {}

  FloorPlan plan() {
    plan_.ceiling = o_.ceiling;
    const std::vector<double> lengths = share_out();
    const int legs = static_cast<int>(lengths.size());
    double x = -kOriginOffset, y = 0;  // middle of the next leg's beginning
    for (int i = 0; i < legs; ++i) {
      const bool east = i % 2 == 0;
      const double length = lengths[static_cast<size_t>(i)], w = o_.width / 2;
      const Rect clear =
          east ? Rect{x, y - w, x + length, y + w} : Rect{x - w, y, x + w, y + length};
      plan_.rooms.push_back(
          {i == 0 ? "corridor" : fmt::format("corridor_{}", i + 1), "corridor", 0, clear});
      // The corner is the end of this leg; the next one leaves it at a right angle.
      if (i + 1 < legs) {
        const Side side = east ? Side::kNorth : Side::kEast;
        Opening bare{OpeningKind::kBare, i, i + 1, side};
        bare.center = east ? clear.x1 - w : clear.y1 - w;
        bare.width = o_.width;
        bare.head = o_.ceiling + 0.04;
        plan_.openings.push_back(bare);
        x = east ? clear.x1 - w : clear.x1 + plan_.wall;
        y = east ? clear.y1 + plan_.wall : clear.y1 - w;
      }
    }
    plan_.outline = plan_.rooms[0].clear;
    for (const PlanRoom& room : plan_.rooms) {
      Rect& o = plan_.outline;
      const Rect& r = room.clear;
      o = {std::min(o.x0, r.x0), std::min(o.y0, r.y0), std::max(o.x1, r.x1), std::max(o.y1, r.y1)};
    }
    plan_.outline = plan_.outline.grown(plan_.wall / 2);
    for (int i = 0; i < legs; ++i) add_doors(i);
    return std::move(plan_);
  }

 private:
  // The lengths of the legs. Each has room for a corner and two doors, so that many legs may be
  // longer than asked for.
  std::vector<double> share_out() {
    if (o_.turns == 0) return {o_.length};
    std::vector<double> shares;
    for (int i = 0; i <= o_.turns; ++i) shares.push_back(dice_.uniform(0.85, 1.15));
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0), least = o_.width + 3;
    const double spare = std::max(0.0, o_.length - least * static_cast<double>(shares.size()));
    for (double& share : shares) share = least + spare * share / sum;
    return shares;
  }

  void add_door(int leg, Side side, double center) {
    for (const Opening& there : plan_.openings_of(leg, side))
      if (std::abs(there.center - center) < (there.width + kDoorWidth) / 2 + 0.5) return;
    plan_.openings.push_back({OpeningKind::kLocked, leg, -1, side, center, kDoorWidth, 0,
                              std::min(2.1, o_.ceiling - 0.15), dice_.chance(0.5)});
  }

  void add_doors(int leg) {
    const Rect r = plan_.rooms[static_cast<size_t>(leg)].clear;
    const bool east = leg % 2 == 0;
    const double from = east ? r.x0 : r.y0, to = east ? r.x1 : r.y1;
    const Side sides[] = {east ? Side::kSouth : Side::kWest, east ? Side::kNorth : Side::kEast};
    for (const Side side : sides)
      for (double at = from + dice_.uniform(1.2, 2.6); at < to - 1.1;
           at += kDoorPitch * dice_.uniform(0.75, 1.25))
        add_door(leg, side, at);
    // Both ends of the whole.
    if (leg == 0) add_door(leg, Side::kWest, 0);
    if (leg + 1 == static_cast<int>(plan_.rooms.size()))
      add_door(leg, east ? Side::kEast : Side::kNorth, east ? r.y() : r.x());
  }

  const HallwayOptions& o_;
  Dice dice_;
  FloorPlan plan_;
};

}  // namespace

Result<Place> make_hallway(const HallwayOptions& options) {
  Place place("hallway");
  Dice dice(options.seed, "hallway");
  Style& style = place.style;
  style.wood = dice.pick<const char*>({"oak", "birch"});
  style.metal = "steel";
  style.wall = dice.pick<Vec3>({{0.88, 0.88, 0.86}, {0.84, 0.86, 0.84}, {0.88, 0.85, 0.79}});
  style.trim = dice.pick<Vec3>({{0.36, 0.40, 0.42}, {0.62, 0.63, 0.62}, {0.28, 0.36, 0.34}});
  style.door = dice.seed();
  const FloorPlan plan = HallwayPlanner(options).plan();
  Workshop shop({"hallway", options.seed}, style, &place.materials);
  RoomFinish finish;
  finish.floor =
      dice.chance(0.5)
          ? shop.tiles({0.56, 0.55, 0.52}, 0.45f)
          : shop.plaster(dice.pick<Vec3>({{0.42, 0.46, 0.46}, {0.50, 0.46, 0.40}}));  // linoleum
  finish.wall = shop.plaster(style.wall);
  finish.ceiling = shop.ceiling_tiles();
  ShellOptions shell;
  shell.rooms.assign(plan.rooms.size(), finish);
  shell.ceilings = options.roof;
  shell.roof = false;
  InteriorOptions interior = interior_of(options);
  interior.garden = false;
  interior.ev100 = 7;
  build_interior(plan, shell, interior, &dice, &shop, &place);
  return place;
}

}  // namespace gloam
