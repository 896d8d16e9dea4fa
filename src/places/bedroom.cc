// One bedroom, and the piece of hall before its door.

#include "places/furnish/interior.h"
#include "places/generators.h"

namespace gloam {
namespace {

constexpr double kHall = 1.4;  // its width [m]

FloorPlan plan_bedroom(const BedroomOptions& o, Dice* dice) {
  FloorPlan plan;
  plan.ceiling = o.ceiling;
  const double x = o.width / 2, y = kHall / 2;
  plan.rooms.push_back({"hall", "corridor", 0, {-x, -y, x, y}});
  plan.rooms.push_back({"bedroom", "bedroom", 0, {-x, y + plan.wall, x, y + plan.wall + o.depth}});
  plan.outline = {-x, -y, x, y + plan.wall + o.depth};
  plan.outline = plan.outline.grown(plan.wall / 2);
  Opening door{OpeningKind::kDoor, 0, 1, Side::kNorth};
  door.width = std::max(0.86, o.passage + 0.14);
  door.hinge_low = dice->chance(0.5);
  door.center = (door.hinge_low ? -1 : 1) * (x - kDoorToCorner - door.width / 2);
  plan.openings.push_back(door);
  const double head = std::min(2.2, o.ceiling - 0.22);
  plan.openings.push_back({OpeningKind::kWindow, 1, -1, Side::kNorth, dice->uniform(-0.2, 0.2),
                           std::min(1.6, o.width - 1.4), dice->uniform(0.75, 0.95), head});
  if (dice->chance(0.4)) {
    const Side side = door.hinge_low ? Side::kEast : Side::kWest;
    plan.openings.push_back({OpeningKind::kWindow, 1, -1, side, plan.rooms[1].clear.y(),
                             std::min(1.1, o.depth - 1.8), 0.95, head});
  }
  return plan;
}

}  // namespace

Result<Place> make_bedroom(const BedroomOptions& options) {
  Place place("bedroom");
  place.openable = options.openable;
  Dice dice(options.seed, "bedroom");
  place.style = draw_style(&dice);
  const FloorPlan plan = plan_bedroom(options, &dice);
  Workshop shop({"bedroom", options.seed}, place.style, &place.materials);
  ShellOptions shell;
  for (const PlanRoom& room : plan.rooms) shell.rooms.push_back(finish_of(room, &shop));
  shell.facade = shop.plaster({0.84, 0.82, 0.77});
  shell.doors = options.doors;
  shell.ceilings = shell.roof = options.roof;
  build_interior(plan, shell, interior_of(options), &dice, &shop, &place);
  return place;
}

}  // namespace gloam
