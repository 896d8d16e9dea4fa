#include "places/plan/room_layout.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kWallGap = 0.02;            // behind furniture, for the skirting [m]
constexpr double kThingGap = 0.02;           // between things
constexpr double kMaxStepOverHeight = 0.03;  // height of things that are walked over: rugs [m]
constexpr double kOverhead = 1.9;            // height of things that are walked under
constexpr double kStep = 0.05;               // step of the search

double along(Side side, const Spot& spot) { return runs_along_x(side) ? spot.x : spot.y; }

// A rectangle before the wall of a side: from … to along it, `depth` into the room.
Rect before(const Rect& room, Side side, double from, double to, double depth) {
  switch (side) {
    case Side::kWest:
      return {room.x0, from, room.x0 + depth, to};
    case Side::kEast:
      return {room.x1 - depth, from, room.x1, to};
    case Side::kSouth:
      return {from, room.y0, to, room.y0 + depth};
    default:
      return {from, room.y1 - depth, to, room.y1};
  }
}

}  // namespace

Pose Spot::pose(double z) const {
  return {{x, y, z}, quarter == 0 ? Quat{} : turn({0, 0, 1}, quarter * M_PI / 2)};
}

Spot against(const Rect& room, Side side, double along, double out) {
  switch (side) {
    case Side::kWest:
      return {room.x0 + out, along, 0};
    case Side::kSouth:
      return {along, room.y0 + out, 1};
    case Side::kEast:
      return {room.x1 - out, along, 2};
    default:
      return {along, room.y1 - out, 3};
  }
}

Spot beside(const Spot& from, double x, double y, int quarters) {
  const double a = from.quarter * M_PI / 2;
  return {from.x + std::cos(a) * x - std::sin(a) * y, from.y + std::sin(a) * x + std::cos(a) * y,
          (from.quarter + quarters) % 4};
}

Rect footprint(const Prop::Box& box, const Spot& spot, double front) {
  const double x0 = box.low.x, y0 = box.low.y, x1 = box.high.x + front, y1 = box.high.y;
  switch (((spot.quarter % 4) + 4) % 4) {
    case 0:
      return {spot.x + x0, spot.y + y0, spot.x + x1, spot.y + y1};
    case 1:
      return {spot.x - y1, spot.y + x0, spot.x - y0, spot.y + x1};
    case 2:
      return {spot.x - x1, spot.y - y1, spot.x - x0, spot.y - y0};
    default:
      return {spot.x + y0, spot.y - x1, spot.x + y1, spot.y - x0};
  }
}

RoomLayout::RoomLayout(const FloorPlan& plan, int room, double way, uint64_t seed, Place* place)
    : dice(seed, plan.rooms[static_cast<size_t>(room)].name),
      room_(plan.rooms[static_cast<size_t>(room)]),
      floor_(plan.floor_of(room_.storey)),
      place_(place),
      ways_(room_.clear, way / 2) {
  for (const Side side : kSides) {
    openings_[static_cast<int>(side)] = plan.openings_of(room, side);
    for (const Opening& o : openings_[static_cast<int>(side)]) {
      if (o.kind == OpeningKind::kWindow) continue;
      const bool swings_here =
          (o.kind == OpeningKind::kDoor && o.b == room) || o.kind == OpeningKind::kEntrance;
      const double depth = swings_here ? o.width + 0.06 : std::max(0.6, way);
      const double beside = swings_here ? 0.07 : 0;
      keep_free_.push_back(before(room_.clear, side, o.low() - beside, o.high() + beside, depth));
      const Rect step = before(room_.clear, side, o.center, o.center, way / 2 + kStep);
      const bool low_side = side == Side::kWest || side == Side::kSouth;
      steps_.emplace_back(runs_along_x(side) ? o.center : (low_side ? step.x1 : step.x0),
                          runs_along_x(side) ? (low_side ? step.y1 : step.y0) : o.center);
    }
  }
}

