#include "places/furnish/shell.h"

#include <algorithm>

namespace gloam {
namespace {

// A rectangle of a wall: along it and upwards [m].
struct WallPiece {
  double from, to, low, high;
};

constexpr double kMinPieceWidth = 0.001;  // width below which a piece is rounding [m]

// Pieces of a wall between `from` and `to`, `low` and `high`, around its openings.
std::vector<WallPiece> cut(double from, double to, double low, double high,
                           std::vector<Opening> openings) {
  std::sort(openings.begin(), openings.end(),
            [](const Opening& a, const Opening& b) { return a.center < b.center; });
  std::vector<WallPiece> pieces;
  double at = from;
  for (const Opening& o : openings) {
    if (o.low() - at > kMinPieceWidth) pieces.push_back({at, o.low(), low, high});
    if (o.sill - low > kMinPieceWidth && o.kind == OpeningKind::kWindow)
      pieces.push_back({o.low(), o.high(), low, o.sill});
    if (high - o.head > kMinPieceWidth) pieces.push_back({o.low(), o.high(), o.head, high});
    at = std::max(at, o.high());
  }
  if (to - at > kMinPieceWidth) pieces.push_back({at, to, low, high});
  return pieces;
}

class ShellBuilder {
 public:
  ShellBuilder(const FloorPlan& plan, const ShellOptions& options, Place* place)
      : plan_(plan),
        options_(options),
        place_(place),
        shop_({"shell", options.seed}, place->style, &place->materials) {}

  void build() {
    for (int i = 0; i < static_cast<int>(plan_.rooms.size()); ++i) {
      const PlanRoom& room = plan_.rooms[static_cast<size_t>(i)];
      const RoomFinish& finish = options_.rooms[static_cast<size_t>(i)];
      add_floor(room, finish);
      add_walls(i, room, finish);
      if (finish.skirting) add_skirting(i, room);
      if (options_.ceilings) add_ceiling(room, finish);
      const double z = plan_.floor_of(room.storey);
      const Rect& r = room.clear;
      place_->regions.push_back(
          {room.name, room.kind, {r.x0, r.y0, z}, {r.x1, r.y1, z + plan_.ceiling}});
    }
    for (const Opening& opening : plan_.openings) add_opening(opening);
    if (!options_.facade.empty()) add_facade();
    if (plan_.stairwell) add_stairs();
    if (options_.roof) {
      const Rect& o = plan_.outline;
      const double f = 2 * kFacade;
      const int roof = place_->add(make_roof(shop_, o.width() + f, o.depth() + f));
      place_->put(roof, "", {{o.x(), o.y(), top()}});
    }
  }

 private:
  // Above the topmost ceiling.
  double top() const { return plan_.floor_of(plan_.storeys - 1) + plan_.ceiling + 0.1; }

  bool is_stairwell(const PlanRoom& room) const { return room.kind == "stairs"; }

  int put(const std::string& label, const PlanRoom& room, Prop prop) {
    prop.label = label;
    const double z = plan_.floor_of(room.storey);
    return place_->put(place_->add(std::move(prop)), room.name,
                       {{room.clear.x(), room.clear.y(), z}});
  }

  // The room and its half of the walls, about the room's middle.
  Rect extent(const PlanRoom& room) const {
    const double h = plan_.wall / 2, x = room.clear.width() / 2 + h, y = room.clear.depth() / 2 + h;
    return {-x, -y, x, y};
  }

  void add_floor(const PlanRoom& room, const RoomFinish& finish) {
    if (is_stairwell(room) && room.storey > 0) return;
    const Rect r = extent(room);
    const float thickness = room.storey == 0 ? 0.3f : float(plan_.floor_thickness - 0.04);
    Prop p;
    const Vec3f low{float(r.x0), float(r.y0), -thickness}, high{float(r.x1), float(r.y1), 0};
    p.body().show("floor", finish.floor, slab(low, high, 0));
    p.body().collide_box(low, high);
    put("floor", room, std::move(p));
  }

  void add_ceiling(const PlanRoom& room, const RoomFinish& finish) {
    const bool topmost = room.storey + 1 == plan_.storeys;
    if (is_stairwell(room) && !topmost) return;
    const Rect r = extent(room);
    const float z = float(plan_.ceiling);
    Prop p;
    const Vec3f low{float(r.x0), float(r.y0), z},
        high{float(r.x1), float(r.y1), z + (topmost ? 0.1f : 0.04f)};
    p.body().show("ceiling", finish.ceiling, slab(low, high, 0));
    if (topmost) p.body().collide_box(low, high);
    put("ceiling", room, std::move(p));
  }

