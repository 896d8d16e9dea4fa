#pragma once
// Rooms and the openings between them, before walls have thickness on paper. A building is storeys
// of rooms that share one rectangular outline.

#include <optional>
#include <string>
#include <vector>

#include "gloam/scene/place.h"

namespace gloam {

/// Axis-parallel, in the ground plan [m].
struct Rect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  double width() const { return x1 - x0; }
  double depth() const { return y1 - y0; }
  double area() const { return width() * depth(); }
  double x() const { return (x0 + x1) / 2; }
  double y() const { return (y0 + y1) / 2; }
  Rect grown(double by) const { return {x0 - by, y0 - by, x1 + by, y1 + by}; }
  bool overlaps(const Rect& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
  bool contains(const Rect& o) const {
    return x0 <= o.x0 && y0 <= o.y0 && o.x1 <= x1 && o.y1 <= y1;
  }
  /// From its nearest point; 0 inside.
  double distance_to(double px, double py) const;
};

enum class Side { kWest, kEast, kSouth, kNorth };
inline constexpr Side kSides[] = {Side::kWest, Side::kEast, Side::kSouth, Side::kNorth};
inline constexpr double kDoorToCorner = 0.14;  ///< least, from a door's opening [m]
Side opposite(Side side);
/// Do walls of this side run along x?
inline bool runs_along_x(Side side) { return side == Side::kSouth || side == Side::kNorth; }

struct PlanRoom {
  std::string name;  ///< "bedroom_2"
  std::string kind;  ///< "bedroom"
  int storey = 0;
  Rect clear;  ///< between its walls
};

/// kBare: a hole in the wall and nothing more; kLocked: a door that does not open, with nothing
/// behind it.
enum class OpeningKind { kDoor, kArch, kWindow, kEntrance, kBare, kLocked };

/// A hole in the wall of room `a` towards room `b`.
struct Opening {
  OpeningKind kind = OpeningKind::kDoor;
  int a = 0, b = -1;         ///< b: -1 = outside
  Side side = Side::kNorth;  ///< side of a
  double center = 0;         ///< along the wall [m]
  double width = 0.86;
  double sill = 0, head = 2.04;  ///< above the floor [m]
  bool hinge_low = true;         ///< doors: at the lower coordinate; they open into room b
  double low() const { return center - width / 2; }
  double high() const { return center + width / 2; }
};

struct FloorPlan {
  std::vector<PlanRoom> rooms;
  std::vector<Opening> openings;
  Rect outline;                  ///< outline of all rooms and their halves of the walls
  double wall = 0.12;            ///< between rooms [m]
  double ceiling = 2.5;          ///< clear height [m]
  double floor_thickness = 0.3;  ///< between storeys [m]
  int storeys = 1;
  std::optional<Rect> stairwell = {};  ///< clear rectangle, open towards `stair_side`
  Side stair_side = Side::kNorth;

  double floor_of(int storey) const { return storey * (ceiling + floor_thickness); }
  /// The openings in one side of a room; for room b of an opening, as seen from there.
  std::vector<Opening> openings_of(int room, Side side) const;
};

/// Rooms on both sides of a hall.
FloorPlan plan_house(const HouseOptions& options);

}  // namespace gloam
