#pragma once
// Free places for the centre of a disc in a room, as a grid, and the paths between them.

#include <cstdint>
#include <utility>
#include <vector>

#include "places/plan/floor_plan.h"

namespace gloam {

class WayMap {
 public:
  using Point = std::pair<double, double>;

  /// Map for a disc of this radius between the walls of `room`.
  WayMap(const Rect& room, double radius);
  /// A thing stands there.
  void block(const Rect& thing);
  /// With one more thing: can it get from points[0] to every other, and to each zone that is not
  /// empty? To a zone means within an arm's length of it.
  bool connects(const Rect& thing, const std::vector<Point>& points,
                const std::vector<Rect>& zones) const;

 private:
  using Cells = std::vector<uint8_t>;
  void paint(const Rect& thing, Cells* free) const;
  int column(double x) const;
  int row(double y) const;

  Rect room_;
  double radius_;
  int columns_, rows_;
  Cells free_;
};

}  // namespace gloam