  // Box of a leaf of the wall on `side` of a rectangle, `thick` outwards from its edge.
  static std::pair<Vec3f, Vec3f> leaf(const Rect& r, Side side, const WallPiece& w, double thick) {
    const auto f = [](double x) { return static_cast<float>(x); };
    switch (side) {
      case Side::kWest:
        return {{f(r.x0 - thick), f(w.from), f(w.low)}, {f(r.x0), f(w.to), f(w.high)}};
      case Side::kEast:
        return {{f(r.x1), f(w.from), f(w.low)}, {f(r.x1 + thick), f(w.to), f(w.high)}};
      case Side::kSouth:
        return {{f(w.from), f(r.y0 - thick), f(w.low)}, {f(w.to), f(r.y0), f(w.high)}};
      default:
        return {{f(w.from), f(r.y1), f(w.low)}, {f(w.to), f(r.y1 + thick), f(w.high)}};
    }
  }

  // Openings of a side with centres relative to (x, y).
  static std::vector<Opening> relative(std::vector<Opening> openings, Side side, double x,
                                       double y) {
    for (Opening& o : openings) o.center -= runs_along_x(side) ? x : y;
    return openings;
  }

  // Walls of south and north have the corners.
  static std::pair<double, double> span(const Rect& r, Side side, double corner) {
    if (runs_along_x(side)) return {r.x0 - corner, r.x1 + corner};
    return {r.y0, r.y1};
  }

  Rect centered(const PlanRoom& room) const {
    const double x = room.clear.width() / 2, y = room.clear.depth() / 2;
    return {-x, -y, x, y};
  }

  void add_walls(int index, const PlanRoom& room, const RoomFinish& finish) {
    const Rect r = centered(room);
    const double h = plan_.wall / 2;
    // In a stairwell the wall goes on through the floor.
    const bool through = is_stairwell(room) && room.storey + 1 < plan_.storeys;
    const double high = plan_.ceiling + (through ? plan_.floor_thickness : 0.04);
    Prop p;
    for (const Side side : kSides) {
      const auto [from, to] = span(r, side, h);
      const auto openings =
          relative(plan_.openings_of(index, side), side, room.clear.x(), room.clear.y());
      for (const WallPiece& piece : cut(from, to, 0, high, openings)) {
        const auto [a, b] = leaf(r, side, piece, h);
        p.body().show("wall", finish.wall, slab(a, b, 0));
        p.body().collide_box(a, b);
      }
    }
    put("wall", room, std::move(p));
  }

  void add_skirting(int index, const PlanRoom& room) {
    constexpr double kHeight = 0.075, kThick = 0.014;
    const Rect r = centered(room);
    const Rect inner = r.grown(-kThick);
    Prop p;
    const std::string paint = shop_.paint(place_->style.trim, 0.4);
    for (const Side side : kSides) {
      const auto [from, to] = span(r, side, 0);
      std::vector<Opening> doors;
      for (Opening o :
           relative(plan_.openings_of(index, side), side, room.clear.x(), room.clear.y())) {
        if (o.kind == OpeningKind::kWindow && o.sill > kHeight) continue;
        o.width += 0.12;  // the architraves
        o.head = kHeight;
        doors.push_back(o);
      }
      for (const WallPiece& piece : cut(from, to, 0.001, kHeight, doors)) {
        const auto [a, b] = leaf(inner, side, piece, kThick);
        p.body().show("skirting", paint, slab(a, b, 0.004f));
      }
    }
    put("skirting", room, std::move(p));
  }

  void add_opening(const Opening& opening) {
    const PlanRoom& room = plan_.rooms[static_cast<size_t>(opening.a)];
    const Rect& r = room.clear;
    const bool outside = opening.b < 0 && opening.kind != OpeningKind::kLocked;
    const double h = plan_.wall / 2, wall = outside ? h + kFacade : plan_.wall;
    const double across = wall / 2;  // from the room's face to the middle of the wall
    double x = opening.center, y = opening.center;
    switch (opening.side) {
      case Side::kWest:
        x = r.x0 - across;
        break;
      case Side::kEast:
        x = r.x1 + across;
        break;
      case Side::kSouth:
        y = r.y0 - across;
        break;
      default:
        y = r.y1 + across;
    }
    const Pose X = facing(opening.side, x, y, plan_.floor_of(room.storey));
    Prop prop;
    switch (opening.kind) {
      case OpeningKind::kDoor: {
        // Seen along local +x, left is +y.
        const bool low_is_left = opening.side == Side::kNorth || opening.side == Side::kWest;
        const double angle = options_.doors == "open"   ? 1.5
                             : options_.doors == "ajar" ? shop_.dice.uniform(0.15, 0.7)
                                                        : 0;
        prop = make_door(shop_, opening, wall, opening.hinge_low == low_is_left, angle);
        prop.label = "door";
        break;
      }
      case OpeningKind::kLocked:
        prop = make_door(shop_, opening, wall, opening.hinge_low, 0);
        for (PropPart& part : prop.parts) part.joint.reset();
        add_backing(opening, wall, &prop.body());
        prop.label = "door";
        break;
      case OpeningKind::kEntrance:
        prop = make_entrance(shop_, opening, wall);
        prop.label = "door";
        break;
      case OpeningKind::kBare:
        return;
      case OpeningKind::kArch:
        if (room.kind == "stairs" || plan_.rooms[static_cast<size_t>(opening.b)].kind == "stairs")
          return;
        prop = make_arch(shop_, opening, wall);
        prop.label = "doorway";
        break;
      default:
        prop = make_window(shop_, opening, wall);
        prop.label = "window";
    }
    place_->put(place_->add(std::move(prop)), room.name, X);
  }

