#pragma once
// Heights of the ground under a rectangle, by rays on a grid: of what stands still and can be
// touched.

#include <mujoco/mujoco.h>

#include <vector>

namespace gloam {

/// Area in which the ground is searched [m].
struct GroundArea {
  double low_x = 0, low_y = 0, size_x = 0, size_y = 0;
  double from = 0;  ///< z; downwards from here [m]
};

class GroundBelow {
 public:
  /// nx x ny squares, at whose corners it is looked for. `sky`: whether the sky is open there, too.
  GroundBelow(const mjModel& model, const GroundArea& area, int nx, int ny, bool sky);

  /// True if there is ground at every corner.
  bool everywhere() const;
  /// `u`, `v`: over the area, 0 … 1. Linear between corners.
  double at(double u, double v) const;
  /// Height of the corner in column i of row j, 0 … nx, 0 … ny.
  double height(int i, int j) const { return heights_[row(i, j)]; }
  /// Nothing that stands still, seen or touched, is above it.
  bool is_open(int i, int j) const { return open_[row(i, j)]; }

 private:
  size_t row(int i, int j) const {
    return static_cast<size_t>(j) * static_cast<size_t>(nx_ + 1) + static_cast<size_t>(i);
  }
  int nx_, ny_;
  std::vector<double> heights_;
  std::vector<bool> open_;
};

}  // namespace gloam
