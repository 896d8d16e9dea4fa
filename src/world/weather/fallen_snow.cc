#include "world/weather/fallen_snow.h"

#include <algorithm>
#include <cmath>

#include "world/weather/ground_below.h"

namespace gloam {
namespace {

// Fresh snow is a tenth as dense as water (the meteorologists' 10 to 1).
constexpr double kFreshSnow = 10;
constexpr double kPerSecond = 1e-3 / 3600;  // mm/h as m/s
constexpr double kSnowEdge = 2.5;   // over which a bed thins out to its surroundings, at most [m]
constexpr double kBareEdge = 0.12;  // to what lies bare within it [m]
// Cosines of slopes: of 72 degrees, which holds none, and of 53, which holds all: as
// render/kernel/surface/weathering.h has it of thick snow.
constexpr double kSlidesOff = 0.3, kHolds = 0.6;

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Ground in a cell and its neighbours.
struct Spot {
  double lowest = 1e10;  // [m]
  double hold = 1;       // share that its slope holds, 0 where the sky is not open
};

Spot spot_of(const GroundBelow& ground, const SoilDescription& soil, int i, int j) {
  Spot spot;
  double steepest = 0;
  const int i0 = std::max(i - 1, 0), i1 = std::min(i + 2, soil.nx);
  const int j0 = std::max(j - 1, 0), j1 = std::min(j + 2, soil.ny);
  for (int v = j0; v <= j1; ++v) {
    for (int u = i0; u <= i1; ++u) {
      const double z = ground.height(u, v);
      spot.lowest = std::min(spot.lowest, z);
      if (!ground.is_open(u, v)) spot.hold = 0;
      if (u > i0) steepest = std::max(steepest, std::abs(z - ground.height(u - 1, v)) / soil.dx);
      if (v > j0) steepest = std::max(steepest, std::abs(z - ground.height(u, v - 1)) / soil.dy);
    }
  }
  spot.hold *= smooth(kSlidesOff, kHolds, 1 / std::hypot(1, steepest));
  return spot;
}

/// Way to the nearest cell of share 0, in cells: along rows, columns and diagonals.
std::vector<float> cells_to_bare(const SoilDescription& soil) {
  const int nx = soil.nx, ny = soil.ny;
  std::vector<float> way(soil.cells(), 1e6f);
  const auto at = [&](int i, int j) -> float& {
    return way[static_cast<size_t>(j) * static_cast<size_t>(nx) + static_cast<size_t>(i)];
  };
  const auto visit = [&](int i, int j, int side) {
    float& here = at(i, j);
    for (int k = -1; k <= 1; ++k) {
      if (i + k < 0 || i + k >= nx || j + side < 0 || j + side >= ny) continue;
      here = std::min(here, at(i + k, j + side) + (k == 0 ? 1.0f : 1.4f));
    }
    if (i + side >= 0 && i + side < nx) here = std::min(here, at(i + side, j) + 1);
  };
  for (size_t cell = 0; cell < way.size(); ++cell)
    if (soil.share[cell] <= 0) way[cell] = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) visit(i, j, -1);
  for (int j = ny - 1; j >= 0; --j)
    for (int i = nx - 1; i >= 0; --i) visit(i, j, 1);
  return way;
}

}  // namespace

double snow_growth(const WeatherOptions& weather) {
  return kFreshSnow * weather.snow.value_or(0) * kPerSecond;
}

bool is_fallen_snow(const SoilOptions& soil, const std::optional<WeatherOptions>& weather) {
  return soil.kind == "snow" && soil.over_ground && !soil.depth && weather &&
         (weather->snow || weather->snow_cover);
}

bool lay_fallen_snow(const WeatherOptions& weather, const mjModel& m, double from,
                     SoilDescription* soil) {
  soil->fallen = true;
  soil->depth = weather.snow_cover.value_or(0);
  soil->growth = snow_growth(weather);
  const GroundBelow ground(m, {soil->low_x(), soil->low_y(), soil->size_x, soil->size_y, from},
                           soil->nx, soil->ny, true);
  if (!ground.everywhere()) return false;
  for (int j = 0; j < soil->ny; ++j)
    for (int i = 0; i < soil->nx; ++i)
      soil->share.push_back(static_cast<float>(spot_of(ground, *soil, i, j).hold));
  const std::vector<float> to_bare = cells_to_bare(*soil);
  const double cell_edge = std::min(soil->dx, soil->dy);
  const double wide = std::min(kSnowEdge, std::min(soil->size_x, soil->size_y) / 4);
  soil->level = -1e10;
  for (int j = 0; j < soil->ny; ++j) {
    for (int i = 0; i < soil->nx; ++i) {
      const size_t cell = soil->rest.size();
      const double u = (i + 0.5) / soil->nx, v = (j + 0.5) / soil->ny;
      const double to_edge =
          std::min(std::min(u, 1 - u) * soil->size_x, std::min(v, 1 - v) * soil->size_y);
      const double share = double{soil->share[cell]} *
                           smooth(0, kBareEdge, double{to_bare[cell]} * cell_edge) *
                           smooth(0, wide, to_edge);
      soil->share[cell] = static_cast<float>(share);
      // Bare cells are drawn below all their neighbours: no snow hangs down the side of a crate.
      const double z = share > 0 ? ground.at(u, v) : spot_of(ground, *soil, i, j).lowest;
      soil->rest.push_back(static_cast<float>(z + share * soil->depth));
      soil->level = std::max(soil->level, double{soil->rest.back()});
    }
  }
  return true;
}

}  // namespace gloam
