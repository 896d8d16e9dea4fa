#include "sim/effects/soil_contact.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"

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
  clear();
  ++round_;
}

void SoilContacts::clear() {
  here_.clear();
  changed_ = false;
}

void SoilContacts::add(const ColliderBottom& collider) {
  const double low_x = soil_.low_x(), low_y = soil_.low_y();
  if (collider.low(2) >= soil_.level || collider.high(0) <= low_x || collider.high(1) <= low_y ||
      collider.low(0) >= low_x + soil_.size_x || collider.low(1) >= low_y + soil_.size_y)
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
      touch->depth = std::max(print.touches[n].depth - print.rise[n], 0.0);
    }
  }
}

// Finds those before it that it shares cells with, or whose cells are beside its own.
void SoilContacts::join(int here) {
  Footprint& print = print_at(here);
  print.parent = here;
  bool alone = !may_join(here);
  for (size_t n = 0; n < print.touches.size() && !alone; ++n) {
    const int row = print.touches[n].cell / soil_.nx, i = print.touches[n].cell % soil_.nx;
    for (int v = std::max(row - 1, 0); v <= std::min(row + 1, soil_.ny - 1); ++v) {
      for (int u = std::max(i - 1, 0); u <= std::min(i + 1, soil_.nx - 1); ++u) {
        const Mark& mark = marks_[static_cast<size_t>(v * soil_.nx + u)];
        if (mark.round != round_) continue;
        const int a = root(here), b = root(mark.row);
        if (a == b) continue;
        print_at(std::max(a, b)).parent = std::min(a, b);
        alone = !may_join(here);
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

// Whether there is one before it, of another patch, around which its cells may be.
bool SoilContacts::may_join(int here) const {
  const Footprint& a = print_at(here);
  for (int other = 0; other < here; ++other) {
    const Footprint& b = print_at(other);
    bool near = true;
    for (int axis = 0; axis < 2; ++axis)
      near &= a.low[axis] <= b.high[axis] + 1 && b.low[axis] <= a.high[axis] + 1;
    if (near && root(other) != root(here)) return true;
  }
  return false;
}

int SoilContacts::root(int here) const {
  while (true) {
    const int parent = print_at(here).parent;
    if (parent == here) return here;
    here = parent;
  }
}

// The patch that begins with it, if one does, and all touches of that.
void SoilContacts::add_patch(int here) {
  if (root(here) != here) return;
  const int patch = static_cast<int>(patches_.size());
  size_t first = 0;
  uint64_t number = 0;
  for (int i = 0; i < static_cast<int>(here_.size()); ++i) {
    const Footprint& print = print_at(i);
    if (root(i) == here) {
      number = hash_bytes(&print.number, sizeof(print.number), number);
      for (size_t n = 0; n < print.touches.size(); ++n) touches_[first + n].patch = patch;
    }
    first += print.touches.size();
  }
  Footprint& begin = print_at(here);
  if (begin.patch_number != number) begin.patch = patch_of(here);
  begin.patch_number = number;
  patches_.push_back(begin.patch);
}

// The side of the convex hull of lines at which they end so (Andrew 1979), after what is in hull_.
void SoilContacts::add_chain(std::span<const Line> lines, double Line::* end, double side) {
  const size_t base = hull_.size();
  for (const Line& line : lines) {
    const Point c{line.*end, line.y};
    while (hull_.size() >= base + 2) {
      const Point a = hull_[hull_.size() - 2], b = hull_.back();
      if (side * ((b.y - a.y) * (c.x - a.x) - (b.x - a.x) * (c.y - a.y)) < 0) break;
      hull_.pop_back();
    }
    if (hull_.size() == base + 1 && hull_.back().y == c.y) {  // of two lowest the farther one
      if (side * (c.x - hull_.back().x) > 0) hull_.back() = c;
      continue;
    }
    hull_.push_back(c);
  }
}

// Of all that are joined to it.
SoilContacts::Patch SoilContacts::patch_of(int here) {
  lines_.clear();
  for (int i = here; i < static_cast<int>(here_.size()); ++i) {
    if (root(i) != here) continue;
    const std::vector<Line>& more = print_at(i).outline;
    merged_.resize(lines_.size() + more.size());
    std::merge(lines_.begin(), lines_.end(), more.begin(), more.end(), merged_.begin(),
               [](const Line& a, const Line& b) { return a.y < b.y; });
    lines_.swap(merged_);
  }
  hull_.clear();
  add_chain(lines_, &Line::right, 1);
  const auto right = static_cast<std::ptrdiff_t>(hull_.size());
  add_chain(lines_, &Line::left, -1);
  std::reverse(hull_.begin() + right, hull_.end());  // against the clock
  double area = 0, edge = 0;
  Patch out;
  Point a = hull_.back();
  for (const Point b : hull_) {
    area += (a.x * b.y - a.y * b.x) / 2;
    edge += std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    out.centre[0] += b.x, out.centre[1] += b.y;
    a = b;
  }
  for (double& x : out.centre) x /= static_cast<double>(hull_.size());
  out.width = edge > 0 ? std::max(2 * std::abs(area) / edge, 1e-4) : 1e-4;
  return out;
}

}  // namespace gloam
