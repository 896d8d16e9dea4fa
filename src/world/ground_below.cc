#include "world/ground_below.h"

#include <algorithm>
#include <memory>

namespace gloam {
namespace {

constexpr double kNoGround = -1e10;
constexpr double kSky = 1e4;          // [m]
constexpr double kOverGround = 0.05;  // that what lies on it may reach: carpets, markings [m]
constexpr int kShownGroups = 3;       // of geoms, as MuJoCo's viewers have it

bool can_be_touched(const mjModel& m, int geom) {
  return m.geom_contype[geom] != 0 || m.geom_conaffinity[geom] != 0;
}

/// z of the highest of what stands still and is of interest, below (x, y, from).
template <class Counts>
double highest_below(const mjModel& m, const mjData& d, double x, double y, double from,
                     const Counts& counts) {
  constexpr double kDown[3] = {0, 0, -1};
  constexpr int kMostLayers = 32;  // of what a ray passes through
  for (int i = 0; i < kMostLayers; ++i) {
    const double p[3] = {x, y, from};
    int geom = -1;
    const double distance = mj_ray(&m, &d, p, kDown, nullptr, 1, -1, &geom, nullptr);
    if (geom < 0) return kNoGround;
    from -= distance;
    if (m.body_weldid[m.geom_bodyid[geom]] == 0 && counts(geom)) return from;
    from -= 1e-6;
  }
  return kNoGround;
}

}  // namespace

GroundBelow::GroundBelow(const mjModel& m, const GroundArea& area, int nx, int ny, bool sky)
    : nx_(nx), ny_(ny) {
  const std::unique_ptr<mjData, void (*)(mjData*)> data{mj_makeData(&m), mj_deleteData};
  mj_kinematics(&m, data.get());
  const auto is_felt = [&m](int geom) { return can_be_touched(m, geom); };
  const auto shelters = [&m](int geom) {
    return can_be_touched(m, geom) ||
           (m.geom_group[geom] < kShownGroups && m.geom_rgba[4 * geom + 3] > 0);
  };
  for (int j = 0; j <= ny_; ++j) {
    for (int i = 0; i <= nx_; ++i) {
      const double x = area.low_x + area.size_x * i / nx_, y = area.low_y + area.size_y * j / ny_;
      heights_.push_back(highest_below(m, *data, x, y, area.from, is_felt));
      if (!sky) continue;
      open_.push_back(highest_below(m, *data, x, y, kSky, shelters) <=
                      heights_.back() + kOverGround);
    }
  }
}

bool GroundBelow::everywhere() const {
  return std::all_of(heights_.begin(), heights_.end(), [](double z) { return z > kNoGround; });
}

double GroundBelow::at(double u, double v) const {
  const double x = std::clamp(u * nx_, 0.0, nx_ - 1e-9), y = std::clamp(v * ny_, 0.0, ny_ - 1e-9);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double fx = x - i, fy = y - j;
  return (height(i, j) * (1 - fx) + height(i + 1, j) * fx) * (1 - fy) +
         (height(i, j + 1) * (1 - fx) + height(i + 1, j + 1) * fx) * fy;
}

}  // namespace gloam