Side RoomLayout::back_of(const Spot& spot) {
  for (const Side side : kSides)
    if (against({}, side, 0, 0).quarter == spot.quarter) return side;
  return Side::kWest;
}

bool RoomLayout::is_blocked(const Prop::Box& box, const Rect& rect) const {
  for (const Taken& t : taken_)
    if (t.rect.overlaps(rect) && box.low.z < t.high && t.low < box.high.z) return true;
  return false;
}

bool RoomLayout::before_window(const Prop::Box& box, const Spot& spot) const {
  const Side side = back_of(spot);
  const Rect r = footprint(box, spot);
  const double from = runs_along_x(side) ? r.x0 : r.y0, to = runs_along_x(side) ? r.x1 : r.y1;
  for (const Opening& o : openings(side))
    if (o.kind == OpeningKind::kWindow && o.low() < to && from < o.high() &&
        box.high.z > o.sill + 0.02)
      return true;
  return false;
}

bool RoomLayout::fits(const Prop& prop, const Spot& spot, bool overlap_front) const {
  const Prop::Box box = prop.bounds();
  const Rect rect = footprint(box, spot);
  if (!room_.clear.grown(-kWallGap + 1e-4).contains(rect)) return false;
  const bool is_low = box.high.z<kMaxStepOverHeight, is_overhead = box.low.z> kOverhead;
  if (!is_overhead && is_blocked(box, rect.grown(kThingGap - 1e-4))) return false;
  if (is_low || is_overhead) return true;
  for (const Rect& zone : keep_free_)
    if (zone.overlaps(rect)) return false;
  for (const Taken& t : taken_)
    if (t.front.overlaps(rect) && !overlap_front) return false;
  Rect front{};
  if (prop.front > 0) {
    front = footprint(box, spot, prop.front);
    if (!room_.clear.grown(0.01).contains(front)) return false;
    if (!overlap_front && is_blocked({{0, 0, 0.05f}, {0, 0, 1.5f}}, front)) return false;
  }
  return leaves_way(rect, front);
}

bool RoomLayout::leaves_way(const Rect& rect, const Rect& front) const {
  std::vector<Rect> zones{front};
  for (const Taken& t : taken_)
    if (t.front.width() > 0) zones.push_back(t.front);
  return ways_.connects(rect, steps_, zones);
}

