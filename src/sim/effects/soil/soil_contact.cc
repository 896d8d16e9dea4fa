#include "sim/effects/soil/soil_contact.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kLateralTolerance = 0.1;   // over the edge of a cell
constexpr double kSinkageTolerance = 0.05;  // over what it has sunk in

}  // namespace

SoilContacts::SoilContacts(const SoilDescription& soil, const mjModel& m,
                           std::span<const int> geoms)
    : soil_(soil),
      print_of_(static_cast<size_t>(m.ngeom), -1),
      row_(static_cast<size_t>(soil.nx)),
      row_low_(soil.nx),
      row_high_(-1),
      marks_(soil.cells()) {
  size_t touches = 0, all_lines = 0, most_lines = 0, most_samples = 0;
  for (const int geom : geoms) {
    const double across = 2 * m.geom_rbound[geom];
    const auto along = [across](double d, int n) {
      return static_cast<size_t>(std::min(across / d + 2, static_cast<double>(n)));
    };
    const size_t rows = along(soil.dy, soil.ny), columns = along(soil.dx, soil.nx);
    const size_t lines = std::max<size_t>(2 * rows, kContactLines * 2 + kMostContactLines * 2) + 4;
    Footprint& print = prints_.emplace_back();
    print.touches.reserve(rows * columns), print.rise.reserve(rows * columns);
    print.outline.reserve(lines);
    print_of_[static_cast<size_t>(geom)] = static_cast<int>(prints_.size()) - 1;
    touches += rows * columns, all_lines += lines;
    most_lines = std::max(most_lines, lines);
    most_samples = std::max(most_samples, lines * columns);
  }
  touches_.reserve(touches);
  lines_.reserve(all_lines), merged_.reserve(all_lines), hull_.reserve(2 * all_lines);
  for (auto* room : {&ys_, &left_, &right_}) room->reserve(most_lines);
  Samples& s = samples_;
  for (auto* room : {&s.x, &s.y, &s.area, &s.z, &s.slope_x, &s.slope_y})
    room->reserve(most_samples);
  s.cell.reserve(most_samples);
  here_.reserve(geoms.size()), before_.reserve(geoms.size()), patches_.reserve(geoms.size());
}

void SoilContacts::reset() {
  for (Footprint& print : prints_) print.known = false;
  before_.clear(), touches_.clear();
  clear(0);
  ++round_;
}

void SoilContacts::clear(double fallen) {
  fallen_ = fallen;
  here_.clear();
  changed_ = false;
}

void SoilContacts::add(const ColliderBottom& collider) {
  const double low_x = soil_.low_x(), low_y = soil_.low_y();
  if (collider.low(2) >= soil_.level + fallen_ || collider.high(0) <= low_x ||
      collider.high(1) <= low_y || collider.low(0) >= low_x + soil_.size_x ||
      collider.low(1) >= low_y + soil_.size_y)
    return;
  const int row = print_of_[static_cast<size_t>(collider.geom())];
  Footprint& print = prints_[static_cast<size_t>(row)];
  if (!has_stayed(collider, &print)) {
    look(collider, &print);
    changed_ = true;
  }
  if (!print.touches.empty()) here_.push_back(row);
}

// Finds how the underside has risen over each touch since it was looked at: by the motion of its
// points along its normal. Where it is steep, rising moves its edge the less.
bool SoilContacts::has_stayed(const ColliderBottom& collider, Footprint* print) const {
  if (!print->known || print->touches.empty()) return false;
  if (fallen_ - print->fallen > kSinkageTolerance * print->deepest) return false;
  const double *p = collider.position(), *R = collider.rotation(), *q = print->anchor;
  double aside[2];
  for (int a = 0; a < 2; ++a) {
    const double *now = R + 3 * a, *then = print->R + 3 * a;
    aside[a] = p[a] - print->p[a] + (now[0] - then[0]) * q[0] + (now[1] - then[1]) * q[1] +
               (now[2] - then[2]) * q[2];
  }
  const double moved = std::sqrt(aside[0] * aside[0] + aside[1] * aside[1]) +
                       collider.turned(print->R) * print->size;
  if (moved > kLateralTolerance * std::min(soil_.dx, soil_.dy)) return false;
  // A point c of the world then is at p + T (c - p0) now.
  double T[9];
  mju_mulMatMatT(T, R, print->R, 3, 3, 3);
  for (int i = 0; i < 9; i += 4) T[i] -= 1;
  const double shift[3] = {p[0] - print->p[0], p[1] - print->p[1], p[2] - print->p[2]};
  print->rise.clear();
  for (const SoilTouch& touch : print->touches) {
    double c[3], move[3];
    for (int a = 0; a < 3; ++a) c[a] = touch.p[a] - print->p[a];
    for (int a = 0; a < 3; ++a)
      move[a] = shift[a] + T[3 * a] * c[0] + T[3 * a + 1] * c[1] + T[3 * a + 2] * c[2];
    const double rise = move[2] - touch.slope[0] * move[0] - touch.slope[1] * move[1];
    const double steep = 1 + std::abs(touch.slope[0]) + std::abs(touch.slope[1]);
    if (std::abs(rise) > kSinkageTolerance * print->deepest * steep) return false;
    print->rise.push_back(rise);
  }
  return true;
}

void SoilContacts::finish() {
  if (changed_ || here_ != before_) {
    touches_.clear();
    patches_.clear();
    ++round_;
    for (size_t i = 0; i < here_.size(); ++i) join(static_cast<int>(i));
    for (size_t i = 0; i < here_.size(); ++i) add_patch(static_cast<int>(i));
    const double whole = soil_.dx * soil_.dy;
    for (SoilTouch& touch : touches_) {
      // Colliders that overlap share what there is.
      const double covered = double{marks_[static_cast<size_t>(touch.cell)].area};
      if (covered > whole) touch.area *= whole / covered;
    }
    before_ = here_;
  }
  auto touch = touches_.begin();
  for (const int row : here_) {
    const Footprint& print = prints_[static_cast<size_t>(row)];
    for (size_t n = 0; n < print.touches.size(); ++n, ++touch) {
      touch->p[2] = print.touches[n].p[2] + print.rise[n];
      touch->fallen = soil_.share_of(static_cast<size_t>(touch->cell)) * fallen_;
      touch->depth = std::max(print.touches[n].depth - print.rise[n] + touch->fallen, 0.0);
    }
  }
}

}  // namespace gloam
