#include "places/furnish/interior.h"

#include "places/terrain/garden.h"

namespace gloam {

Style draw_style(Dice* dice) {
  Style s;
  s.wood = dice->pick<const char*>({"oak", "walnut", "birch", "pine", "oak"});
  s.metal = dice->pick<const char*>({"steel", "brass", "black"});
  s.fabric = dice->pick<Vec3>({{0.56, 0.54, 0.50},
                               {0.33, 0.37, 0.42},
                               {0.62, 0.55, 0.45},
                               {0.36, 0.40, 0.34},
                               {0.50, 0.38, 0.34}});
  s.accent = dice->pick<Vec3>({{0.20, 0.36, 0.38},
                               {0.70, 0.48, 0.20},
                               {0.56, 0.28, 0.20},
                               {0.25, 0.32, 0.48},
                               {0.40, 0.45, 0.30}});
  s.wall = dice->pick<Vec3>({{0.92, 0.90, 0.86}, {0.90, 0.90, 0.89}, {0.93, 0.90, 0.83}});
  s.trim = dice->pick<Vec3>({{0.88, 0.87, 0.84}, {0.90, 0.90, 0.89}});
  s.cabinet = dice->pick<Vec3>({{0.88, 0.88, 0.86},    // white
                                {0.13, 0.135, 0.14},   // black
                                {0.53, 0.58, 0.50},    // sage
                                {0.22, 0.27, 0.35},    // navy
                                {0.80, 0.76, 0.68}});  // cream
  s.door = dice->seed();
  // Fronts of kitchens in a lacquer or of wood; the worktop is what they are not.
  s.wooden_fronts = dice->chance(0.25);
  s.worktop = s.wooden_fronts ? dice->pick<const char*>({"marble", "concrete"})
                              : dice->pick<const char*>({"wood", "wood", "marble", "concrete"});
  s.tiles = dice->pick<Vec3>(
      {{0.88, 0.88, 0.86}, {0.62, 0.67, 0.62}, {0.55, 0.62, 0.66}, {0.80, 0.74, 0.66}});
  return s;
}

RoomFinish finish_of(const PlanRoom& room, Workshop* shop) {
  const Vec3 white{0.93, 0.93, 0.92};
  RoomFinish f;
  f.ceiling = shop->plaster(white);
  const bool is_wet = room.kind == "bathroom" || room.kind == "utility" || room.kind == "kitchen";
  if (is_wet) {
    const Vec3 floor = shop->dice.pick<Vec3>(
        {{0.62, 0.60, 0.56}, {0.46, 0.46, 0.47}, {0.74, 0.70, 0.64}, {0.32, 0.33, 0.35}});
    f.floor = shop->tiles(floor, shop->dice.chance(0.5) ? 0.3f : 0.45f);
  } else {
    const Axis along = room.clear.width() >= room.clear.depth() ? Axis::kX : Axis::kY;
    f.floor =
        shop->boards(shop->style.wood == "pine" ? "oak" : shop->style.wood, along, 1.4f, 0.14f);
  }
  if (room.kind == "bathroom") {
    f.wall = shop->tiles(
        shop->dice.pick<Vec3>({{0.88, 0.88, 0.86}, {0.82, 0.86, 0.86}, {0.82, 0.80, 0.74}}), 0.2f);
    f.skirting = false;
  } else if (room.kind == "living" || room.kind == "bedroom" || room.kind == "study") {
    const bool tinted = shop->dice.chance(0.45);
    const Vec3 tint = shop->dice.pick<Vec3>(
        {{0.74, 0.78, 0.75}, {0.80, 0.76, 0.68}, {0.72, 0.76, 0.82}, {0.84, 0.77, 0.72}});
    f.wall = shop->plaster(tinted ? tint : shop->style.wall);
  } else {
    f.wall = shop->plaster(shop->style.wall);
  }
  return f;
}

SkyOptions draw_sky(Dice* dice, bool roof) {
  SkyOptions sky;
  sky.sun_elevation = roof ? dice->uniform(22, 50) : 65;
  sky.sun_azimuth = dice->uniform(0, 360);
  return sky;
}

void build_interior(const FloorPlan& plan, ShellOptions shell, const InteriorOptions& options,
                    Dice* dice, Workshop* shop, Place* place) {
  shell.seed = dice->seed();
  build_shell(plan, shell, place);
  if (options.garden) add_garden(plan, options.seed, shop, place);
  if (options.furnished)
    for (int room = 0; room < static_cast<int>(plan.rooms.size()); ++room)
      Furnisher(plan, room, options.furnish, options.seed, place).furnish();
  place->sky = draw_sky(dice, options.roof);
  if (options.roof) place->ev100 = options.ev100;
}

}  // namespace gloam
