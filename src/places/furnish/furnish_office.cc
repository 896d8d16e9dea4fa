// Recipes for offices and public corridors, most important first.

#include <algorithm>
#include <cmath>

#include "places/furnish/furnish.h"

namespace gloam {
namespace {

constexpr double kDesk = 1.6, kDeskDepth = 0.8;  // size of a workplace [m]
constexpr double kScreen = 0.03;                 // thickness of what stands between two desks
constexpr double kSeat = 0.95;                   // behind a desk
constexpr double kDeskGap = 0.025;               // between desks in a row

}  // namespace

void Furnisher::corridor() {
  const Rect& r = layout_.room().clear;
  layout_.reserve({-0.6, r.y0, 0.6, r.y1});
  const auto anywhere = [&](const Spot&) { return dice_.uniform(0, 2); };
  const auto near_door = [&](const Spot& s) { return -0.2 * layout_.to_opening(s); };
  if (r.width() > 6 || r.depth() > 6) {
    layout_.hang(make("wall_extinguisher"), 1.0, near_door);
    layout_.hang(make("exit_sign"), std::min(2.35, plan_.ceiling - 0.15), near_door);
    layout_.hang(make("first_aid_box"), 1.5, anywhere);
    const int things = static_cast<int>(options_.clutter * std::max(r.width(), r.depth()) / 5);
    for (int i = 0; i < things; ++i)
      at_wall(make(dice_.pick<const char*>({"potted_plant", "bench", "locker", "water_cooler",
                                            "console_table", "waste_bin", "carton"})),
              anywhere);
    panels(2.6);
  } else {
    light("ceiling_lamp", 3.2);
  }
  pictures(static_cast<int>(std::max(r.width(), r.depth()) / 4));
}

// Islands of desks in rows, two and two face to face, long sides across the window front.
void Furnisher::open_office() {
  radiators();
  const Rect& r = layout_.room().clear;
  const double way = std::max(options_.passage + 0.25, 1.0);
  const double island = 2 * (kDeskDepth + kSeat) + 0.08;
  const int islands = std::max(1, static_cast<int>((r.width() - 0.6) / (island + way * 0.5)));
  const int rows = std::clamp(static_cast<int>((r.depth() - way - 0.9) / (kDesk + kDeskGap)), 1, 4);
  const double length = rows * (kDesk + kDeskGap) - kDeskGap;
  const double y0 = r.y1 - 0.7 - length;  // the way is on the corridor's side
  for (int i = 0; i < islands; ++i) {
    const double x = r.x0 + r.width() * (i + 0.5) / islands;
    const int screen = make("desk_screen", Vec3{kScreen, length, 1.25});
    const Spot middle{x, y0 + length / 2, 0};
    if (!layout_.fits(prop(screen), middle)) continue;
    layout_.put(screen, middle);
    for (int row = 0; row < rows; ++row) {
      for (const int side : {0, 2}) {
        const int desk = make("desk", Vec3{kDeskDepth, kDesk, 0.74});
        const Prop::Box d = prop(desk).bounds();
        const double out = kScreen / 2 + 0.025 - d.low.x;
        const Spot spot{x + (side == 0 ? out : -out), y0 + kDesk / 2 + row * (kDesk + kDeskGap),
                        side};
        if (layout_.fits(prop(desk), spot, true)) workplace(desk, spot);
      }
    }
  }
  at_wall(make("bookshelf"), [&](const Spot& s) { return -0.3 * layout_.to_corner(s); });
  for (int i = 0; i < 3; ++i)
    at_wall(make("filing_cabinet"), [&](const Spot& s) { return -layout_.to_corner(s); });
  in_corner(make("potted_plant"));
  in_corner(make("potted_plant"));
  in_corner(make("waste_bin"));
  layout_.hang(make("whiteboard"), 1.45, [&](const Spot& s) { return -layout_.to_middle(s); });
  layout_.hang(make("wall_clock"), 2.0, [&](const Spot& s) { return -layout_.to_middle(s); });
  pictures(1);
  panels(2.4);
  floor_clutter({"backpack", "cardboard_box", "laptop_bag", "waste_bin"});
}

void Furnisher::office() {
  radiators();
  const int desk = make("desk", Vec3{kDeskDepth, kDesk, 0.74});
  if (const auto spot = layout_.find_at_wall(prop(desk), [&](const Spot& s) {
        return 0.3 * layout_.to_opening(s) + (layout_.below_window(s) ? 0.3 : 0);
      }))
    workplace(desk, *spot);
  at_wall(make("bookshelf"), [&](const Spot& s) { return -0.3 * layout_.to_corner(s); });
  at_wall(make("filing_cabinet"), [&](const Spot& s) { return -layout_.to_corner(s); });
  at_wall(make("chair"), [&](const Spot& s) { return -0.3 * layout_.to_opening(s); });
  in_corner(make("potted_plant"));
  layout_.hang(make("whiteboard"), 1.45, [&](const Spot& s) { return -layout_.to_middle(s); });
  layout_.hang(make("coat_rack"), 1.65, [&](const Spot& s) { return -layout_.to_opening(s); });
  pictures(1);
  panels(2.4);
  floor_clutter({"backpack", "cardboard_box", "book_stack", "laptop_bag", "waste_bin"});
}

void Furnisher::meeting() {
  radiators();
  const Rect& r = layout_.room().clear;
  const double length = std::clamp(std::max(r.width(), r.depth()) - 2.2, 1.4, 3.2);
  const auto in_the_middle = [&](const Spot& s) {
    const bool along = (s.quarter % 2 == 0) == (r.depth() > r.width());
    return -std::hypot(s.x - r.x(), s.y - r.y()) - (along ? 0 : 3);
  };
  if (const auto table = dining_set({1.1, length, 0.74}, "meeting_table", "chair", in_the_middle))
    tidy(*table, {"mug", "laptop", "bottle", "book_stack"}, 4);
  layout_.hang(make("whiteboard"), 1.45, [&](const Spot& s) { return -layout_.to_middle(s); });
  if (const auto stand = at_wall(make("tv_stand"), [&](const Spot& s) {
        return -layout_.to_middle(s) - (layout_.below_window(s) ? 2 : 0);
      })) {
    const Placement& at = placed(*stand);
    const double yaw = 2 * std::atan2(at.X_WP.q.z, at.X_WP.q.w);
    const Vec3 top{at.X_WP.p.x, at.X_WP.p.y, at.X_WP.p.z + prop(at.prop).surfaces.at(0).z};
    layout_.put_at(make("television"), top, yaw);
  }
  in_corner(make("potted_plant"));
  pictures(1);
  panels(2.4);
}

void Furnisher::copy() {
  const auto corner = [&](const Spot& s) { return -layout_.to_corner(s); };
  at_wall(make("copier"), corner);
  for (int i = 0; i < 2; ++i) at_wall(make("filing_cabinet"), corner);
  at_wall(make("shelf_unit"), corner);
  at_wall(make("locker"), corner);
  in_corner(make("wheelie_bin"));
  layout_.hang(make("wall_clock"), 2.0, [&](const Spot& s) { return -layout_.to_middle(s); });
  panels(2.4);
  floor_clutter({"carton", "cardboard_box", "waste_bin"});
}

}  // namespace gloam
