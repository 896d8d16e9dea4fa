#include "places/plan/way_map.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kCell = 0.05;  // [m]
constexpr double kZoneMargin = 0.15;

}  // namespace

WayMap::WayMap(const Rect& room, double radius)
    : room_(room),
      radius_(radius),
      columns_(std::max(1, static_cast<int>(std::ceil(room.width() / kCell)))),
      rows_(std::max(1, static_cast<int>(std::ceil(room.depth() / kCell)))),
      free_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), 0) {
  const Rect inner = room.grown(-radius);
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      const double x = room.x0 + (i + 0.5) * kCell, y = room.y0 + (j + 0.5) * kCell;
      free_[static_cast<size_t>(j * columns_ + i)] =
          x >= inner.x0 && x <= inner.x1 && y >= inner.y0 && y <= inner.y1;
    }
  }
}

int WayMap::column(double x) const {
  return std::clamp(static_cast<int>((x - room_.x0) / kCell), 0, columns_ - 1);
}
int WayMap::row(double y) const {
  return std::clamp(static_cast<int>((y - room_.y0) / kCell), 0, rows_ - 1);
}

void WayMap::paint(const Rect& thing, Cells* free) const {
  const Rect near = thing.grown(radius_);
  if (!near.overlaps(room_)) return;
  for (int j = row(near.y0); j <= row(near.y1); ++j) {
    for (int i = column(near.x0); i <= column(near.x1); ++i) {
      const double x = room_.x0 + (i + 0.5) * kCell, y = room_.y0 + (j + 0.5) * kCell;
      if (thing.distance_to(x, y) < radius_) (*free)[static_cast<size_t>(j * columns_ + i)] = 0;
    }
  }
}

void WayMap::block(const Rect& thing) { paint(thing, &free_); }

bool WayMap::connects(const Rect& thing, const std::vector<Point>& points,
                      const std::vector<Rect>& zones) const {
  if (points.empty()) return true;
  Cells free = free_;
  paint(thing, &free);
  const auto index_of = [&](const Point& p) { return row(p.second) * columns_ + column(p.first); };
  // 2 = seen.
  std::vector<int> open{index_of(points[0])};
  if (!free[static_cast<size_t>(open[0])]) return false;
  free[static_cast<size_t>(open[0])] = 2;
  while (!open.empty()) {
    const int at = open.back(), i = at % columns_;
    open.pop_back();
    const auto visit = [&](int next) {
      if (free[static_cast<size_t>(next)] != 1) return;
      free[static_cast<size_t>(next)] = 2;
      open.push_back(next);
    };
    if (i > 0) visit(at - 1);
    if (i + 1 < columns_) visit(at + 1);
    if (at >= columns_) visit(at - columns_);
    if (at + columns_ < columns_ * rows_) visit(at + columns_);
  }
  for (const Point& point : points)
    if (free[static_cast<size_t>(index_of(point))] != 2) return false;
  return std::all_of(zones.begin(), zones.end(), [&](const Rect& zone) {
    if (zone.width() <= 0) return true;
    const Rect near = zone.grown(kZoneMargin);
    for (int j = row(near.y0); j <= row(near.y1); ++j)
      for (int i = column(near.x0); i <= column(near.x1); ++i)
        if (free[static_cast<size_t>(j * columns_ + i)] == 2) return true;
    return false;
  });
}

}  // namespace gloam
