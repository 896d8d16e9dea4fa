#include "world/weather/ground_below.h"

#include "world/model_memory.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace gloam {
namespace {

constexpr double kNoGround = -1e10;
constexpr double kSky = 1e4;          // [m]
constexpr double kOverGround = 0.05;  // height of flat things on the ground: carpets, markings [m]
constexpr int kShownGroups = 3;       // groups of geoms, as in MuJoCo's viewers

bool can_be_touched(const mjModel& m, int geom) {
  return m.geom_contype[geom] != 0 || m.geom_conaffinity[geom] != 0;
}
bool shelters(const mjModel& m, int geom) {
  return can_be_touched(m, geom) ||
         (m.geom_group[geom] < kShownGroups && m.geom_rgba[4 * geom + 3] > 0);
}

/// All that stand still over or under an area.
std::vector<int> still_geoms(const mjModel& m, const mjData& d, const GroundArea& area) {
  std::vector<int> geoms;
  const double x = area.low_x + area.size_x / 2, y = area.low_y + area.size_y / 2;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const double* p = d.geom_xpos + 3 * geom;
    const double r = m.geom_rbound[geom];  // 0 = a plane
    const bool far = r > 0 && (std::abs(p[0] - x) > r + area.size_x / 2 ||
                               std::abs(p[1] - y) > r + area.size_y / 2);
    if (m.body_weldid[m.geom_bodyid[geom]] == 0 && !far && shelters(m, geom)) geoms.push_back(geom);
  }
  return geoms;
}

/// z of the highest point of a geom on the line below (x, y, from).
double top_below(const mjModel& m, const mjData& d, int geom, double x, double y, double from) {
  constexpr double kDown[3] = {0, 0, -1};
  const double p[3] = {x, y, from};
  double way = -1;
  if (m.geom_type[geom] == mjGEOM_HFIELD) {
    way = mj_rayHfield(&m, &d, geom, p, kDown, nullptr);
  } else if (m.geom_type[geom] == mjGEOM_MESH || m.geom_type[geom] == mjGEOM_SDF) {
    way = mj_rayMesh(&m, &d, geom, p, kDown, nullptr);
  } else {
    way = mju_rayGeom(d.geom_xpos + 3 * geom, d.geom_xmat + 9 * geom, m.geom_size + 3 * geom, p,
                      kDown, m.geom_type[geom], nullptr);
  }
  return way < 0 ? kNoGround : from - way;
}

}  // namespace

GroundBelow::GroundBelow(const mjModel& m, const GroundArea& area, int nx, int ny, bool sky)
    : nx_(nx), ny_(ny) {
  const DataPtr data = make_data(m);
  mj_kinematics(&m, data.get());
  const std::vector<int> geoms = still_geoms(m, *data, area);
  for (int j = 0; j <= ny_; ++j) {
    for (int i = 0; i <= nx_; ++i) {
      const double x = area.low_x + area.size_x * i / nx_, y = area.low_y + area.size_y * j / ny_;
      double ground = kNoGround;
      for (const int geom : geoms) {
        if (can_be_touched(m, geom))
          ground = std::max(ground, top_below(m, *data, geom, x, y, area.from));
      }
      heights_.push_back(ground);
      if (!sky) continue;
      open_.push_back(std::none_of(geoms.begin(), geoms.end(), [&](int geom) {
        return top_below(m, *data, geom, x, y, kSky) > ground + kOverGround;
      }));
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
