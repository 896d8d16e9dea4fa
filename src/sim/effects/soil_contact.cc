#include "sim/effects/soil_contact.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr int kContactLines = 12;      // over a collider, at least
constexpr int kMostContactLines = 16;  // to a row of cells
constexpr int kBisections = 5;
constexpr double kGauss = 0.28867513459481287;  // from the middle, over the length
constexpr double kSteepestUnderside = 4;        // slope of an underside that is counted with
constexpr double kMovedAside = 0.1;             // over the edge of a cell
constexpr double kMovedDown = 0.05;             // over what it has sunk in

// Lines to a row of cells of edge `d` under a collider of the extent `e`.
int lines_of(double d, double e) {
  return std::clamp(static_cast<int>(std::ceil(kContactLines * d / e)), 2, kMostContactLines);
}

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

bool SoilContacts::is_below(const ColliderBottom& collider, double x, double y) const {
  double z;
  if (!collider.height_at(x, y, &z)) return false;
  if (soil_.rest.empty()) return z < soil_.level;
  const int i = std::clamp(static_cast<int>((x - soil_.low_x()) / soil_.dx), 0, soil_.nx - 1);
  const int j = std::clamp(static_cast<int>((y - soil_.low_y()) / soil_.dy), 0, soil_.ny - 1);
  return z < double{soil_.rest[static_cast<size_t>(j) * static_cast<size_t>(soil_.nx) +
                               static_cast<size_t>(i)]};
}

void SoilContacts::look(const ColliderBottom& collider, Footprint* print) {
  print->known = true;
  std::copy_n(collider.position(), 3, print->p);
  std::copy_n(collider.rotation(), 9, print->R);
  print->touches.clear(), print->rise.clear();
  print->deepest = 0;
  points_.clear();
  const double low_y = soil_.low_y();
  double low[2], high[2];
  collider.box_below(soil_.level, low, high);
  const double extent_y = high[1] - low[1], extent_x = high[0] - low[0];
  const double low_x = std::max(low[0], soil_.low_x());
  const double high_x = std::min(high[0], soil_.low_x() + soil_.size_x);
  const int lines = lines_of(soil_.dy, extent_y);
  const double width = soil_.dy / lines, step = std::min(soil_.dx, extent_x / kContactLines);
  const int first = std::max(static_cast<int>((low[1] - low_y) / width) - 1, 0);
  const int last = std::min(static_cast<int>((high[1] - low_y) / width) + 1, lines * soil_.ny - 1);
  double ends[2] = {1, 0};  // none yet
  int row = first / lines;
  for (int line = first; line <= last; ++line) {
    if (line / lines != row) {
      flush(row, collider, print);
      row = line / lines;
    }
    const double y = low_y + (line + 0.5) * width;
    if (!find_ends(collider, y, low_x, high_x, step, ends)) {
      if (!points_.empty()) break;
      continue;
    }
    add_line(collider, y, width, ends);
    if (points_.empty()) points_.resize(2);  // room for what comes before
    points_.push_back({ends[0], y});
    points_.push_back({ends[1], y});
  }
  flush(row, collider, print);
  print->hull.clear();
  if (points_.empty()) return;
  // The first and the last line stand for what is half a line further, too.
  const size_t n = points_.size();
  const auto edge = [&](size_t at, size_t neighbour, double dy, size_t to) {
    const Point a = points_[at], b = points_[at + 1];
    const double left = a.x + (a.x - points_[neighbour].x) / 2;
    const double right = b.x + (b.x - points_[neighbour + 1].x) / 2;
    const double middle = (left + right) / 2;
    points_[to] = {std::min(left, middle), a.y + dy};
    points_[to + 1] = {std::max(right, middle), a.y + dy};
  };
  points_.resize(n + 2);
  edge(2, n > 4 ? 4 : 2, -width / 2, 0);
  edge(n - 2, n > 4 ? n - 4 : n - 2, width / 2, n);
  make_hull(&print->hull);
  const SoilTouch& middle = print->touches[print->touches.size() / 2];
  collider.anchor_of(middle.p, print->anchor);
  print->size = 0;
  for (const Point& at : print->hull)
    print->size = std::max(print->size, std::hypot(at.x - middle.p[0], at.y - middle.p[1]));
}

// What of the line along x at `y` is below the surface is one piece, since colliders are convex.
// `ends`: comes in as that of the line before, or empty.
bool SoilContacts::find_ends(const ColliderBottom& collider, double y, double low, double high,
                             double step, double* ends) const {
  if (soil_.rest.empty() && collider.is_ball()) {
    if (!collider.ball_ends(y, soil_.level, ends)) return false;
    ends[0] = std::max(ends[0], low), ends[1] = std::min(ends[1], high);
    return ends[1] > ends[0];
  }
  double inside = std::clamp((ends[0] + ends[1]) / 2, low, high);
  const bool follows = ends[1] > ends[0] && is_below(collider, inside, y);
  if (!follows) {
    const int n = std::max(static_cast<int>(std::ceil((high - low) / step)), 1);
    int i = 0;
    const auto place = [&](int at) { return low + (at + 0.5) * (high - low) / n; };
    while (i < n && !is_below(collider, place(i), y)) ++i;
    if (i == n) return false;
    ends[0] = ends[1] = inside = place(i);
  }
  for (const int side : {0, 1}) {
    const double limit = side == 0 ? low : high, way = side == 0 ? -step : step;
    const auto within = [&](double x) {
      return side == 0 ? std::max(x, limit) : std::min(x, limit);
    };
    double in = within(ends[side]), out = in;
    if (in == inside || is_below(collider, in, y)) {
      while (out != limit) {
        out = within(in + way);
        if (!is_below(collider, out, y)) break;
        in = out;
      }
    } else {
      while (true) {
        in = out - way;
        if ((in - inside) * way <= 0) in = inside;
        if (in == inside || is_below(collider, in, y)) break;
        out = in;
      }
    }
    for (int i = 0; i < kBisections && in != out; ++i) {
      const double middle = (in + out) / 2;
      (is_below(collider, middle, y) ? in : out) = middle;
    }
    ends[side] = (in + out) / 2;
  }
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
void SoilContacts::flush(int row, const ColliderBottom& collider, Footprint* print) {
  for (int i = row_low_; i <= row_high_; ++i) {
    SoilTouch& sum = row_[static_cast<size_t>(i)];
    if (sum.area > 0) {
      SoilTouch& touch = print->touches.emplace_back(sum);
      touch.cell = row * soil_.nx + i;
      touch.geom = collider.geom(), touch.body = collider.body();
      for (double& x : touch.p) x /= touch.area;
      for (double& x : touch.slope) x /= touch.area;
      touch.depth = soil_.rest_of(static_cast<size_t>(touch.cell)) - touch.p[2];
      print->deepest = std::max(print->deepest, touch.depth);
      print->rise.push_back(0);
    }
    sum = {};
  }
  row_low_ = soil_.nx, row_high_ = -1;
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
      touch->depth = std::max(print.touches[n].depth - print.rise[n], 0.0);
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