  // No light through the gaps of a door that leads nowhere.
  void add_backing(const Opening& o, double wall, PropPart* part) {
    const float x = float(wall / 2) + 0.02f, y = float(o.width / 2) + 0.1f,
                z = float(o.head) + 0.1f;
    const std::string black = shop_.plastic({0.02, 0.02, 0.02}, 0.9);
    part->show("backing", black, slab({x, -y, -0.02f}, {x + 0.01f, y, z}, 0));
    part->show("backing", black, slab({0, -y, -0.02f}, {x, y, -0.001f}, 0));
    for (const float side : {-y, y - 0.01f})
      part->show("backing", black, slab({0, side, 0}, {x, side + 0.01f, z}, 0));
    part->show("backing", black, slab({0, -y, z - 0.01f}, {x, y, z}, 0));
  }

  // One leaf around all storeys, with the openings of every room that lies at it.
  void add_facade() {
    const Rect& o = plan_.outline;
    const Rect r{-o.width() / 2, -o.depth() / 2, o.width() / 2, o.depth() / 2};
    Prop p;
    for (int storey = 0; storey < plan_.storeys; ++storey) {
      const double z = plan_.floor_of(storey);
      const double low = storey == 0 ? -kGroundDrop : z;
      const double high = storey + 1 < plan_.storeys ? plan_.floor_of(storey + 1) : top();
      for (const Side side : kSides) {
        std::vector<Opening> openings;
        for (Opening opening : plan_.openings) {
          const PlanRoom& room = plan_.rooms[static_cast<size_t>(opening.a)];
          if (opening.b >= 0 || opening.side != side || room.storey != storey) continue;
          opening.sill += z;
          opening.head += z;
          openings.push_back(opening);
        }
        const auto [from, to] = span(r, side, kFacade);
        for (const WallPiece& piece :
             cut(from, to, low, high, relative(openings, side, o.x(), o.y()))) {
          const auto [a, b] = leaf(r, side, piece, kFacade);
          p.body().show("facade", options_.facade, slab(a, b, 0));
          p.body().collide_box(a, b);
        }
      }
    }
    // Below the threshold of the entrance.
    for (const Opening& opening : plan_.openings) {
      if (opening.kind != OpeningKind::kEntrance) continue;
      WallPiece piece{opening.low(), opening.high(), -kGroundDrop, 0};
      const double center = runs_along_x(opening.side) ? o.x() : o.y();
      piece.from -= center, piece.to -= center;
      const auto [a, b] = leaf(r, opening.side, piece, kFacade);
      p.body().show("threshold", shop_.concrete(), slab(a, b, 0.004f));
      p.body().collide_box(a, b);
    }
    p.label = "facade";
    place_->put(place_->add(std::move(p)), "", {{o.x(), o.y(), 0}});
  }

  void add_stairs() {
    const Rect& w = *plan_.stairwell;
    const bool along_y = runs_along_x(plan_.stair_side);
    const double width = along_y ? w.width() : w.depth(), depth = along_y ? w.depth() : w.width();
    Prop p = make_stairs(shop_, width, depth + plan_.wall, plan_.ceiling + plan_.floor_thickness);
    p.label = "stairs";
    // The open side, at the hall's edge of the wall.
    double x = w.x(), y = w.y();
    if (plan_.stair_side == Side::kNorth) y = w.y1 + plan_.wall;
    if (plan_.stair_side == Side::kSouth) y = w.y0 - plan_.wall;
    if (plan_.stair_side == Side::kEast) x = w.x1 + plan_.wall;
    if (plan_.stair_side == Side::kWest) x = w.x0 - plan_.wall;
    place_->put(place_->add(std::move(p)), "", facing(opposite(plan_.stair_side), x, y, 0));
  }

  const FloorPlan& plan_;
  const ShellOptions& options_;
  Place* place_;
  Workshop shop_;
};

}  // namespace

Pose facing(Side side, double x, double y, double z) {
  const double angle = side == Side::kEast    ? 0
                       : side == Side::kNorth ? M_PI / 2
                       : side == Side::kWest  ? M_PI
                                              : -M_PI / 2;
  return {{x, y, z}, turn({0, 0, 1}, angle)};
}

void build_shell(const FloorPlan& plan, const ShellOptions& options, Place* place) {
  ShellBuilder(plan, options, place).build();
}

}  // namespace gloam
