#include "sim/effects/soil_contact.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kMovedAside = 0.1;  // over the edge of a cell
constexpr double kMovedDown = 0.05;  // over what it has sunk in

}  // namespace

SoilContacts::SoilContacts(const SoilDescription& soil, const mjModel& m,
                           std::span<const int> geoms)
    : soil_(soil),
      print_of_(static_cast<size_t>(m.ngeom), -1),
      row_(static_cast<size_t>(soil.nx)),
      row_low_(soil.nx),
      row_high_(-1),
      marks_(soil.cells()) {
  size_t touches = 0, points = 0;
  for (const int geom : geoms) {
    const double across = 2 * m.geom_rbound[geom];
    const auto along = [across](double d, int n) {
      return static_cast<size_t>(std::min(across / d + 2, static_cast<double>(n)));
    };
    const size_t rows = along(soil.dy, soil.ny), cells = along(soil.dx, soil.nx) * rows;
    const size_t lines = std::max<size_t>(2 * rows, kContactLines * 2 + kMostContactLines * 2) + 2;
    Footprint& print = prints_.emplace_back();
    print.touches.reserve(cells), print.rise.reserve(cells), print.hull.reserve(2 * lines + 1);
    print_of_[static_cast<size_t>(geom)] = static_cast<int>(prints_.size()) - 1;
    touches += cells, points += 2 * lines;
  }
  touches_.reserve(touches);
  points_.reserve(points), hull_.reserve(points + 1);
  here_.reserve(geoms.size()), before_.reserve(geoms.size());
  widths_.reserve(geoms.size()), centres_.reserve(2 * geoms.size());
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
  if (fallen_ - print->fallen > kMovedDown * print->deepest) return false;
  const double *p = collider.position(), *R = collider.rotation(), *q = print->anchor;
  double aside[2];
  for (int a = 0; a < 2; ++a) {
    const double *now = R + 3 * a, *then = print->R + 3 * a;
    aside[a] = p[a] - print->p[a] + (now[0] - then[0]) * q[0] + (now[1] - then[1]) * q[1] +
               (now[2] - then[2]) * q[2];
  }
  const double moved = std::sqrt(aside[0] * aside[0] + aside[1] * aside[1]) +
                       collider.turned(print->R) * print->size;
  if (moved > kMovedAside * std::min(soil_.dx, soil_.dy)) return false;
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
    if (std::abs(rise) > kMovedDown * print->deepest * steep) return false;
    print->rise.push_back(rise);
  }
  return true;
}

void SoilContacts::finish() {
  if (changed_ || here_ != before_) {
    touches_.clear();
    widths_.clear(), centres_.clear();
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

// Finds those before it that it shares cells with, or whose cells are beside its own.
void SoilContacts::join(int here) {
  Footprint& print = prints_[static_cast<size_t>(here_[static_cast<size_t>(here)])];
  print.parent = here;
  const auto nx = static_cast<size_t>(soil_.nx);
  for (const SoilTouch& touch : print.touches) {
    const int row = touch.cell / soil_.nx, i = touch.cell % soil_.nx;
    for (int v = std::max(row - 1, 0); v <= std::min(row + 1, soil_.ny - 1); ++v) {
      for (int u = std::max(i - 1, 0); u <= std::min(i + 1, soil_.nx - 1); ++u) {
        const Mark& mark = marks_[static_cast<size_t>(v) * nx + static_cast<size_t>(u)];
        if (mark.round != round_ || mark.row == here) continue;
        const int a = root(here), b = root(mark.row);
        prints_[static_cast<size_t>(here_[static_cast<size_t>(std::max(a, b))])].parent =
            std::min(a, b);
      }
    }
  }
  for (const SoilTouch& touch : print.touches) {
    Mark& mark = marks_[static_cast<size_t>(touch.cell)];
    if (mark.round != round_) mark = {round_, here, 0};
    mark.area += static_cast<float>(touch.area);
  }
  touches_.insert(touches_.end(), print.touches.begin(), print.touches.end());
}

int SoilContacts::root(int here) const {
  while (true) {
    const int parent = prints_[static_cast<size_t>(here_[static_cast<size_t>(here)])].parent;
    if (parent == here) return here;
    here = parent;
  }
}

// The patch that begins with it, if one does, and all touches of that.
void SoilContacts::add_patch(int here) {
  if (root(here) != here) return;
  const Footprint* only = &prints_[static_cast<size_t>(here_[static_cast<size_t>(here)])];
  const int patch = static_cast<int>(widths_.size());
  points_.clear();
  size_t first = 0;
  int members = 0;
  for (size_t i = 0; i < here_.size(); ++i) {
    const Footprint& print = prints_[static_cast<size_t>(here_[i])];
    if (root(static_cast<int>(i)) == here) {
      ++members;
      points_.insert(points_.end(), print.hull.begin(), print.hull.end());
      for (size_t n = 0; n < print.touches.size(); ++n) touches_[first + n].patch = patch;
    }
    first += print.touches.size();
  }
  std::span<const Point> hull = only->hull;
  if (members > 1) {
    std::sort(points_.begin(), points_.end(),
              [](Point a, Point b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    make_hull(&hull_);
    hull = hull_;
  }
  double area = 0, edge = 0, middle[2] = {};
  for (size_t i = 0; i < hull.size(); ++i) {
    const Point a = hull[i], b = hull[i + 1 < hull.size() ? i + 1 : 0];
    area += (a.x * b.y - a.y * b.x) / 2;
    edge += std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    middle[0] += a.x / static_cast<double>(hull.size());
    middle[1] += a.y / static_cast<double>(hull.size());
  }
  widths_.push_back(edge > 0 ? std::max(2 * std::abs(area) / edge, 1e-4) : 1e-4);
  centres_.insert(centres_.end(), {middle[0], middle[1]});
}

// The convex hull of points_, which are in order of y, then x (Andrew 1979).
void SoilContacts::make_hull(std::vector<Point>* hull) {
  const auto turn = [](Point a, Point b, Point c) {
    return (b.y - a.y) * (c.x - a.x) - (b.x - a.x) * (c.y - a.y);
  };
  hull->clear();
  const auto walk = [&](auto begin, auto end) {
    const size_t base = hull->size();
    for (auto p = begin; p != end; ++p) {
      while (hull->size() >= base + 2 && turn((*hull)[hull->size() - 2], hull->back(), *p) <= 0)
        hull->pop_back();
      hull->push_back(*p);
    }
    hull->pop_back();  // begins the other half
  };
  walk(points_.begin(), points_.end());
  walk(points_.rbegin(), points_.rend());
}

}  // namespace gloam
