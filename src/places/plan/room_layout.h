#pragma once
// Layout of things in a room: nothing overlaps, doors can swing, things in use can be walked up to,
// and a disc of a given width gets from every opening to every other.

#include <functional>
#include <optional>
#include <vector>

#include "places/place.h"
#include "places/plan/floor_plan.h"
#include "places/plan/way_map.h"

namespace gloam {

/// Place of a prop: a point of the ground plan and the direction of its +x, in quarter turns
/// counter-clockwise from east.
struct Spot {
  double x = 0, y = 0;
  int quarter = 0;
  Pose pose(double z) const;
};

/// With its back to a room's wall: `along` is its x or y there, `out` how far it stands off.
Spot against(const Rect& room, Side side, double along, double out);

/// A point `x` before and `y` beside a spot, as a spot turned by `quarters` more.
Spot beside(const Spot& from, double x, double y, int quarters = 0);

/// The prop's rectangle there; `grow` in front of it (its +x) by so much.
Rect footprint(const Prop::Box& box, const Spot& spot, double front = 0);

class RoomLayout {
 public:
  /// `way` = width that stays passable [m].
  RoomLayout(const FloorPlan& plan, int room, double way, uint64_t seed, Place* place);

  const PlanRoom& room() const { return room_; }
  Dice dice;

  /// Higher is better; spots that score below -1000 are not taken.
  using Score = std::function<double(const Spot&)>;

  /// The best spot with the back to a wall.
  std::optional<Spot> find_at_wall(const Prop& prop, const Score& score);
  /// The best of a grid of spots anywhere.
  std::optional<Spot> find_free(const Prop& prop, const Score& score);
  /// Would it do there? `overlap_front`: what it needs in front may be taken by its partner.
  bool fits(const Prop& prop, const Spot& spot, bool overlap_front = false) const;

  /// Keeps a rectangle of floor free.
  void reserve(const Rect& rect) { keep_free_.push_back(rect); }
  /// Puts it on the floor. Returns its placement.
  int put(int prop, const Spot& spot, bool loose = false);
  /// On another thing, turned by `yaw` [rad]; takes no floor.
  int put_at(int prop, const Vec3& position, double yaw, bool loose = false);
  /// A thing that hangs on a wall, its origin `height` above the floor: the best place by the score
  /// of the point where it touches the wall. Returns where it hangs.
  std::optional<Spot> hang(int prop, double height, const Score& score);
  /// Hangs it exactly there unless something is in the way; it may cover a window.
  bool hang_at(int prop, const Spot& spot, double height);
  /// Small things on the surfaces of a placement, as many as fit, at most `most`.
  void scatter(int placement, const std::vector<std::string>& kinds, int most, double loose);

  // Scores.
  double to_corner(const Spot& spot) const;    ///< distance to the nearest corner [m]
  double to_middle(const Spot& spot) const;    ///< distance along its wall to the wall's middle
  double to_opening(const Spot& spot) const;   ///< distance to the nearest door
  double facing_door(const Spot& spot) const;  ///< 1 where it looks at the nearest door
  bool below_window(const Spot& spot) const;
  const std::vector<Opening>& openings(Side side) const {
    return openings_[static_cast<int>(side)];
  }
  /// Side of the wall at its back.
  static Side back_of(const Spot& spot);

 private:
  struct Taken {
    Rect rect;
    double low, high;  // [m] above the floor
    Rect front;        // must be walked up to; of no width where there is none
  };
  void take(const Taken& taken);
  bool is_blocked(const Prop::Box& box, const Rect& rect) const;
  bool leaves_way(const Rect& rect, const Rect& front) const;
  bool before_window(const Prop::Box& box, const Spot& spot) const;
  std::optional<Spot> best(std::vector<std::pair<double, Spot>> scored, const Prop& prop) const;

  const PlanRoom room_;
  const double floor_;
  Place* place_;
  WayMap ways_;
  std::vector<Opening> openings_[4];
  std::vector<Rect> keep_free_;  // areas where doors swing and one steps through them
  std::vector<std::pair<double, double>> steps_;  // points that must be reached: before openings
  std::vector<Taken> taken_;
  struct Hung {
    Side side;
    double from, to, low, high;
  };
  std::vector<Hung> hung_;
};

}  // namespace gloam
