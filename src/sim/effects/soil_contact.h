#pragma once
// Which cells of a bed of soil colliders reach into, how far, and over what share of them; and the
// patches that these make, with Bekker's width b of each.
//
// A collider is looked at along lines in x, two or more to a row of cells and at least sixteen over
// the collider. The ends of what is below the undisturbed surface are found by bisection, so that
// areas and edges do not depend on how a collider lies over cells.

#include <cstdint>
#include <span>
#include <vector>

#include "sim/effects/collider_bottom.h"
#include "world/soil_description.h"

namespace gloam {

/// A collider in a cell. Means over what it covers of it.
struct SoilTouch {
  int cell = 0;
  int geom = 0, body = 0;
  int patch = 0;         ///< row of SoilContacts::widths()
  double area = 0;       ///< seen from above [m²]
  double p[3] = {};      ///< on the collider's underside, world [m]
  double slope[2] = {};  ///< dz/dx, dz/dy of it
  double depth = 0;      ///< below the undisturbed surface [m]
};

class SoilContacts {
 public:
  /// Has room for all that `colliders`, so many and so large, can touch.
  SoilContacts(const SoilDescription& soil, const mjModel& model, std::span<const int> geoms);

  /// That there can be.
  size_t most_touches() const { return touches_.capacity(); }

  void clear();
  /// Adds what a collider touches. Its pose is set.
  void add(const ColliderBottom& collider);
  /// After the last add(): colliders in the same or neighbouring cells make one patch.
  void finish();

  /// In the order of add(); of each collider by rows of cells.
  std::span<SoilTouch> touches() { return touches_; }
  /// Bekker's b of each patch: twice the area over the edge of the hull of what is covered, which
  /// is the radius of a round plate and the width of a long one [m].
  std::span<const double> widths() const { return widths_; }
  /// Middle of each patch, x and y [m].
  const double* centre(int patch) const { return centres_.data() + 2 * patch; }
  bool is_touched(int cell) const { return marks_[static_cast<size_t>(cell)].round == round_; }

 private:
  struct Point {
    double x = 0, y = 0;
    bool operator<(const Point& o) const { return x != o.x ? x < o.x : y < o.y; }
  };
  struct Outline {
    size_t first, count;  // of points_
    int parent;           // another outline of the same patch, or itself
  };
  struct Mark {
    uint32_t round = 0;
    int outline = 0;
    float area = 0;  // covered [m²]
  };
  bool is_below(const ColliderBottom& collider, double x, double y, BottomPoint* out) const;
  bool find_ends(const ColliderBottom& collider, double y, double step, double* ends) const;
  void add_line(const ColliderBottom& collider, double y, double width, const double* ends);
  void add_edge(size_t line, size_t neighbour, double dy);
  void flush(int row, const ColliderBottom& collider, int outline);
  int root(int outline);
  double width_of(int patch);

  const SoilDescription& soil_;
  std::vector<SoilTouch> row_;  // of cells along x, sums
  int row_low_, row_high_;      // in use
  std::vector<SoilTouch> touches_;
  std::vector<Outline> outlines_;
  std::vector<Point> points_, sorted_, hull_;
  std::vector<double> widths_, centres_;
  std::vector<int> patch_of_;  // outline
  std::vector<Mark> marks_;    // of each cell
  uint32_t round_ = 0;
};

}  // namespace gloam
