// Recipes: what stands in which kind of room, most important first.

#include <algorithm>
#include <cmath>

#include "places/furnish/furnish.h"

namespace gloam {
namespace {

const std::vector<std::string> kSmallThings = {"mug",  "book_stack", "bowl",
                                               "vase", "magazine",   "remote_control"};
const std::vector<std::string> kFloorThings = {
    "toy_ball", "toy_block", "shoes", "backpack", "basket", "cardboard_box", "floor_cushion"};

}  // namespace

void Furnisher::living() {
  radiators();
  const int stand = make("tv_stand");
  const int sofa = make("sofa");
  const Prop::Box s = prop(sofa).bounds();
  // The wall for the screen is one that a sofa can face.
  std::optional<Spot> screen, seat;
  for (int attempt = 0; attempt < 16 && !seat; ++attempt) {
    screen = layout_.find_at_wall(prop(stand), [&](const Spot& spot) {
      return dice_.uniform(0, 4) - 0.3 * layout_.to_middle(spot) -
             (layout_.below_window(spot) ? 1 : 0);
    });
    if (!screen) break;
    for (const double away : {2.9, 2.6, 3.2, 2.3, 2.0, 3.6}) {
      for (const double aside : {0.0, 0.3, -0.3}) {
        const Spot spot = beside(*screen, away + s.high.x, aside, 2);
        if (seat || !layout_.fits(prop(sofa), spot, true)) continue;
        seat = spot;
      }
    }
  }
  if (screen && seat) {
    const int at = layout_.put(stand, *screen);
    layout_.put(sofa, *seat);
    const int screen_prop = make("television");
    layout_.put_at(screen_prop,
                   {screen->x, screen->y, placed(at).X_WP.p.z + prop(stand).surfaces.at(0).z},
                   screen->quarter * M_PI / 2);
    const int table = make("coffee_table");
    const Prop::Box t = prop(table).bounds();
    const Spot middle = beside(*seat, s.high.x + 0.38 + t.high.x, 0);
    const int rug = make("rug");
    if (layout_.fits(prop(rug), middle)) layout_.put(rug, middle);
    if (layout_.fits(prop(table), middle, true)) {
      const int placement = layout_.put(table, middle);
      tidy(placement, kSmallThings, 4);
    }
    const int armchair = make("armchair");
    for (const int side : {1, -1}) {
      const Spot spot = beside(
          middle, 0.1, side * (t.high.y + 0.45 + prop(armchair).bounds().high.x), side > 0 ? 3 : 1);
      if (!layout_.fits(prop(armchair), spot, true)) continue;
      layout_.put(armchair, spot);
      break;
    }
    const int small = make("side_table");
    for (const int side : {1, -1}) {
      const Spot spot =
          beside(*seat, s.low.x + 0.3, side * (s.high.y + 0.06 + prop(small).bounds().high.y));
      if (!layout_.fits(prop(small), spot, true)) continue;
      const int placement = layout_.put(small, spot);
      const int lamp = make("table_lamp");
      layout_.put_at(
          lamp, {spot.x, spot.y, placed(placement).X_WP.p.z + prop(small).surfaces.at(0).z}, 0);
      break;
    }
  } else {
    at_wall(sofa, [&](const Spot& spot) { return -layout_.to_middle(spot); });
  }
  if (layout_.room().clear.area() > 20) {
    const std::optional<int> table = dining_set({0.85, dice_.uniform(1.3, 1.8), 0.745});
    if (table) tidy(*table, {"plate", "bowl", "mug", "bottle", "vase"}, 5);
  }
  // As many large things as the room's walls have space for.
  const double area = layout_.room().clear.area();
  for (int i = 0; i < 1 + static_cast<int>(area / 14); ++i)
    at_wall(make("bookshelf"), [&](const Spot& spot) {
      return layout_.to_opening(spot) - 0.3 * layout_.to_corner(spot);
    });
  if (area > 20) {
    if (const auto chest = at_wall(make("dresser"), [&](const Spot& spot) {
          return -0.3 * layout_.to_middle(spot) + 0.2 * layout_.to_opening(spot);
        }))
      tidy(*chest, {"vase", "book_stack", "speaker", "bowl"}, 3);
  }
  in_corner(make("floor_lamp"));
  for (int i = 0; i < 1 + static_cast<int>(area / 16); ++i) in_corner(make("potted_plant"));
  if (dice_.chance(0.5))
    if (const auto console = at_wall(make("console_table"),
                                     [&](const Spot& spot) { return -layout_.to_middle(spot); }))
      tidy(*console, kSmallThings, 3);
  curtains();
  pictures(2 + static_cast<int>(area / 8));
  if (dice_.chance(0.5))
    layout_.hang(make("wall_clock"), 1.85,
                 [&](const Spot& spot) { return -layout_.to_middle(spot); });
  light("pendant_lamp", 4.5);
  floor_clutter(kFloorThings);
}

void Furnisher::bedroom() {
  radiators();
  const double wide = layout_.room().clear.area() > 12 ? dice_.uniform(1.4, 1.8) : 0.95;
  const int bed = make("bed", Vec3{2.1, wide, 0.95}), night = make("nightstand");
  const Prop::Box b = prop(bed).bounds(), n = prop(night).bounds();
  const double aside = n.high.y - n.low.y + 0.04;
  Prop all;  // with its nightstands
  all.body().collide_box({b.low.x, b.low.y - float(aside), 0},
                         {b.high.x, b.high.y + float(aside), b.high.z});
  const auto preference = [&](const Spot& spot) {
    return 0.4 * layout_.to_opening(spot) - 0.3 * layout_.to_middle(spot) -
           (layout_.below_window(spot) ? 0.6 : 0);
  };
  if (const std::optional<Spot> spot = layout_.find_at_wall(all, preference)) {
    layout_.put(bed, *spot);
    for (const int side : {1, -1}) {
      const Spot stand = beside(*spot, b.low.x - n.low.x, side * (b.high.y + aside / 2 + 0.02));
      const int placement = layout_.put(night, stand);
      const double z = placed(placement).X_WP.p.z + prop(night).surfaces.at(0).z;
      layout_.put_at(make("table_lamp", {}, 3), {stand.x, stand.y, z}, 0);
    }
    const int rug = make("rug", Vec3{1.2, 1.8, 0.008});
    for (const int side : {1, -1}) {
      const Spot mat = beside(*spot, 0.2, side * (b.high.y + aside + 0.55), 1);
      if (!layout_.fits(prop(rug), mat)) continue;
      layout_.put(rug, mat);
      break;
    }
  } else {
    in_corner(bed);
  }
  const auto for_wardrobe = [&](const Spot& spot) {
    return -layout_.to_corner(spot) - layout_.facing_door(spot) * 0.2;
  };
  if (!at_wall(make("wardrobe"), for_wardrobe))
    at_wall(make("wardrobe", Vec3{0.6, 0.9, 2.0}), for_wardrobe);
  if (dice_.chance(0.6)) {
    if (const auto dresser = at_wall(
            make("dresser"), [&](const Spot& spot) { return -0.3 * layout_.to_middle(spot); }))
      tidy(*dresser, {"book_stack", "vase", "bowl", "basket"}, 3);
  }
  if (dice_.chance(0.5)) in_corner(make("armchair"));
  in_corner(make("potted_plant"));
  curtains();
  pictures(2);
  if (dice_.chance(0.5))
    layout_.hang(make("wall_mirror"), 1.45,
                 [&](const Spot& spot) { return -layout_.to_opening(spot); });
  light("ceiling_lamp", 5);
  floor_clutter(
      {"shoes", "backpack", "laundry_basket", "book_stack", "toy_block", "floor_cushion"});
}

void Furnisher::bathroom() {
  const Rect& r = layout_.room().clear;
  const int tub = make("bathtub"), shower = make("shower");
  const auto corner = [&](const Spot& spot) {
    return -layout_.to_corner(spot) + 0.3 * layout_.to_opening(spot);
  };
  const bool wants_tub = dice_.chance(0.6) && std::max(r.width(), r.depth()) > 2.2;
  if (!wants_tub || !at_wall(tub, corner)) at_wall(shower, corner);
  const std::optional<Spot> basin =
      layout_.find_at_wall(prop(make("washbasin", {}, 1)), [&](const Spot& spot) {
        return -0.5 * layout_.to_middle(spot) - (layout_.below_window(spot) ? 1 : 0);
      });
  at_wall(make("toilet"), [&](const Spot& spot) {
    return -0.4 * layout_.to_corner(spot) - 0.5 * layout_.facing_door(spot);
  });
  if (basin && layout_.fits(prop(make("washbasin", {}, 1)), *basin)) {
    const int placement = layout_.put(make("washbasin", {}, 1), *basin);
    layout_.scatter(placement, {"soap_dispenser"}, 1, 0);
    layout_.hang(make("mirror_cabinet"), 1.6, [&](const Spot& spot) {
      const bool above = RoomLayout::back_of(spot) == RoomLayout::back_of(*basin);
      return above ? -std::hypot(spot.x - basin->x, spot.y - basin->y) : -2000;
    });
  }
  layout_.hang(make("towel_rail"), 1.2, [&](const Spot& spot) { return -layout_.to_middle(spot); });
  if (dice_.chance(0.7))
    at_wall(make("bath_shelf"), [&](const Spot& spot) { return -layout_.to_corner(spot); });
  const int mat = make("bath_mat");
  if (const auto spot =
          layout_.find_free(prop(mat), [&](const Spot& s) { return layout_.to_opening(s) * 0.3; }))
    layout_.put(mat, *spot);
  if (options_.clutter > 0.2) in_corner(make("waste_bin"));
  if (options_.clutter > 0.2) in_corner(make("toilet_brush"));
  light("ceiling_lamp", 4);
}

void Furnisher::study() {
  radiators();
  const int desk = make("desk");
  if (const auto spot = layout_.find_at_wall(prop(desk), [&](const Spot& s) {
        return (layout_.below_window(s) ? 0.5 : 0) - 0.2 * layout_.to_middle(s);
      })) {
    workplace(desk, *spot);
  }
  at_wall(make("bookshelf"),
          [&](const Spot& s) { return layout_.to_opening(s) - 0.3 * layout_.to_corner(s); });
  in_corner(make("potted_plant"));
  if (dice_.chance(0.6)) in_corner(make("armchair"));
  if (const auto stand =
          at_wall(make("side_table"), [&](const Spot& s) { return -layout_.to_corner(s); }))
    layout_.scatter(*stand, {"printer"}, 1, 0);
  curtains();
  pictures(2);
  light("ceiling_lamp", 4.5);
  floor_clutter({"cardboard_box", "backpack", "book_stack", "laptop_bag", "waste_bin"});
}

void Furnisher::utility() {
  for (const char* kind : {"washing_machine", "tumble_dryer"})
    at_wall(make(kind), [&](const Spot& s) { return -layout_.to_corner(s); });
  at_wall(make("shelf_unit"), [&](const Spot& s) { return -layout_.to_corner(s); });
  layout_.hang(make("water_heater"), 1.6,
               [&](const Spot& s) { return -layout_.to_corner(Spot(s)); });
  layout_.hang(make("fuse_box"), 1.6, [&](const Spot& s) { return -layout_.to_opening(s); });
  const int rack = make("drying_rack");
  if (const auto spot =
          layout_.find_free(prop(rack), [&](const Spot& s) { return -layout_.to_corner(s); }))
    layout_.put(rack, *spot);
  light("ceiling_lamp", 4);
  floor_clutter({"laundry_basket", "bucket", "vacuum_cleaner", "cardboard_box"});
}

void Furnisher::hall() {
  const Rect& r = layout_.room().clear;
  if (layout_.room().kind == "hall") layout_.reserve({-0.6, r.y0, 0.6, r.y1});
  const auto at_the_side = [&](const Spot& s) {
    return -0.2 * layout_.to_opening(s) + 0.05 * layout_.to_corner(s);
  };
  if (layout_.room().kind == "hall") {
    if (const auto rack = at_wall(make("shoe_rack"), at_the_side)) tidy(*rack, {"shoes"}, 1.5);
    in_corner(make("coat_rack"));
    const int mat = make("rug", Vec3{0.6, 0.9, 0.008});
    const Spot inside{r.x0 + 0.55, r.y(), 0};
    if (layout_.fits(prop(mat), inside)) layout_.put(mat, inside);
  }
  if (const auto console = at_wall(make("console_table"), at_the_side))
    tidy(*console, {"vase", "bowl", "book_stack"}, 3);
  layout_.hang(make("wall_mirror"), 1.45, [&](const Spot& s) { return -layout_.to_middle(s); });
  pictures(3);
  light("ceiling_lamp", 3.2);
}

}  // namespace gloam
