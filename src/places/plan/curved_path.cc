#include "places/plan/curved_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kBetween = 1;  // between stations [m]

}  // namespace

CurvedPath::CurvedPath(const Shape& shape, Dice* dice) : length_(shape.length) {
  const double bend = dice->uniform(0.5, 1) / shape.curve * (dice->chance(0.5) ? 1 : -1);
  const double wave = dice->uniform(0.7, 1.4) * 2 * M_PI / std::max(shape.length, 120.0);
  const double origin = shape.length / 4;
  const int before = static_cast<int>(std::ceil((origin + shape.beyond) / kBetween));
  const int after = static_cast<int>(std::ceil((shape.length - origin + shape.beyond) / kBetween));
  std::vector<Station> back;
  for (const int direction : {-1, 1}) {
    double x = 0, y = 0, heading = 0;
    for (int i = 0; i <= (direction < 0 ? before : after); ++i) {
      const double s = direction * i * kBetween;
      (direction < 0 ? back : stations_).push_back({origin + s, x, y, heading});
      const double turn = bend * std::cos(wave * s) * kBetween * direction;
      x += direction * kBetween * std::cos(heading + turn / 2);
      y += direction * kBetween * std::sin(heading + turn / 2);
      heading += turn;
    }
  }
  stations_.insert(stations_.begin(), back.rbegin(), back.rend() - 1);
}

CurvedPath::Station CurvedPath::at(double s) const {
  const double t = std::clamp((s - stations_.front().s) / kBetween, 0.0,
                              static_cast<double>(stations_.size()) - 1.001);
  const auto i = static_cast<size_t>(t);
  const double f = t - static_cast<double>(i);
  const Station &a = stations_[i], &b = stations_[i + 1];
  return {s, a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), a.heading + f * (b.heading - a.heading)};
}

std::vector<CurvedPath::Station> CurvedPath::within(double from, double to, double step) const {
  std::vector<Station> list;
  const int count = std::max(1, static_cast<int>(std::ceil((to - from) / step)));
  for (int i = 0; i <= count; ++i) list.push_back(at(from + (to - from) * i / count));
  return list;
}

Vec3f CurvedPath::point(const Station& k, double left, double z) {
  return {float(k.x - std::sin(k.heading) * left), float(k.y + std::cos(k.heading) * left),
          float(z)};
}

Pose CurvedPath::pose(double s, double left, double z, double turned) const {
  const Station k = at(s);
  // Meshes have single precision: an object stands exactly on them if its height has it, too.
  return {{k.x - std::sin(k.heading) * left, k.y + std::cos(k.heading) * left, float(z)},
          turn({0, 0, 1}, k.heading + turned)};
}

Solid CurvedPath::strip(double from, double to, Vec2f a, Vec2f b) const {
  std::vector<Vec3f> points;
  for (const Station& k : within(from, to)) {
    points.push_back(point(k, a.x, a.y));
    points.push_back(point(k, b.x, b.y));
  }
  return sheet(points, 2);
}

Solid CurvedPath::cable(double from, double to, std::pair<double, double> line, double radius,
                        int segments) const {
  const auto& [left, z] = line;
  Path path;
  for (const Station& k : within(from, to)) path.push_back(point(k, left, z));
  return tube(path, float(radius), segments);
}

void CurvedPath::collide_ground(PropPart* part, float margin) const {
  Vec3f low{1e9f, 1e9f, -0.5f}, high{-1e9f, -1e9f, 0};
  for (const Station& k : stations_) {
    low = {std::min(low.x, float(k.x)), std::min(low.y, float(k.y)), low.z};
    high = {std::max(high.x, float(k.x)), std::max(high.y, float(k.y)), high.z};
  }
  part->collide_box({low.x - margin, low.y - margin, low.z}, {high.x + margin, high.y + margin, 0});
}

std::vector<Region> CurvedPath::regions(const std::string& label, double width,
                                        double height) const {
  std::vector<Region> list;
  const int count = std::max(1, static_cast<int>(std::lround(length_ / 10)));
  for (int i = 0; i < count; ++i) {
    const Station a = at(length_ * i / count), b = at(length_ * (i + 1) / count);
    const double grow = width * 0.25;
    list.push_back({fmt::format("{}_{}", label, i + 1),
                    label,
                    {std::min(a.x, b.x), std::min(a.y, b.y) - grow, 0},
                    {std::max(a.x, b.x), std::max(a.y, b.y) + grow, height}});
  }
  return list;
}

void collide_strip(PropPart* part, const CurvedPath::Station& a, const CurvedPath::Station& b,
                   std::pair<Vec2f, Vec2f> line, double thick) {
  const auto& [p, q] = line;
  const double mx = (a.x + b.x) / 2, my = (a.y + b.y) / 2;
  const double heading = std::atan2(b.y - a.y, b.x - a.x),
               length = std::hypot(b.x - a.x, b.y - a.y);
  const double dy = q.x - p.x, dz = q.y - p.y, wide = std::hypot(dy, dz);
  const double roll = std::atan2(dz, dy);
  // Outwards is to the right of the way from p to q.
  const double left = (p.x + q.x) / 2 + dz / wide * thick / 2,
               z = (p.y + q.y) / 2 - dy / wide * thick / 2;
  const CurvedPath::Station middle{0, mx, my, heading};
  const Quat yaw = turn({0, 0, 1}, heading), r = turn({1, 0, 0}, roll);
  const Quat both{yaw.w * r.w - yaw.z * r.z, yaw.w * r.x - yaw.z * r.y, yaw.w * r.y + yaw.z * r.x,
                  yaw.w * r.z + yaw.z * r.w};
  part->collide_box(CurvedPath::point(middle, left, z),
                    {float(length / 2 + 0.05), float(wide / 2), float(std::abs(thick) / 2)}, both);
}

}  // namespace gloam
