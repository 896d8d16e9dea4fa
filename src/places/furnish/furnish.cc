#include "places/furnish/furnish.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "places/furnish/shell.h"

namespace gloam {

Furnisher::Furnisher(const FloorPlan& plan, int room, const FurnishOptions& options, uint64_t seed,
                     Place* place)
    : plan_(plan),
      options_(options),
      place_(place),
      layout_(plan, room, options.passage, seed, place),
      dice_(layout_.dice) {}

void Furnisher::furnish() {
  struct {
    const char* kind;
    void (Furnisher::*furnish)();
  } const kinds[] = {{"living", &Furnisher::living},     {"kitchen", &Furnisher::kitchen},
                     {"bedroom", &Furnisher::bedroom},   {"bathroom", &Furnisher::bathroom},
                     {"study", &Furnisher::study},       {"utility", &Furnisher::utility},
                     {"hall", &Furnisher::hall},         {"landing", &Furnisher::hall},
                     {"corridor", &Furnisher::corridor}, {"open_office", &Furnisher::open_office},
                     {"office", &Furnisher::office},     {"meeting", &Furnisher::meeting},
                     {"copy", &Furnisher::copy}};
  switches();
  for (const auto& known : kinds)
    if (layout_.room().kind == known.kind) (this->*known.furnish)();
  sockets();
}

int Furnisher::make(const std::string& kind, std::optional<Vec3> size,
                    std::optional<uint64_t> seed) {
  const Result<int> made =
      place_->make({kind, seed.value_or(static_cast<uint64_t>(dice_.integer(0, 9))), size});
  GLOAM_CHECK(made.ok(), made.error().message.c_str());
  return *made;
}

bool Furnisher::is_loose(int index) { return prop(index).loose && dice_.chance(options_.loose); }

std::optional<int> Furnisher::at_wall(int index, const RoomLayout::Score& score) {
  const std::optional<Spot> spot = layout_.find_at_wall(prop(index), score);
  if (!spot) return std::nullopt;
  return layout_.put(index, *spot, is_loose(index));
}

std::optional<int> Furnisher::in_corner(int index) {
  return at_wall(
      index, [&](const Spot& s) { return -layout_.to_corner(s) + 0.2 * layout_.to_opening(s); });
}

std::optional<int> Furnisher::dining_set(const Vec3& table_size, const std::string& table_kind,
                                         const std::string& chair_kind,
                                         const RoomLayout::Score& preference) {
  const int table = make(table_kind, table_size);
  const int chair = make(chair_kind);
  const Prop::Box t = prop(table).bounds(), c = prop(chair).bounds();
  // Depth to which a seat goes under the table, and its reduction at most
  const double tuck = 0.18, drawn = 0.12;
  const float out = float(t.high.x + (c.high.x - c.low.x) - tuck + drawn);
  // Free on all sides, or else with one side at the wall.
  Prop all, half;
  all.body().collide_box({-out, t.low.y, 0}, {out, t.high.y, t.high.z});
  half.body().collide_box({t.low.x, t.low.y, 0}, {out, t.high.y, t.high.z});
  std::optional<Spot> spot = layout_.find_free(all, [&](const Spot& s) {
    return preference ? preference(s)
                      : layout_.to_opening(s) * 0.5 - std::min(layout_.to_corner(s), 2.5) * 0.1;
  });
  const bool is_free = spot.has_value();
  if (!spot)
    spot = layout_.find_at_wall(half, [&](const Spot& s) { return layout_.to_opening(s) * 0.5; });
  if (!spot) return std::nullopt;
  const int placement = layout_.put(table, *spot);
  const double wide = t.high.y - t.low.y;
  const int each = std::max(1, static_cast<int>((wide - 0.25) / 0.58));
  for (const int side : {1, -1}) {
    if (side < 0 && !is_free) break;
    for (int i = 0; i < each; ++i) {
      const double y = (i + 0.5) * wide / each - wide / 2 + dice_.uniform(-0.02, 0.02);
      const double x = side * (t.high.x - tuck + c.high.x + dice_.uniform(0, drawn));
      const Spot s = beside(*spot, x, y, side > 0 ? 2 : 0);
      layout_.put(chair, s, is_loose(chair));
    }
  }
  return placement;
}

void Furnisher::workplace(int desk, const Spot& spot) {
  const Prop::Box d = prop(desk).bounds();
  const int placement = layout_.put(desk, spot), chair = make("office_chair");
  const double z = placed(placement).X_WP.p.z + prop(desk).surfaces.at(0).z;
  const auto on_desk = [&](const char* kind, double x, double y, double turn) {
    const Spot at = beside(spot, x, y);
    layout_.put_at(make(kind), {at.x, at.y, z}, spot.quarter * M_PI / 2 + turn);
  };
  on_desk("monitor", d.low.x + 0.16, 0, 0);
  on_desk("keyboard", d.low.x + 0.46, 0, 0);
  on_desk("desk_lamp", d.low.x + 0.16, d.low.y + 0.18, 0.6);
  on_desk("mug", d.low.x + 0.42, d.high.y - 0.18, 0);
  on_desk("book_stack", d.low.x + 0.2, d.high.y - 0.22, 0.2);
  layout_.put(chair, beside(spot, d.high.x + 0.22, 0, 2), is_loose(chair));
}

void Furnisher::light(const std::string& kind, double spacing) {
  const Rect& r = layout_.room().clear;
  const int lamp = make(kind);
  const double length = std::max(r.width(), r.depth());
  const int count = std::max(1, static_cast<int>(std::lround(length / spacing)));
  const double z = plan_.floor_of(layout_.room().storey) + plan_.ceiling;
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count - 0.5;
    const bool along_x = r.width() >= r.depth();
    layout_.put_at(
        lamp, {r.x() + (along_x ? t * r.width() : 0), r.y() + (along_x ? 0 : t * r.depth()), z}, 0);
  }
}

