#include "world/effects/soil_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/options/weather_fields.h"
#include "world/weather/fallen_snow.h"
#include "world/weather/ground_below.h"

namespace gloam {
namespace {

constexpr double kDefaultCell = 0.02;     // [m]
constexpr double kDefaultDepth = 0.15;    // [m]
constexpr double kDefaultMaxCells = 6e4;  // at most, unless a cell is asked for
constexpr double kMostSoilCells = 5e5;
constexpr double kGroundCell = 0.1;   // between looks for the ground [m]
constexpr double kThinEdge = 0.3;     // over which a bed over ground thins out [m]
constexpr double kLeastDepth = 0.01;  // least depth of it there, over its depth

// Pressure, sinkage and strength: J. Y. Wong, "Theory of Ground Vehicles", table 2.3: dry sand,
// sandy loam (15 % water) by the Land Locomotion Laboratory; clayey soil (38 %), Thailand; lean
// clay (22 %) by the Waterways Experiment Station; snow by Harrison; mud is Hanamoto's sandy loam
// of 32 %. Lunar soil: Heiken et al. 1991, "Lunar Sourcebook", chapter 9.
// Shear displacement: Wong, section 2.4.3: 1 cm firm sand, 2.5 cm loose, 0.6 cm clay, 2.5 cm snow.
// The rise at the sides is our estimate: wet clay and mud keep their volume, snow is compacted.
// Unloading: A_u of LETE sand for mineral soils, of Petawawa's snow A: Wong, table 2.4.
// Walls of prints hold in wet or compacted soil, and on the moon (photographs of bootprints).
constexpr double kSandUnloading = 503e6, kSnowUnloading = 109.6e6;  // [N/m⁴]
struct KindRow {
  double n, k_c, k_phi, cohesion, friction, shear, a_u, aside;
  bool walls_stand = true;
};
constexpr std::array<KindRow, kSoilKinds.size()> kKinds = {{
    {1.1, 0.99e3, 1528.43e3, 1040, 28, 0.025, kSandUnloading, 0.5, false},  // dry_sand
    {0.7, 5.27e3, 1515.04e3, 1720, 29, 0.025, kSandUnloading, 0.4},         // sandy_loam
    {0.5, 13.19e3, 692.15e3, 4140, 13, 0.01, kSandUnloading, 0.8},          // clayey_soil
    {0.2, 16.43e3, 1724.69e3, 68950, 20, 0.006, kSandUnloading, 0.6},       // lean_clay
    {1.6, 4.37e3, 196.72e3, 1030, 19.7, 0.025, kSnowUnloading, 0.05},       // snow
    {0.5, 0.77e3, 51.91e3, 5170, 11, 0.01, kSandUnloading, 0.9},            // mud
    {1.0, 1.4e3, 820e3, 170, 35, 0.018, kSandUnloading, 0.3},               // lunar
}};

Error soil_error(const SoilOptions& o, std::string message, std::string hint) {
  return {ErrorKind::kInput, fmt::format("soil '{}': {}", o.name, message), o.loc, std::move(hint)};
}

SoilStrength strength_of(const SoilOptions& o) {
  SoilStrength s = soil_strength(o.kind);
  s.n = o.n.value_or(s.n);
  s.k_c = o.k_c.value_or(s.k_c);
  s.k_phi = o.k_phi.value_or(s.k_phi);
  s.cohesion = o.cohesion.value_or(s.cohesion);
  if (o.friction) s.tan_friction = std::tan(*o.friction * std::numbers::pi / 180);
  s.shear = o.shear.value_or(s.shear);
  s.k_0 = o.k_0.value_or(s.k_0);
  s.a_u = o.a_u.value_or(s.a_u);
  return s;
}

bool overlap(const SoilDescription& a, const SoilDescription& b) {
  constexpr double kEdgeTolerance = 1e-6;  // tolerance of edges that meet [m]
  return std::abs(a.x - b.x) < (a.size_x + b.size_x) / 2 - kEdgeTolerance &&
         std::abs(a.y - b.y) < (a.size_y + b.size_y) / 2 - kEdgeTolerance &&
         std::abs(a.level - b.level) < std::max(a.depth, b.depth);
}

Error no_ground(const SoilOptions& o) {
  return soil_error(o, "there is no ground below parts of it",
                    "the ground is searched downwards from 'position': raise it, or reduce 'size'");
}

Status lay_fallen(const SoilOptions& o, const WeatherOptions& weather, const mjModel& m,
                  SoilDescription* soil) {
  if (!lay_fallen_snow(weather, m, o.position.z, soil)) return no_ground(o);
  if (std::all_of(soil->share.begin(), soil->share.end(), [](float s) { return s <= 0; })) {
    return soil_error(
        o, "no snow falls on any of it",
        "it is covered: move it, or raise 'position', from which the ground is searched downwards");
  }
  return {};
}

Status lay_over_ground(const SoilOptions& o, const mjModel& m, SoilDescription* soil) {
  const auto along = [](double size, double cell) {
    return std::max(static_cast<int>(size / std::max(kGroundCell, cell)), 1);
  };
  const GroundBelow ground(m,
                           {soil->low_x(), soil->low_y(), soil->size_x, soil->size_y, o.position.z},
                           along(soil->size_x, soil->dx), along(soil->size_y, soil->dy), false);
  if (!ground.everywhere()) return no_ground(o);
  soil->level = -1e10;
  for (int j = 0; j < soil->ny; ++j) {
    for (int i = 0; i < soil->nx; ++i) {
      const double u = (i + 0.5) / soil->nx, v = (j + 0.5) / soil->ny;
      const double to_edge =
          std::min(std::min(u, 1 - u) * soil->size_x, std::min(v, 1 - v) * soil->size_y);
      const double full = std::clamp(to_edge / kThinEdge, kLeastDepth, 1.0);
      const double z = ground.at(u, v) + soil->depth * full;
      soil->share.push_back(static_cast<float>(full));
      soil->rest.push_back(static_cast<float>(z));
      soil->level = std::max(soil->level, z);
    }
  }
  return {};
}

Result<SoilDescription> describe_soil(const SoilOptions& o,
                                      const std::optional<WeatherOptions>& weather,
                                      const mjModel& m) {
  SoilDescription soil;
  soil.name = o.name;
  soil.kind = o.kind;
  soil.x = o.position.x, soil.y = o.position.y, soil.level = o.position.z;
  soil.size_x = o.size[0], soil.size_y = o.size[1], soil.depth = o.depth.value_or(kDefaultDepth);
  soil.loc = o.loc;
  const double usual = std::max(kDefaultCell, std::sqrt(o.size[0] * o.size[1] / kDefaultMaxCells));
  const double cell = o.cell.value_or(usual);
  const auto along = [cell](double edge) { return std::max(std::lround(edge / cell), 2L); };
  const long nx = along(o.size[0]), ny = along(o.size[1]);
  if (static_cast<double>(nx) * static_cast<double>(ny) > kMostSoilCells) {
    return soil_error(o,
                      fmt::format("{} x {} cells exceed the limit of {:g}", nx, ny, kMostSoilCells),
                      fmt::format("use a 'cell' of {:.3g} m",
                                  std::sqrt(o.size[0] * o.size[1] / kMostSoilCells) * 1.01));
  }
  soil.nx = static_cast<int>(nx), soil.ny = static_cast<int>(ny);
  soil.dx = soil.size_x / soil.nx, soil.dy = soil.size_y / soil.ny;
  soil.strength = strength_of(o);
  if (soil.strength.k_c == 0 && soil.strength.k_phi == 0)
    return soil_error(o, "k_c and k_phi are both 0",
                      "at least one must be above 0 for the soil to bear loads");
  if (is_fallen_snow(o, weather)) {
    GLOAM_TRY_STATUS(lay_fallen(o, *weather, m, &soil));
  } else if (o.over_ground) {
    GLOAM_TRY_STATUS(lay_over_ground(o, m, &soil));
  }
  return soil;
}

}  // namespace

SoilStrength soil_strength(const std::string& kind) {
  const auto row = std::find(kSoilKinds.begin(), kSoilKinds.end(), kind) - kSoilKinds.begin();
  const KindRow& k = kKinds[static_cast<size_t>(row)];
  return {k.n,     k.k_c, k.k_phi, k.cohesion, std::tan(k.friction * std::numbers::pi / 180),
          k.shear, 0,     k.a_u,   k.aside,    k.walls_stand};
}

Result<std::vector<SoilDescription>> describe_soils(const Scene& scene, const mjModel& model) {
  std::vector<SoilDescription> soils;
  for (const SoilOptions& o : scene.soils) {
    GLOAM_TRY(SoilDescription soil, describe_soil(o, scene.weather, model));
    for (const SoilDescription& other : soils) {
      if (!overlap(soil, other)) continue;
      return soil_error(o, fmt::format("it overlaps soil '{}'", other.name),
                        "merge them into one bed, or move them apart");
    }
    soils.push_back(std::move(soil));
  }
  return soils;
}

}  // namespace gloam
