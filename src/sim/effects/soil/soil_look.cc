// Underside of colliders in a bed.

#include <algorithm>
#include <cmath>

#include "sim/effects/soil/soil_contact.h"

namespace gloam {
namespace {

constexpr int kBisections = 5;
constexpr double kGauss = 0.28867513459481287;  // from the middle, over the length
constexpr double kSteepestUnderside = 4;        // slope of an underside that is counted with
constexpr double kLevel = 1e-6;                 // cells no farther apart are [m]

}  // namespace

// Lines to a row of cells of edge `d` under a collider of the extent `e`.
int SoilContacts::lines_of(double d, double e) {
  return std::clamp(static_cast<int>(std::ceil(kContactLines * d / e)), 2, kMostContactLines);
}

bool SoilContacts::is_below(const ColliderBottom& collider, double x, double y) const {
  double z;
  if (!collider.height_at(x, y, &z)) return false;
  if (soil_.rest.empty()) return z < soil_.level;
  return z < surface_at(column_at(x), row_at(y));
}

int SoilContacts::column_at(double x) const {
  return std::clamp(static_cast<int>((x - soil_.low_x()) / soil_.dx), 0, soil_.nx - 1);
}

int SoilContacts::row_at(double y) const {
  return std::clamp(static_cast<int>((y - soil_.low_y()) / soil_.dy), 0, soil_.ny - 1);
}

double SoilContacts::surface_at(int column, int row) const {
  const size_t cell =
      static_cast<size_t>(row) * static_cast<size_t>(soil_.nx) + static_cast<size_t>(column);
  return soil_.rest_of(cell) + soil_.share_of(cell) * fallen_;
}

// Height of the surface [m], where that is the same in all cells of a box.
std::optional<double> SoilContacts::level_in(const double* low, const double* high) const {
  if (soil_.rest.empty()) return soil_.level;
  const int columns[2] = {column_at(low[0]), column_at(high[0])};
  const int rows[2] = {row_at(low[1]), row_at(high[1])};
  const double level = surface_at(columns[0], rows[0]);
  for (int j = rows[0]; j <= rows[1]; ++j) {
    for (int i = columns[0]; i <= columns[1]; ++i) {
      if (std::abs(surface_at(i, j) - level) > kLevel) return {};
    }
  }
  return level;
}

void SoilContacts::look(const ColliderBottom& collider, Footprint* print) {
  print->known = true;
  print->number = ++looks_;
  std::copy_n(collider.position(), 3, print->p);
  std::copy_n(collider.rotation(), 9, print->R);
  print->touches.clear(), print->rise.clear(), print->outline.clear();
  print->deepest = 0;
  print->fallen = fallen_;
  double low[2], high[2];
  collider.box_below(soil_.level + fallen_, low, high);
  const std::optional<double> level = collider.is_round() ? level_in(low, high) : std::nullopt;
  const int lines = lines_of(soil_.dy, high[1] - low[1]);
  find_lines(collider, level, lines, low, high);
  if (lines_.empty()) return;
  cut_lines(lines);
  sum_cells(collider, print);
  if (print->touches.empty()) return;
  outline(soil_.dy / lines, print);
  const SoilTouch& middle = print->touches[print->touches.size() / 2];
  collider.anchor_of(middle.p, print->anchor);
  double square = 0;
  for (const Line& line : print->outline) {
    const double y = line.y - middle.p[1];
    for (const double x : {line.left - middle.p[0], line.right - middle.p[0]})
      square = std::max(square, x * x + y * y);
  }
  print->size = std::sqrt(square);
}

// Those under the collider, `per_row` to a row of cells, of which something is below the surface.
// `level`: of that, where it is level and the collider round.
void SoilContacts::find_lines(const ColliderBottom& collider, std::optional<double> level,
                              int per_row, const double* low, const double* high) {
  lines_.clear();
  const double low_y = soil_.low_y(), width = soil_.dy / per_row;
  const double low_x = std::max(low[0], soil_.low_x());
  const double high_x = std::min(high[0], soil_.low_x() + soil_.size_x);
  const int first = std::max(static_cast<int>((low[1] - low_y) / width) - 1, 0);
  const int last =
      std::min(static_cast<int>((high[1] - low_y) / width) + 1, per_row * soil_.ny - 1);
  const auto y_of = [=](int line) { return low_y + (line + 0.5) * width; };
  if (level) {
    ys_.clear();
    for (int line = first; line <= last; ++line) ys_.push_back(y_of(line));
    left_.resize(ys_.size()), right_.resize(ys_.size());
    collider.round_ends(*level, ys_, left_.data(), right_.data());
    for (int line = first; line <= last; ++line) {
      const auto n = static_cast<size_t>(line - first);
      const double left = std::max(left_[n], low_x), right = std::min(right_[n], high_x);
      if (left < right) lines_.push_back({ys_[n], left, right, line});
    }
    return;
  }
  const double step = std::min(soil_.dx, (high[0] - low[0]) / kContactLines);
  double ends[2] = {1, 0};  // none yet
  for (int line = first; line <= last; ++line) {
    if (find_ends(collider, y_of(line), low_x, high_x, step, ends)) {
      lines_.push_back({y_of(line), ends[0], ends[1], line});
    } else if (!lines_.empty()) {
      return;
    }
  }
}

// Interval of the line along x at `y` that is below the surface. It is one piece, since colliders
// are convex. `ends`: in: that of the line before, or empty.
bool SoilContacts::find_ends(const ColliderBottom& collider, double y, double low, double high,
                             double step, double* ends) const {
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

// Each line at the edges of cells; what is in a cell is looked at in one of the two places of
// Gauss, lines by turns at the one and the other.
void SoilContacts::cut_lines(int per_row) {
  Samples& s = samples_;
  for (auto* room : {&s.x, &s.y, &s.area}) room->clear();
  s.cell.clear();
  const double low_x = soil_.low_x(), width = soil_.dy / per_row, per_dx = 1 / soil_.dx;
  for (const Line& line : lines_) {
    const double side = line.number % 2 == 0 ? -kGauss : kGauss;
    const int row = line.number / per_row * soil_.nx;
    const auto cell_of = [&](double x) {
      return std::clamp(static_cast<int>((x - low_x) * per_dx), 0, soil_.nx - 1);
    };
    const int last = cell_of(line.right);
    for (int i = cell_of(line.left); i <= last; ++i) {
      const double from = std::max(line.left, low_x + i * soil_.dx);
      const double to = std::min(line.right, low_x + (i + 1) * soil_.dx);
      if (to <= from) continue;
      s.x.push_back((from + to) / 2 + side * (to - from)), s.y.push_back(line.y);
      s.area.push_back((to - from) * width), s.cell.push_back(row + i);
    }
  }
}

// Means over what is covered of each cell.
void SoilContacts::sum_cells(const ColliderBottom& collider, Footprint* print) {
  Samples& s = samples_;
  const size_t count = s.x.size();
  for (auto* room : {&s.z, &s.slope_x, &s.slope_y}) room->resize(count);
  collider.at_each(s.x, s.y.data(), s.z.data(), s.slope_x.data(), s.slope_y.data());
  int row = -1;
  for (size_t n = 0; n < count; ++n) {
    if (s.z[n] >= ColliderBottom::kNoSurface) continue;  // by a rounding
    if (s.cell[n] < row || s.cell[n] >= row + soil_.nx) {
      flush(row, collider, print);
      row = s.cell[n] / soil_.nx * soil_.nx;
    }
    const int i = s.cell[n] - row;
    row_low_ = std::min(row_low_, i), row_high_ = std::max(row_high_, i);
    SoilTouch& sum = row_[static_cast<size_t>(i)];
    const double area = s.area[n];
    const auto bounded = [](double slope) {
      return std::clamp(slope, -kSteepestUnderside, kSteepestUnderside);
    };
    sum.area += area;
    sum.p[0] += area * s.x[n], sum.p[1] += area * s.y[n], sum.p[2] += area * s.z[n];
    sum.slope[0] += area * bounded(s.slope_x[n]), sum.slope[1] += area * bounded(s.slope_y[n]);
  }
  flush(row, collider, print);
}

// A row of cells is complete; `row`: the first of it.
void SoilContacts::flush(int row, const ColliderBottom& collider, Footprint* print) {
  if (row_low_ > row_high_) return;
  const int y = row / soil_.nx;
  const bool first = print->touches.empty();
  print->low[0] = first ? row_low_ : std::min(print->low[0], row_low_);
  print->high[0] = first ? row_high_ : std::max(print->high[0], row_high_);
  print->low[1] = first ? y : print->low[1], print->high[1] = y;
  for (int i = row_low_; i <= row_high_; ++i) {
    SoilTouch& sum = row_[static_cast<size_t>(i)];
    if (sum.area > 0) {
      SoilTouch& touch = print->touches.emplace_back(sum);
      touch.cell = row + i;
      touch.geom = collider.geom(), touch.body = collider.body();
      const double per_area = 1 / touch.area;
      for (double& x : touch.p) x *= per_area;
      for (double& x : touch.slope) x *= per_area;
      const auto cell = static_cast<size_t>(touch.cell);
      touch.depth = soil_.rest_of(cell) - touch.p[2];
      print->deepest = std::max(print->deepest, touch.depth + soil_.share_of(cell) * fallen_);
      print->rise.push_back(0);
    }
    sum = {};
  }
  row_low_ = soil_.nx, row_high_ = -1;
}

// The first and the last line stand for what is half a line further, too.
void SoilContacts::outline(double width, Footprint* print) const {
  const auto beyond = [](const Line& end, const Line& neighbour, double dy) {
    const double left = end.left + (end.left - neighbour.left) / 2;
    const double right = end.right + (end.right - neighbour.right) / 2;
    const double middle = (left + right) / 2;
    return Line{end.y + dy, std::min(left, middle), std::max(right, middle)};
  };
  const size_t n = lines_.size();
  print->outline.push_back(beyond(lines_[0], lines_[n > 1 ? 1 : 0], -width / 2));
  print->outline.insert(print->outline.end(), lines_.begin(), lines_.end());
  print->outline.push_back(beyond(lines_[n - 1], lines_[n > 1 ? n - 2 : 0], width / 2));
}

}  // namespace gloam
