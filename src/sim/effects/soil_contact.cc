#include "sim/effects/soil_contact.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr int kContactLines = 16;      // over a collider, at least
constexpr int kMostContactLines = 16;  // to a row of cells
constexpr int kBisections = 8;
constexpr double kGauss = 0.28867513459481287;  // from the middle, over the length
constexpr double kSteepestUnderside = 4;        // slope of an underside that is counted with

// Lines to a row of cells of edge `d` under a collider of the extent `e`.
int lines_of(double d, double e) {
  return std::clamp(static_cast<int>(std::ceil(kContactLines * d / e)), 2, kMostContactLines);
}

}  // namespace

SoilContacts::SoilContacts(const SoilDescription& soil, const mjModel& m,
                           std::span<const int> geoms)
    : soil_(soil),
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
    const size_t rows = along(soil.dy, soil.ny);
    touches += along(soil.dx, soil.nx) * rows;
    points += 2 * (std::max<size_t>(2 * rows, kContactLines * 2 + kMostContactLines * 2) + 2);
  }
  touches_.reserve(touches);
  points_.reserve(points), sorted_.reserve(points), hull_.reserve(points + 1);
  outlines_.reserve(geoms.size());
  widths_.reserve(geoms.size()), centres_.reserve(2 * geoms.size());
  patch_of_.resize(geoms.size());
}

void SoilContacts::clear() {
  touches_.clear();
  outlines_.clear();
  points_.clear();
  widths_.clear(), centres_.clear();
  ++round_;
}

bool SoilContacts::is_below(const ColliderBottom& collider, double x, double y,
                            BottomPoint* out) const {
  if (!collider.at(x, y, out)) return false;
  if (soil_.rest.empty()) return out->z < soil_.level;
  const int i = std::clamp(static_cast<int>((x - soil_.low_x()) / soil_.dx), 0, soil_.nx - 1);
  const int j = std::clamp(static_cast<int>((y - soil_.low_y()) / soil_.dy), 0, soil_.ny - 1);
  return out->z < double{soil_.rest[static_cast<size_t>(j) * static_cast<size_t>(soil_.nx) +
                                    static_cast<size_t>(i)]};
}

void SoilContacts::add(const ColliderBottom& collider) {
  const double low_x = soil_.low_x(), low_y = soil_.low_y();
  if (collider.low(2) >= soil_.level || collider.high(0) <= low_x || collider.high(1) <= low_y ||
      collider.low(0) >= low_x + soil_.size_x || collider.low(1) >= low_y + soil_.size_y)
    return;
  const double extent_y = collider.high(1) - collider.low(1);
  const double extent_x = collider.high(0) - collider.low(0);
  const int lines = lines_of(soil_.dy, extent_y);
  const double width = soil_.dy / lines, step = std::min(soil_.dx, extent_x / kContactLines);
  const int first = std::max(static_cast<int>((collider.low(1) - low_y) / width) - 1, 0);
  const int last =
      std::min(static_cast<int>((collider.high(1) - low_y) / width) + 1, lines * soil_.ny - 1);
  Outline outline{points_.size(), 0, static_cast<int>(outlines_.size())};
  outlines_.push_back(outline);
  double ends[2];
  int row = first / lines;
  bool began = false;
  for (int line = first; line <= last; ++line) {
    if (line / lines != row) {
      flush(row, collider, outline.parent);
      row = line / lines;
    }
    const double y = low_y + (line + 0.5) * width;
    if (!find_ends(collider, y, step, ends)) {
      if (began) break;
      continue;
    }
    add_line(collider, y, width, ends);
    points_.push_back({ends[0], y});
    points_.push_back({ends[1], y});
    began = true;
  }
  flush(row, collider, outline.parent);
  if (!began) {
    outlines_.pop_back();
    return;
  }
  // The first and the last line stand for what is half a line further, too.
  const size_t end = points_.size() - 2;
  const size_t next = end > outline.first ? 2 : 0;
  add_edge(outline.first, outline.first + next, -width / 2);
  add_edge(end, end - next, width / 2);
  outlines_.back().count = points_.size() - outline.first;
}

// Goes on from the ends of the line at points_[line], as from those of its neighbour to there.
void SoilContacts::add_edge(size_t line, size_t neighbour, double dy) {
  const double left = points_[line].x + (points_[line].x - points_[neighbour].x) / 2;
  const double right = points_[line + 1].x + (points_[line + 1].x - points_[neighbour + 1].x) / 2;
  if (right < left) return;
  const double y = points_[line].y + dy;
  points_.push_back({left, y});
  points_.push_back({right, y});
}

// What of the line along x at `y` is below the surface is one piece, since colliders are convex.
bool SoilContacts::find_ends(const ColliderBottom& collider, double y, double step,
                             double* ends) const {
  const double low = std::max(collider.low(0), soil_.low_x());
  const double high = std::min(collider.high(0), soil_.low_x() + soil_.size_x);
  const int n = std::max(static_cast<int>(std::ceil((high - low) / step)), 1);
  const double d = (high - low) / n;
  BottomPoint point;
  const auto place = [&](int i) { return low + (i + 0.5) * d; };
  int a = 0, b = n - 1;
  while (a < n && !is_below(collider, place(a), y, &point)) ++a;
  if (a == n) return false;
  while (b > a && !is_below(collider, place(b), y, &point)) --b;
  const auto bisect = [&](double in, double out) {
    for (int i = 0; i < kBisections; ++i) {
      const double middle = (in + out) / 2;
      (is_below(collider, middle, y, &point) ? in : out) = middle;
    }
    return (in + out) / 2;
  };
  ends[0] = bisect(place(a), std::max(place(a) - d, low));
  ends[1] = bisect(place(b), std::min(place(b) + d, high));
  return ends[1] > ends[0];
}