std::optional<Spot> RoomLayout::best(std::vector<std::pair<double, Spot>> scored,
                                     const Prop& prop) const {
  constexpr size_t kMaxPlacements = 60;
  std::stable_sort(scored.begin(), scored.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (size_t i = 0, tried = 0; i < scored.size() && tried < kMaxPlacements; ++i) {
    if (scored[i].first < -1000) break;
    // Near misses of one spot tell little: neighbours of what failed are passed over at times.
    if (i > 12 && i % 3 != 0) continue;
    ++tried;
    if (fits(prop, scored[i].second)) return scored[i].second;
  }
  return std::nullopt;
}

std::optional<Spot> RoomLayout::find_at_wall(const Prop& prop, const Score& score) {
  const Prop::Box box = prop.bounds();
  std::vector<std::pair<double, Spot>> scored;
  const Rect room = room_.clear.grown(-kWallGap);
  for (const Side side : kSides) {
    const bool along_x = runs_along_x(side);
    const double half = (box.high.y - box.low.y) / 2;
    const double from = (along_x ? room.x0 : room.y0) + half,
                 to = (along_x ? room.x1 : room.y1) - half;
    const int steps = static_cast<int>((to - from) / kStep);
    for (int i = 0; i <= steps && to >= from; ++i) {
      // Counted from both ends, so that a thing can stand exactly in either corner.
      const int in = i / 2;
      const double a = i % 2 == 0 ? from + in * kStep : to - in * kStep;
      const Spot spot = against(room, side, a, -box.low.x);
      if (box.high.z > 0.9 && before_window(box, spot)) continue;
      scored.emplace_back(score(spot) + dice.uniform(0, 0.05), spot);
    }
  }
  return best(std::move(scored), prop);
}

std::optional<Spot> RoomLayout::find_free(const Prop& prop, const Score& score) {
  std::vector<std::pair<double, Spot>> scored;
  constexpr double kGrid = 0.1;
  for (double x = room_.clear.x0 + kGrid; x < room_.clear.x1; x += kGrid)
    for (double y = room_.clear.y0 + kGrid; y < room_.clear.y1; y += kGrid)
      for (int quarter = 0; quarter < 4; ++quarter) {
        const Spot spot{x, y, quarter};
        scored.emplace_back(score(spot) + dice.uniform(0, 0.05), spot);
      }
  return best(std::move(scored), prop);
}

void RoomLayout::take(const Taken& taken) {
  taken_.push_back(taken);
  if (taken.high > kMaxStepOverHeight && taken.low < kOverhead) ways_.block(taken.rect);
}

int RoomLayout::put(int index, const Spot& spot, bool loose) {
  const Prop& prop = place_->prop(index);
  const Prop::Box box = prop.bounds();
  const Rect rect = footprint(box, spot);
  Rect front{};
  if (prop.front > 0) {
    // Only what lies before it.
    const Rect with = footprint(box, spot, prop.front);
    front = with;
    if (spot.quarter == 0) front.x0 = rect.x1;
    if (spot.quarter == 2) front.x1 = rect.x0;
    if (spot.quarter == 1) front.y0 = rect.y1;
    if (spot.quarter == 3) front.y1 = rect.y0;
  }
  take({rect, box.low.z, box.high.z, front});
  return place_->put(index, room_.name, spot.pose(floor_), loose);
}

int RoomLayout::put_at(int index, const Vec3& position, double yaw, bool loose) {
  return place_->put(index, room_.name, {position, turn({0, 0, 1}, yaw)}, loose);
}

std::optional<Spot> RoomLayout::hang(int index, double height, const Score& score) {
  const Prop::Box box = place_->prop(index).bounds();
  const double half = (box.high.y - box.low.y) / 2, low = height + box.low.z,
               high = height + box.high.z;
  double best_score = -1000;
  std::optional<std::pair<Spot, Side>> chosen;
  for (const Side side : kSides) {
    const bool along_x = runs_along_x(side);
    const double from = (along_x ? room_.clear.x0 : room_.clear.y0) + half + 0.1;
    const double to = (along_x ? room_.clear.x1 : room_.clear.y1) - half - 0.1;
    for (double a = from; a <= to; a += kStep) {
      const Spot spot = against(room_.clear, side, a, 0);
      const auto apart = [&](double b0, double b1, double z0, double z1, double gap) {
        return b1 + gap < a - half || a + half < b0 - gap || z1 + gap < low || high < z0 - gap;
      };
      bool free = true;
      for (const Opening& o : openings(side))
        free = free && apart(o.low() - 0.08, o.high() + 0.08, o.sill, o.head + 0.08, 0.05);
      for (const Hung& h : hung_)
        free = free && (h.side != side || apart(h.from, h.to, h.low, h.high, 0.08));
      const Rect touch = footprint(box, spot).grown(0.03);
      for (const Taken& t : taken_)
        free = free && !(t.rect.overlaps(touch) && t.low < high && low < t.high + 0.05);
      // An open door stands before the wall next to its hinge.
      for (const Rect& zone : keep_free_) free = free && !(zone.overlaps(touch) && low < 2.1);
      const double value = score(spot) + dice.uniform(0, 0.05);
      if (free && value > best_score) best_score = value, chosen = {spot, side};
    }
  }
  if (!chosen) return std::nullopt;
  const auto& [spot, side] = *chosen;
  const double a = along(side, spot);
  hung_.push_back({side, a - half, a + half, low, high});
  take({footprint(box, spot), low, high, {}});
  place_->put(index, room_.name, spot.pose(floor_ + height));
  return spot;
}

bool RoomLayout::hang_at(int index, const Spot& spot, double height) {
  Prop::Box box = place_->prop(index).bounds();
  box.low.z += float(height), box.high.z += float(height);
  const Rect rect = footprint(box, spot);
  if (is_blocked(box, rect.grown(-1e-3))) return false;  // neighbours may touch
  for (const Rect& zone : keep_free_)
    if (zone.overlaps(rect)) return false;
  const Side side = back_of(spot);
  const double a = along(side, spot);
  hung_.push_back({side, a + box.low.y, a + box.high.y, box.low.z, box.high.z});
  take({rect, box.low.z, box.high.z, {}});
  place_->put(index, room_.name, spot.pose(floor_ + height));
  return true;
}

void RoomLayout::scatter(int placement, const std::vector<std::string>& kinds, int most,
                         double loose) {
  const Placement at = place_->placements()[static_cast<size_t>(placement)];
  const double yaw = 2 * std::atan2(at.X_WP.q.z, at.X_WP.q.w), c = std::cos(yaw), s = std::sin(yaw);
  const std::vector<PropSurface> surfaces = place_->prop(at.prop).surfaces;
  for (const PropSurface& surface : surfaces) {
    std::vector<std::array<double, 3>> circles;  // x, y, radius on the surface
    for (int i = 0; i < most; ++i) {
      const Result<int> made =
          place_->make({dice.pick(kinds), static_cast<uint64_t>(dice.integer(0, 5))});
      if (!made.ok()) continue;
      const Prop::Box box = place_->prop(*made).bounds();
      const double radius = 0.5 * std::hypot(box.high.x - box.low.x, box.high.y - box.low.y) + 0.01;
      if (box.high.z > surface.clearance - 0.01) continue;
      for (int tries = 0; tries < 6; ++tries) {
        const double x0 = surface.low.x + radius, x1 = surface.high.x - radius;
        const double y0 = surface.low.y + radius, y1 = surface.high.y - radius;
        if (x0 > x1 || y0 > y1) break;
        const double x = dice.uniform(x0, x1), y = dice.uniform(y0, y1);
        const bool free = std::all_of(circles.begin(), circles.end(), [&](const auto& k) {
          return std::hypot(k[0] - x, k[1] - y) > k[2] + radius;
        });
        if (!free) continue;
        circles.push_back({x, y, radius});
        const bool is_loose = dice.chance(loose);
        put_at(*made,
               {at.X_WP.p.x + c * x - s * y, at.X_WP.p.y + s * x + c * y, at.X_WP.p.z + surface.z},
               yaw + dice.uniform(-0.6, 0.6), is_loose);
        break;
      }
    }
  }
}

double RoomLayout::to_corner(const Spot& spot) const {
  const Rect& r = room_.clear;
  return std::hypot(std::min(spot.x - r.x0, r.x1 - spot.x), std::min(spot.y - r.y0, r.y1 - spot.y));
}

double RoomLayout::to_middle(const Spot& spot) const {
  return runs_along_x(back_of(spot)) ? std::abs(spot.x - room_.clear.x())
                                     : std::abs(spot.y - room_.clear.y());
}

double RoomLayout::to_opening(const Spot& spot) const {
  double nearest = 1e9;
  for (const auto& [x, y] : steps_) nearest = std::min(nearest, std::hypot(x - spot.x, y - spot.y));
  return nearest;
}

double RoomLayout::facing_door(const Spot& spot) const {
  double best = 0;
  const double angle = spot.quarter * M_PI / 2;
  for (const auto& [x, y] : steps_) {
    const double d = std::hypot(x - spot.x, y - spot.y);
    best = std::max(
        best, ((x - spot.x) * std::cos(angle) + (y - spot.y) * std::sin(angle)) / std::max(d, 0.1));
  }
  return best;
}

bool RoomLayout::below_window(const Spot& spot) const {
  for (const Opening& o : openings(back_of(spot)))
    if (o.kind == OpeningKind::kWindow &&
        std::abs(o.center - along(back_of(spot), spot)) < o.width / 2)
      return true;
  return false;
}

}  // namespace gloam
