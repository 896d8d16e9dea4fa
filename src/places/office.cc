// A floor of an office: a corridor along x, an open office and a meeting room in the north, small
// rooms in the south.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "places/furnish/interior.h"
#include "places/generators.h"

namespace gloam {
namespace {

constexpr double kSmallRoom = 3.1;  // usual width [m]

class OfficePlanner {
 public:
  explicit OfficePlanner(const OfficeOptions& options)
      : o_(options), dice_(options.seed, "office.plan") {}

  FloorPlan plan() {
    plan_.ceiling = o_.ceiling;
    const double x = o_.length / 2, corridor = dice_.uniform(1.7, 2.0), t = plan_.wall;
    const double rest = o_.width - corridor - 2 * t, south = std::min(rest * 0.45, 5.0);
    // The origin is in the corridor's middle.
    const double y = corridor / 2;
    add_room("corridor", {-x, -y, x, y});
    const Rect north_strip{-x, y + t, x, y + t + rest - south};
    const double meeting = o_.length > 14 ? dice_.uniform(3.6, 4.6) : 0;
    const bool meeting_west = dice_.chance(0.5);
    Rect open = north_strip, room = north_strip;
    if (meeting > 0) {
      (meeting_west ? open.x0 : open.x1) += (meeting_west ? 1 : -1) * (meeting + t);
      (meeting_west ? room.x1 : room.x0) = meeting_west ? room.x0 + meeting : room.x1 - meeting;
      lead(add_room("meeting", room), Side::kNorth);
    }
    const int open_office = add_room("open_office", open);
    for (const double share : {0.2, 0.8}) {
      Opening arch{OpeningKind::kArch, 0, open_office, Side::kNorth};
      arch.width = 1.5;
      arch.head = 2.2;
      arch.center = open.x0 + open.width() * share;
      plan_.openings.push_back(arch);
    }
    add_small_rooms({-x, -y - t - south, x, -y - t});
    plan_.outline = {-x, -y - t - south, x, north_strip.y1};
    plan_.outline = plan_.outline.grown(t / 2);
    plan_.openings.push_back({OpeningKind::kEntrance, 0, -1, Side::kWest, 0, 0.96, 0, 2.1});
    plan_.openings.push_back({OpeningKind::kWindow, 0, -1, Side::kEast, 0, 1.0, 0.9, head()});
    for (int i = 1; i < static_cast<int>(plan_.rooms.size()); ++i) add_windows(i);
    return std::move(plan_);
  }

 private:
  double head() const { return std::min(2.35, o_.ceiling - 0.22); }

  int add_room(const std::string& kind, const Rect& clear) {
    const int number = ++count_[kind];
    plan_.rooms.push_back(
        {number == 1 ? kind : fmt::format("{}_{}", kind, number), kind, 0, clear});
    return static_cast<int>(plan_.rooms.size()) - 1;
  }

  // A door from the corridor.
  void lead(int room, Side side) {
    const Rect& to = plan_.rooms[static_cast<size_t>(room)].clear;
    Opening door{OpeningKind::kDoor, 0, room, side};
    door.width = std::max(0.9, o_.passage + 0.14);
    door.hinge_low = dice_.chance(0.5);
    const double edge = kDoorToCorner + door.width / 2;
    door.center = door.hinge_low ? to.x0 + edge : to.x1 - edge;
    plan_.openings.push_back(door);
  }

  void add_small_rooms(const Rect& strip) {
    const int count = std::max(2, static_cast<int>(strip.width() / kSmallRoom));
    std::vector<std::string> kinds = {"kitchen", "office", "copy"};
    for (int i = 3; i < count; ++i) kinds.push_back(i % 5 == 0 ? "meeting" : "office");
    kinds.resize(static_cast<size_t>(count));
    dice_.shuffle(&kinds);
    const double width = (strip.width() - (count - 1) * plan_.wall) / count;
    double x = strip.x0;
    for (const std::string& kind : kinds) {
      lead(add_room(kind, {x, strip.y0, x + width, strip.y1}), Side::kSouth);
      x += width + plan_.wall;
    }
  }

  // A band of windows in each outer wall along x.
  void add_windows(int index) {
    const Rect r = plan_.rooms[static_cast<size_t>(index)].clear;
    const std::string kind = plan_.rooms[static_cast<size_t>(index)].kind;
    const Side side = r.y() > 0 ? Side::kNorth : Side::kSouth;
    const int count = std::max(1, static_cast<int>(r.width() / 2.1));
    for (int i = 0; i < count; ++i) {
      const double pitch = r.width() / count, sill = kind == "kitchen" ? 1.05 : 0.85;
      plan_.openings.push_back({OpeningKind::kWindow, index, -1, side, r.x0 + pitch * (i + 0.5),
                                std::min(1.7, pitch - 0.4), sill, head()});
    }
  }

  const OfficeOptions& o_;
  Dice dice_;
  FloorPlan plan_;
  std::map<std::string, int> count_;
};

RoomFinish office_finish(const PlanRoom& room, Workshop* shop) {
  RoomFinish f;
  f.ceiling = shop->ceiling_tiles();
  f.wall = shop->plaster(shop->style.wall);
  if (room.kind == "kitchen" || room.kind == "copy")
    f.floor = shop->tiles({0.50, 0.50, 0.49}, 0.45f);
  else
    f.floor = shop->carpet(shop->style.fabric);
  return f;
}

Style office_style(Dice* dice) {
  Style s;
  s.wood = dice->pick<const char*>({"oak", "birch", "birch"});
  s.metal = dice->pick<const char*>({"steel", "black"});
  s.fabric = dice->pick<Vec3>({{0.34, 0.36, 0.38}, {0.30, 0.35, 0.42}, {0.40, 0.38, 0.35}});
  s.accent = dice->pick<Vec3>({{0.16, 0.36, 0.44}, {0.62, 0.40, 0.14}, {0.30, 0.42, 0.26}});
  s.wall = dice->pick<Vec3>({{0.91, 0.91, 0.90}, {0.90, 0.89, 0.86}});
  s.trim = {0.62, 0.63, 0.63};
  s.cabinet = {0.86, 0.86, 0.85};
  s.door = dice->seed();
  return s;
}

}  // namespace

Result<Place> make_office(const OfficeOptions& options) {
  Place place("office");
  place.openable = options.openable;
  Dice dice(options.seed, "office");
  place.style = office_style(&dice);
  const FloorPlan plan = OfficePlanner(options).plan();
  Workshop shop({"office", options.seed}, place.style, &place.materials);
  ShellOptions shell;
  for (const PlanRoom& room : plan.rooms) shell.rooms.push_back(office_finish(room, &shop));
  shell.facade = dice.chance(0.5) ? shop.brick() : shop.plaster({0.74, 0.75, 0.75});
  shell.doors = options.doors;
  shell.ceilings = options.roof;
  shell.roof = false;
  build_interior(plan, shell, interior_of(options), &dice, &shop, &place);
  return place;
}

}  // namespace gloam
