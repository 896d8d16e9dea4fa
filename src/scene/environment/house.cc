// A furnished home: plan, shell, garden, furniture.

#include "scene/environment/furnish.h"
#include "scene/environment/garden.h"
#include "scene/environment/generators.h"
#include "scene/environment/interior.h"

namespace gloam {

Result<Place> make_house(const HouseOptions& options) {
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
  shell.seed = dice.seed();
  build_shell(plan, shell, &place);
  add_garden(plan, options.seed, &shop, &place);
  if (options.furnished) {
    for (int room = 0; room < static_cast<int>(plan.rooms.size()); ++room)
      Furnisher(plan, room, {options.passage, options.clutter, options.loose}, options.seed, &place)
          .furnish();
  }
  place.sky = draw_sky(&dice, options.roof);
  if (options.roof) place.ev100 = 8;  // else it is the sun that lights the rooms
  return place;
}

}  // namespace gloam
