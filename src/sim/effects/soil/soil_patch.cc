// Grouping of touches into patches of a bed, and the width of each.

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "sim/effects/soil/soil_contact.h"

namespace gloam {

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

// True if a touch before it, of another patch, may have cells around it.
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
    if (hull_.size() == base + 1 && hull_.back().y == c.y) {  // the farther one of two lowest
      if (side * (c.x - hull_.back().x) > 0) hull_.back() = c;
      continue;
    }
    hull_.push_back(c);
  }
}

// Patch of all touches that are joined to it.
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
