#pragma once
// Cells of a bed of soil that colliders reach into, with depth and covered fraction; and the
// patches that these make, with Bekker's width b of each.
//
// A collider is sampled along lines in x, two or more to a row of cells and at least sixteen over
// the collider. The ends of the part below the undisturbed surface are exact, or found by
// bisection, so that areas and edges do not depend on how a collider lies over cells. The result is
// kept until the collider has moved by a tenth of a cell or a twentieth of its sinkage: until then
// the underside rises and falls over the same cells.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/effects/bodies/collider_bottom.h"
#include "world/effects/soil_description.h"

namespace gloam {

/// A collider in a cell. Means over what it covers of it.
struct SoilTouch {
  int cell = 0;
  int geom = 0, body = 0;
  int patch = 0;         ///< number of SoilContacts::width()
  double area = 0;       ///< seen from above [m²]
  double p[3] = {};      ///< on the collider's underside, world [m]
  double slope[2] = {};  ///< dz/dx, dz/dy of it
  double depth = 0;      ///< below the undisturbed surface [m]
  double fallen = 0;     ///< height of that surface over that of time 0 [m]
};

class SoilContacts {
 public:
  /// Has room for all that `colliders`, so many and so large, can touch.
  SoilContacts(const SoilDescription& soil, const mjModel& model, std::span<const int> geoms);

  /// Forgets what it has seen.
  void reset();
  /// Begins an instant, before which so much has fallen where all of it lies [m].
  void clear(double fallen);
  /// Adds what a collider touches. Its pose is set.
  void add(const ColliderBottom& collider);
  /// After the last add(): colliders in the same or neighbouring cells make one patch.
  void finish();

  /// Upper bound of the number of touches.
  size_t most_touches() const { return touches_.capacity(); }
  /// In the order of add(); of each collider by rows of cells.
  std::span<SoilTouch> touches() { return touches_; }
  int patches() const { return static_cast<int>(patches_.size()); }
  /// Bekker's b of a patch: twice the area over the edge of the hull of what is covered, which is
  /// the radius of a round plate and the width of a long one [m].
  double width(int patch) const { return patches_[static_cast<size_t>(patch)].width; }
  /// Middle of a patch, x and y [m].
  const double* centre(int patch) const { return patches_[static_cast<size_t>(patch)].centre; }
  /// Number that changes whenever the touched cells may have changed.
  uint32_t round() const { return round_; }
  bool is_touched(int cell) const { return marks_[static_cast<size_t>(cell)].round == round_; }

 private:
  struct Point {
    double x = 0, y = 0;
  };
  // Part below the surface of a line along x [m].
  struct Line {
    double y = 0, left = 0, right = 0;
    int number = 0;  // number among all that the bed may have
  };
  struct Patch {
    double width = 0;  // Bekker's b [m]
    double centre[2] = {};
  };
  // Cover of a collider when it was sampled last: valid until it has moved by a fraction of that.
  struct Footprint {
    bool known = false;
    double p[3] = {}, R[9] = {};     // pose of the collider then
    double anchor[3] = {};           // in its frame
    double deepest = 0, size = 0;    // [m]
    double fallen = 0;               // until then [m]
    int low[2] = {}, high[2] = {};   // cells along x and y, inclusive
    std::vector<SoilTouch> touches;  // depths below the surface of time 0
    std::vector<Line> outline;       // from low y to high
    uint64_t number = 0;             // number of the sampling
    uint64_t patch_number = 0;       // number of the samplings of all its members
    Patch patch;                     // patch that begins with it
    std::vector<double> rise;        // rise of the underside over each touch since then [m]
    int parent = 0;                  // another of the same patch among here_, or itself
  };
  // Samples of many places under a collider.
  struct Samples {
    std::vector<double> x, y, area, z, slope_x, slope_y;
    std::vector<int> cell;
  };
  struct Mark {
    uint32_t round = 0;
    int row = 0;     // row of here_
    float area = 0;  // covered [m²]
  };
  static constexpr int kContactLines = 16;      // over a collider, at least
  static constexpr int kMostContactLines = 16;  // to a row of cells
  static int lines_of(double cell, double extent);
  bool is_below(const ColliderBottom& collider, double x, double y) const;
  int column_at(double x) const;
  int row_at(double y) const;
  double surface_at(int column, int row) const;
  std::optional<double> level_in(const double* low, const double* high) const;
  bool has_stayed(const ColliderBottom& collider, Footprint* print) const;
  void look(const ColliderBottom& collider, Footprint* print);
  void find_lines(const ColliderBottom& collider, std::optional<double> level, int per_row,
                  const double* low, const double* high);
  bool find_ends(const ColliderBottom& collider, double y, double low, double high, double step,
                 double* ends) const;
  void cut_lines(int per_row);
  void sum_cells(const ColliderBottom& collider, Footprint* print);
  void flush(int row, const ColliderBottom& collider, Footprint* print);
  void outline(double width, Footprint* print) const;
  void add_chain(std::span<const Line> lines, double Line::* end, double side);
  Patch patch_of(int row);
  void join(int row);
  bool may_join(int row) const;
  Footprint& print_at(int row) {
    return prints_[static_cast<size_t>(here_[static_cast<size_t>(row)])];
  }
  const Footprint& print_at(int row) const {
    return prints_[static_cast<size_t>(here_[static_cast<size_t>(row)])];
  }
  int root(int row) const;
  void add_patch(int row);

  const SoilDescription& soil_;
  std::vector<int> print_of_;  // geom, row of prints_
  std::vector<Footprint> prints_;
  double fallen_ = 0;               // [m]
  std::vector<int> here_, before_;  // rows of prints_: of this instant and of the last
  bool changed_ = true;
  std::vector<SoilTouch> row_;  // sums of cells along x
  int row_low_, row_high_;      // in use
  std::vector<SoilTouch> touches_;
  std::vector<Patch> patches_;
  std::vector<Line> lines_, merged_;       // scratch
  std::vector<double> ys_, left_, right_;  // scratch, of lines
  Samples samples_;                        // scratch
  std::vector<Point> hull_;                // scratch
  std::vector<Mark> marks_;                // mark of each cell
  uint32_t round_ = 0;
  uint64_t looks_ = 0;
};

}  // namespace gloam