void SoilContacts::add_line(const ColliderBottom& collider, double y, double width,
                            const double* ends) {
  const double low_x = soil_.low_x();
  const auto cell_of = [&](double x) {
    return std::clamp(static_cast<int>((x - low_x) / soil_.dx), 0, soil_.nx - 1);
  };
  const int i0 = cell_of(ends[0]), i1 = cell_of(ends[1]);
  row_low_ = std::min(row_low_, i0), row_high_ = std::max(row_high_, i1);
  for (int i = i0; i <= i1; ++i) {
    const double from = std::max(ends[0], low_x + i * soil_.dx);
    const double to = std::min(ends[1], low_x + (i + 1) * soil_.dx);
    if (to <= from) continue;
    SoilTouch& sum = row_[static_cast<size_t>(i)];
    for (const double side : {-kGauss, kGauss}) {
      const double x = (from + to) / 2 + side * (to - from), area = (to - from) * width / 2;
      BottomPoint point;
      if (!collider.at(x, y, &point)) continue;  // by a rounding
      sum.area += area;
      sum.p[0] += area * x, sum.p[1] += area * y, sum.p[2] += area * point.z;
      for (int a = 0; a < 2; ++a)
        sum.slope[a] += area * std::clamp(point.slope[a], -kSteepestUnderside, kSteepestUnderside);
    }
  }
}

// A row of cells is complete.
void SoilContacts::flush(int row, const ColliderBottom& collider, int outline) {
  for (int i = row_low_; i <= row_high_; ++i) {
    SoilTouch& sum = row_[static_cast<size_t>(i)];
    if (sum.area > 0) {
      SoilTouch touch = sum;
      touch.cell = row * soil_.nx + i;
      touch.geom = collider.geom(), touch.body = collider.body();
      touch.patch = outline;
      for (double& x : touch.p) x /= touch.area;
      for (double& x : touch.slope) x /= touch.area;
      const auto cell = static_cast<size_t>(touch.cell);
      touch.depth = std::max(soil_.rest_of(cell) - touch.p[2], 0.0);
      touches_.push_back(touch);
      for (int v = std::max(row - 1, 0); v <= std::min(row + 1, soil_.ny - 1); ++v) {
        for (int u = std::max(i - 1, 0); u <= std::min(i + 1, soil_.nx - 1); ++u) {
          const Mark& mark = marks_[static_cast<size_t>(v) * static_cast<size_t>(soil_.nx) +
                                    static_cast<size_t>(u)];
          if (mark.round != round_) continue;
          const int a = root(outline), b = root(mark.outline);
          outlines_[static_cast<size_t>(std::max(a, b))].parent = std::min(a, b);
        }
      }
      Mark& mark = marks_[cell];
      if (mark.round != round_) mark = {round_, outline, 0};
      mark.area += static_cast<float>(touch.area);
    }
    sum = {};
  }
  row_low_ = soil_.nx, row_high_ = -1;
}

int SoilContacts::root(int outline) {
  while (outlines_[static_cast<size_t>(outline)].parent != outline)
    outline = outlines_[static_cast<size_t>(outline)].parent;
  return outline;
}

void SoilContacts::finish() {
  for (size_t i = 0; i < outlines_.size(); ++i) {
    const int top = root(static_cast<int>(i));
    if (top == static_cast<int>(i)) {
      patch_of_[i] = static_cast<int>(widths_.size());
      widths_.push_back(width_of(top));
      double middle[2] = {};
      for (const Point& p : hull_) {
        middle[0] += p.x / static_cast<double>(hull_.size());
        middle[1] += p.y / static_cast<double>(hull_.size());
      }
      centres_.insert(centres_.end(), {middle[0], middle[1]});
    } else {
      patch_of_[i] = patch_of_[static_cast<size_t>(top)];
    }
  }
  const double whole = soil_.dx * soil_.dy;
  for (SoilTouch& touch : touches_) {
    touch.patch = patch_of_[static_cast<size_t>(touch.patch)];
    // Colliders that overlap share what there is.
    const double covered = double{marks_[static_cast<size_t>(touch.cell)].area};
    if (covered > whole) touch.area *= whole / covered;
  }
}

// By the convex hull of the outlines of a patch (Andrew 1979).
double SoilContacts::width_of(int patch) {
  sorted_.clear();
  for (size_t i = 0; i < outlines_.size(); ++i) {
    if (root(static_cast<int>(i)) != patch) continue;
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(outlines_[i].first);
    sorted_.insert(sorted_.end(), first, first + static_cast<std::ptrdiff_t>(outlines_[i].count));
  }
  std::sort(sorted_.begin(), sorted_.end());
  const auto turn = [](Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  hull_.clear();
  const auto walk = [&](auto begin, auto end) {
    const size_t base = hull_.size();
    for (auto p = begin; p != end; ++p) {
      while (hull_.size() >= base + 2 && turn(hull_[hull_.size() - 2], hull_.back(), *p) <= 0)
        hull_.pop_back();
      hull_.push_back(*p);
    }
    hull_.pop_back();  // begins the other half
  };
  walk(sorted_.begin(), sorted_.end());
  walk(sorted_.rbegin(), sorted_.rend());
  double area = 0, edge = 0;
  for (size_t i = 0; i < hull_.size(); ++i) {
    const Point a = hull_[i], b = hull_[i + 1 < hull_.size() ? i + 1 : 0];
    area += (a.x * b.y - a.y * b.x) / 2;
    edge += std::hypot(b.x - a.x, b.y - a.y);
  }
  return edge > 0 ? std::max(2 * area / edge, 1e-4) : 1e-4;
}

}  // namespace gloam
