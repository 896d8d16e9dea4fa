// A furnished home: plan, shell, garden, furniture.

#include "base/log.h"
#include "places/furnish/interior.h"
#include "places/generators.h"

namespace gloam {

Result<Place> make_house(const HouseOptions& options) {
  // Each storey has a hall and a room at least: refusing would make of [[randomize]] a matter of
  // luck.
  if (options.storeys == 2 && options.rooms < 4)
    log_warning("a house with two storeys has at least 4 rooms, not {}", options.rooms);
  Place place("house");
  place.openable = options.openable;
  Dice dice(options.seed, "house");
  place.style = draw_style(&dice);
  const FloorPlan plan = plan_house(options);
  Workshop shop({"house", options.seed}, place.style, &place.materials);
  ShellOptions shell;
  for (const PlanRoom& room : plan.rooms) shell.rooms.push_back(finish_of(room, &shop));
  shell.facade = dice.chance(0.5)
                     ? shop.brick()
                     : shop.plaster(dice.pick<Vec3>(
                           {{0.86, 0.84, 0.78}, {0.80, 0.74, 0.64}, {0.72, 0.74, 0.74}}));
  shell.doors = options.doors;
  shell.ceilings = shell.roof = options.roof;
  build_interior(plan, shell, interior_of(options), &dice, &shop, &place);
  return place;
}

}  // namespace gloam