void Furnisher::panels(double spacing) {
  const Rect& r = layout_.room().clear;
  const int lamp = make("panel_lamp");
  const auto count = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length / spacing)));
  };
  const int nx = count(r.width()), ny = count(r.depth());
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      layout_.put_at(lamp,
                     {r.x0 + r.width() * (i + 0.5) / nx, r.y0 + r.depth() * (j + 0.5) / ny,
                      plan_.floor_of(layout_.room().storey) + plan_.ceiling},
                     0);
}

void Furnisher::pictures(int count) {
  // Large ones first, on the walls that have none yet.
  int hung[4] = {};
  for (int i = 0; i < count; ++i) {
    const double edge = dice_.uniform(0.5, 0.7) * (i == 0 ? 1.4 : 1);
    const bool tall = dice_.chance(0.4);
    const Vec3 size{0.024, tall ? 0.75 * edge : 1.4 * edge, tall ? 1.1 * edge : edge};
    const double height = dice_.uniform(1.5, 1.62);
    const std::optional<Spot> spot =
        layout_.hang(make("picture", size, dice_.integer(0, 40)), height, [&](const Spot& s) {
          return -0.4 * layout_.to_middle(s) + 0.3 * layout_.to_opening(s) -
                 2.5 * hung[static_cast<int>(RoomLayout::back_of(s))];
        });
    if (spot) ++hung[static_cast<int>(RoomLayout::back_of(*spot))];
  }
}

void Furnisher::switches() {
  const int plate = make("light_switch");
  for (const Side side : {Side::kSouth, Side::kNorth, Side::kWest, Side::kEast}) {
    for (const Opening& o : layout_.openings(side)) {
      if (o.kind != OpeningKind::kDoor && o.kind != OpeningKind::kEntrance) continue;
      // On the side of the handle, else where the door stands when it is open.
      constexpr double kDoorMargin = 0.17;
      for (const double along : {o.hinge_low ? o.high() + kDoorMargin : o.low() - kDoorMargin,
                                 o.hinge_low ? o.low() - kDoorMargin : o.high() + kDoorMargin})
        if (layout_.hang_at(plate, against(layout_.room().clear, side, along, 0), 1.05)) break;
    }
  }
}

void Furnisher::sockets() {
  const int count = 1 + static_cast<int>(layout_.room().clear.area() / 8);
  const double height = layout_.room().kind == "bathroom" ? 1.1 : 0.3;
  for (int i = 0; i < count; ++i)
    layout_.hang(make("wall_socket", {}, 0), height,
                 [&](const Spot& s) { return -0.5 * layout_.to_corner(s); });
}

void Furnisher::radiators() {
  for (const Side side : {Side::kSouth, Side::kNorth, Side::kWest, Side::kEast}) {
    for (const Opening& o : layout_.openings(side)) {
      if (o.kind != OpeningKind::kWindow || o.sill < 0.65) continue;
      const Vec3 size{0.1, std::min(o.width - 0.1, 1.4), std::min(0.6, o.sill - 0.2)};
      at_wall(make("radiator", size), [&](const Spot& s) {
        const double away = std::abs((runs_along_x(side) ? s.x : s.y) - o.center);
        return RoomLayout::back_of(s) == side && away < 0.06 ? -away : -2000.0;
      });
    }
  }
}

void Furnisher::curtains() {
  const Rect& r = layout_.room().clear;
  for (const Side side : {Side::kSouth, Side::kNorth, Side::kWest, Side::kEast}) {
    for (const Opening& o : layout_.openings(side)) {
      if (o.kind != OpeningKind::kWindow) continue;
      const double top = std::min(o.head + 0.14, plan_.ceiling - 0.03);
      const Spot spot = against(r, side, o.center, 0);
      // To the floor where nothing stands there, else to the sill.
      for (const double low : {0.03, o.sill - 0.1}) {
        const int curtain = make("curtain", Vec3{0.12, o.width + 0.3, top - low}, 1);
        if (layout_.hang_at(curtain, spot, top)) break;
      }
    }
  }
}

void Furnisher::floor_clutter(const std::vector<std::string>& kinds) {
  const double mean = options_.clutter * layout_.room().clear.area() / 5;
  const int count = static_cast<int>(mean + dice_.uniform());
  for (int i = 0; i < count; ++i) {
    const int thing = make(dice_.pick(kinds));
    const std::optional<Spot> spot = layout_.find_free(prop(thing), [&](const Spot& s) {
      return dice_.uniform(0, 1) + 0.2 * std::min(layout_.to_opening(s), 2.0);
    });
    if (spot) layout_.put(thing, *spot, is_loose(thing));
  }
}

void Furnisher::tidy(int placement, const std::vector<std::string>& kinds, double many) {
  const int most = static_cast<int>(many * (0.3 + 1.4 * options_.clutter) + dice_.uniform());
  layout_.scatter(placement, kinds, most, options_.loose);
}

}  // namespace gloam
