// Where the underside of a collider lies in a bed.

#include <algorithm>
#include <cmath>

#include "sim/effects/soil_contact.h"

namespace gloam {
namespace {

constexpr int kBisections = 5;
constexpr double kGauss = 0.28867513459481287;  // from the middle, over the length
constexpr double kSteepestUnderside = 4;        // slope of an underside that is counted with

}  // namespace

// Lines to a row of cells of edge `d` under a collider of the extent `e`.
int SoilContacts::lines_of(double d, double e) {
  return std::clamp(static_cast<int>(std::ceil(kContactLines * d / e)), 2, kMostContactLines);
}

bool SoilContacts::is_below(const ColliderBottom& collider, double x, double y) const {
  double z;
  if (!collider.height_at(x, y, &z)) return false;
  if (soil_.rest.empty()) return z < soil_.level;
  const int i = std::clamp(static_cast<int>((x - soil_.low_x()) / soil_.dx), 0, soil_.nx - 1);
  const int j = std::clamp(static_cast<int>((y - soil_.low_y()) / soil_.dy), 0, soil_.ny - 1);
  const size_t cell =
      static_cast<size_t>(j) * static_cast<size_t>(soil_.nx) + static_cast<size_t>(i);
  return z < soil_.rest_of(cell) + soil_.share_of(cell) * fallen_;
}

void SoilContacts::look(const ColliderBottom& collider, Footprint* print) {
  print->known = true;
  std::copy_n(collider.position(), 3, print->p);
  std::copy_n(collider.rotation(), 9, print->R);
  print->touches.clear(), print->rise.clear();
  print->deepest = 0;
  print->fallen = fallen_;
  points_.clear();
  const double low_y = soil_.low_y();
  double low[2], high[2];
  collider.box_below(soil_.level + fallen_, low, high);
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
    add_line(collider, line, width, ends);
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

// Each cell at one of the two places of Gauss, lines by turns at the one and the other.
void SoilContacts::add_line(const ColliderBottom& collider, int line, double width,
                            const double* ends) {
  const double low_x = soil_.low_x(), y = soil_.low_y() + (line + 0.5) * width;
  const double side = line % 2 == 0 ? -kGauss : kGauss;
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
    const double x = (from + to) / 2 + side * (to - from), area = (to - from) * width;
    BottomPoint point;
    if (!collider.at(x, y, &point)) continue;  // by a rounding
    sum.area += area;
    sum.p[0] += area * x, sum.p[1] += area * y, sum.p[2] += area * point.z;
    for (int a = 0; a < 2; ++a)
      sum.slope[a] += area * std::clamp(point.slope[a], -kSteepestUnderside, kSteepestUnderside);
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
      const auto cell = static_cast<size_t>(touch.cell);
      touch.depth = soil_.rest_of(cell) - touch.p[2];
      print->deepest = std::max(print->deepest, touch.depth + soil_.share_of(cell) * fallen_);
      print->rise.push_back(0);
    }
    sum = {};
  }
  row_low_ = soil_.nx, row_high_ = -1;
}

}  // namespace gloam
