// Visible changes of a bed's surface by bodies.

#include "sim/effects/soil/soil_bed.h"

namespace gloam {
namespace {

constexpr double kMinDistance = 1e-9;   // [m]
constexpr double kMinSlipSpeed = 0.05;  // [m/s]
constexpr double kHeapWidth = 1.5;      // width of a heap, over the sinkage beside it
constexpr double kMinExcess = 1e-5;     // [m]
constexpr int kFarthest = 64;           // cells to it

}  // namespace

// Returns by how much [m].
float SoilBed::lower_track(const SoilTouch& touch) {
  const SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
  const double share = std::min(touch.area / (soil_.dx * soil_.dy), 1.0);
  const double deepest = cell.sinkage_under(touch.fallen);
  const double left =
      deepest - double{cell.pressure} / cell.unloading(soil_.strength, touch.fallen);
  const auto height = static_cast<float>(-left * share);
  const float lower = tracks_.height(touch.cell) - height;
  if (lower <= 0) return 0;
  tracks_.set_height(touch.cell, height);
  return lower;
}

// Displaced soil rises beside the body: away from its middle, or, if it moves on, at its sides.
// This is visible only and changes no force.
void SoilBed::push_aside(const SoilTouch& touch, const double* velocity, double volume) {
  if (volume <= 0) return;
  const double* centre = contacts_.centre(touch.patch);
  double way[2] = {touch.p[0] - centre[0], touch.p[1] - centre[1]};
  const double speed = std::hypot(velocity[0], velocity[1]);
  if (speed > kMinSlipSpeed) {
    const double across[2] = {-velocity[1] / speed, velocity[0] / speed};
    const double side = way[0] * across[0] + way[1] * across[1] < 0 ? -1 : 1;
    way[0] = side * across[0], way[1] = side * across[1];
  }
  const double length = std::hypot(way[0], way[1]);
  if (length < kMinDistance) return;
  // From cell to cell, out of what is touched, then over as many as the heap is wide.
  const double step = std::min(soil_.dx, soil_.dy);
  const int wide = std::clamp(static_cast<int>(std::ceil(kHeapWidth * touch.depth / step)), 2, 8);
  int left = wide;
  for (int i = 1; i <= kFarthest && left > 0; ++i) {
    const double x = touch.p[0] + way[0] / length * step * i - soil_.low_x();
    const double y = touch.p[1] + way[1] / length * step * i - soil_.low_y();
    if (x < 0 || y < 0 || x >= soil_.size_x || y >= soil_.size_y) return;
    const int cell = std::min(static_cast<int>(y / soil_.dy), soil_.ny - 1) * soil_.nx +
                     std::min(static_cast<int>(x / soil_.dx), soil_.nx - 1);
    if (contacts_.is_touched(cell)) continue;
    const double share = 2.0 * left / (wide * (wide + 1));
    tracks_.set_height(
        cell, tracks_.height(cell) + static_cast<float>(share * volume / soil_.dx / soil_.dy));
    settle(cell);
    --left;
  }
}

SoilBed::Steep SoilBed::steepest(int cell, Slope slope) const {
  const int i = cell % soil_.nx, j = cell / soil_.nx;
  const double down = slope == Slope::kDown ? 1 : -1;
  Steep most;
  for (int v = std::max(j - 1, 0); v <= std::min(j + 1, soil_.ny - 1); ++v) {
    for (int u = std::max(i - 1, 0); u <= std::min(i + 1, soil_.nx - 1); ++u) {
      const int beside = v * soil_.nx + u;
      if (beside == cell || contacts_.is_touched(beside)) continue;
      const double distance = std::hypot((u - i) * soil_.dx, (v - j) * soil_.dy);
      const double higher = double{tracks_.height(cell)} - double{tracks_.height(beside)};
      const double excess = down * higher - distance * soil_.strength.tan_friction;
      if (excess > most.excess) most = {beside, excess};
    }
  }
  return most.excess < kMinExcess ? Steep{} : most;
}

// Loose soil slides from a cell to its lowest neighbour, and where walls do not stand also into it
// from its highest, and on from there, until it is no steeper than its friction holds; not into
// cells that a body occupies.
void SoilBed::settle(int first) {
  unsettled_.assign(1, first);
  for (int slides = 0; !unsettled_.empty() && slides < kMostSlides;) {
    const int cell = unsettled_.back();
    Steep beside = steepest(cell, Slope::kDown);
    int from = cell, to = beside.cell;
    if (to < 0 && !soil_.strength.walls_stand) {
      beside = steepest(cell, Slope::kUp);
      from = beside.cell, to = cell;
    }
    if (beside.cell < 0) {
      unsettled_.pop_back();
      continue;
    }
    const auto part = static_cast<float>(beside.excess / 2);
    tracks_.set_height(from, tracks_.height(from) - part);
    tracks_.set_height(to, tracks_.height(to) + part);
    unsettled_.push_back(beside.cell);
    ++slides;
  }
}

// Where a body has left a print, nothing holds the walls any longer.
void SoilBed::let_walls_fall() {
  if (soil_.strength.walls_stand || contacts_.round() == round_) return;
  round_ = contacts_.round();
  for (const int cell : held_) {
    if (!contacts_.is_touched(cell)) settle(cell);
  }
  held_.clear();
  for (const SoilTouch& touch : contacts_.touches()) held_.push_back(touch.cell);
}

}  // namespace gloam
