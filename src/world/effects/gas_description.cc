#include "world/effects/gas_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "geometry/mesh/single.h"
#include "scene/options/effect_fields.h"
#include "world/compile/level.h"
#include "world/effects/rotor_dust_description.h"
#include "world/media/flame.h"
#include "world/media/medium_presets.h"
#include "world/shapes/extent.h"
#include "world/shapes/visual_pose.h"
#include "world/world.h"

namespace gloam {
namespace {

// Chemical heat of combustion, soot yield and radiative fraction in well-ventilated fires: SFPE
// Handbook of Fire Protection Engineering, 5th ed., table A.39 (Tewarson). Polyurethane is the
// flexible foam GM23, wood red oak. Order of kFuels.
constexpr FuelDescription kFuelTable[] = {{43.7e6f, 0.024f, 0.29f}, {41.2e6f, 0.037f, 0.33f},
                                          {12.4e6f, 0.015f, 0.37f}, {24.2e6f, 0.022f, 0.31f},
                                          {19.0e6f, 0.227f, 0.46f}, {27.0e6f, 0.164f, 0.59f}};
static_assert(std::size(kFuelTable) == kFuels.size());

// NFPA 72, annex B, and NFPA 92: alpha of t² fires [W/s²]. Order of kFireGrowths.
constexpr float kGrowthTable[] = {0, 2.93f, 11.72f, 46.9f, 187.6f};
static_assert(std::size(kGrowthTable) == kFireGrowths.size());

constexpr double kDefaultVoxel = 0.1;  // [m]
// Voxels of a box without a given size of voxels: 30 ms a step
constexpr double kDefaultVoxelCount = 250e3;
constexpr double kMostVoxels = 1 << 27;      // 16 GB
constexpr Vec3 kDefaultGasSize = {8, 8, 4};  // [m]
constexpr double kWall = 0.3;                // beyond the rooms of a generated place [m]

template <size_t N>
size_t row_of(const std::array<std::string_view, N>& words, const std::string& word) {
  return static_cast<size_t>(std::find(words.begin(), words.end(), word) - words.begin());
}

/// Box of a gas whose scene gives none: the rooms of a generated place, else around the sources of
/// smoke or dust, from half a metre below the lowest source, or dusty ground, up.
Extent usual_extent(const CompiledWorld& world, const std::vector<GasSourceDescription>& sources,
                    const std::vector<DustDescription>& dusts, const std::vector<Affine3f>& X_WB) {
  if (!world.regions.empty()) return extent_of(world.regions, kWall);
  Extent at;
  for (const GasSourceDescription& source : sources) {
    const Vec3f p = transform_point(X_WB[static_cast<size_t>(source.body)], source.X_BS.p);
    at.add({p.x, p.y, p.z});
  }
  for (const DustDescription& dust : dusts) {
    if (!std::isfinite(dust.low.x)) continue;
    const Vec3f p = (dust.low + dust.high) * 0.5f;
    at.add({p.x, p.y, p.z + 0.5});
  }
  if (!std::isfinite(at.low.x)) at.add({0, 0, 0.5});
  const Vec3 c = at.middle();
  Extent extent;
  extent.add({std::min(at.low.x, c.x - kDefaultGasSize.x / 2),
              std::min(at.low.y, c.y - kDefaultGasSize.y / 2), at.low.z - 0.5});
  extent.add({std::max(at.high.x, c.x + kDefaultGasSize.x / 2),
              std::max(at.high.y, c.y + kDefaultGasSize.y / 2),
              std::max(at.high.z, at.low.z - 0.5 + kDefaultGasSize.z)});
  return extent;
}

Error gas_error(const GasOptions& options, std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, fmt::format("gas '{}': {}", options.name, message), options.loc,
          std::move(hint)};
}

Status set_grid(const GasOptions& options, const Extent& extent, GasDescription* gas) {
  const Vec3 edges{extent.high.x - extent.low.x, extent.high.y - extent.low.y,
                   extent.high.z - extent.low.z};
  const double least = std::cbrt(edges.x * edges.y * edges.z / kDefaultVoxelCount);
  const double voxel = options.voxel.value_or(std::max(kDefaultVoxel, least));
  const auto along = [&](double edge) { return std::max(std::ceil(edge / voxel - 1e-6), 4.0); };
  const double nx = along(edges.x), ny = along(edges.y), nz = along(edges.z);
  if (!(nx * ny * nz <= kMostVoxels) || std::max({nx, ny, nz}) > 1024) {
    return gas_error(options,
                     fmt::format("{:.0f} x {:.0f} x {:.0f} voxels of {:g} m are too many; the "
                                 "limit is 1024 along an edge and 134 million in total",
                                 nx, ny, nz, voxel),
                     "use a larger 'voxel' or a smaller 'size'");
  }
  gas->voxel = static_cast<float>(voxel);
  gas->nx = static_cast<int>(nx), gas->ny = static_cast<int>(ny), gas->nz = static_cast<int>(nz);
  // Rounding to whole voxels grows opposite sides alike, but the floor stays where it is.
  gas->low = {static_cast<float>(extent.low.x - (nx * voxel - edges.x) / 2),
              static_cast<float>(extent.low.y - (ny * voxel - edges.y) / 2),
              static_cast<float>(extent.low.z)};
  return {};
}

Result<GasDescription> describe_gas(const GasOptions& options, const Extent& extent) {
  GasDescription gas;
  gas.name = options.name;
  gas.rate = options.rate;
  gas.loc = options.loc;
  const MediumDescription* preset = find_medium(options.medium);
  if (preset == nullptr) {
    return gas_error(options, fmt::format("there is no medium '{}'", options.medium),
                     suggest_name(options.medium, medium_names()));
  }
  gas.medium = *preset;
  gas.fuel = kFuelTable[row_of(kFuels, options.fuel)];
  gas.temperature = static_cast<float>(options.temperature);
  if (options.wind) gas.wind = to_vec3f(*options.wind);
  for (size_t i = 0; i < kBoxSides.size(); ++i) {
    gas.open[i] = std::find(options.closed.begin(), options.closed.end(), kBoxSides[i]) ==
                  options.closed.end();
  }
  gas.vorticity = static_cast<float>(options.vorticity);
  gas.cooling = static_cast<float>(options.cooling);
  gas.settling = static_cast<float>(options.settling);
  GLOAM_TRY_STATUS(set_grid(options, extent, &gas));
  return gas;
}

/// Fires and smoke have this in common.
template <class Options>
Result<GasSourceDescription> describe_source(const Options& options, const char* kind,
                                             const CompiledWorld& world) {
  const mjModel* m = world.model.get();
  GasSourceDescription source;
  source.name = options.name;
  source.body = options.body.empty() ? 0 : mj_name2id(m, mjOBJ_BODY, options.body.c_str());
  if (source.body < 0) {
    return Error{ErrorKind::kInput,
                 fmt::format("{} '{}': there is no body '{}'", kind, options.name, options.body),
                 options.loc, suggest_name(options.body, object_names(m, mjOBJ_BODY))};
  }
  source.X_BS.p = to_vec3f(options.position);
  source.half_size = to_vec3f(options.size) * 0.5f;
  source.start = options.start;
  source.stop = options.stop.value_or(std::numeric_limits<double>::infinity());
  return source;
}

bool overlap(const GasDescription& a, const GasDescription& b) {
  const Vec3f a_high = a.low + a.size(), b_high = b.low + b.size();
  const float little = 0.5f * min(a.voxel, b.voxel);
  for (int i = 0; i < 3; ++i) {
    if (a.low[i] >= b_high[i] - little || b.low[i] >= a_high[i] - little) return false;
  }
  return true;
}

bool holds(const GasDescription& gas, Vec3f p) {
  const Vec3f high = gas.low + gas.size();
  for (int i = 0; i < 3; ++i) {
    if (p[i] < gas.low[i] || p[i] > high[i]) return false;
  }
  return true;
}

/// Static sources must be in some box; moving ones may enter one later.
template <class Options>
Status check_inside(const Options& options, const char* kind, int body, Vec3f p_B,
                    const std::vector<GasDescription>& gases) {
  if (body != 0) return {};
  for (const GasDescription& gas : gases) {
    if (holds(gas, p_B)) return {};
  }
  const GasDescription& gas = gases.front();
  const Vec3f high = gas.low + gas.size();
  return Error{ErrorKind::kInput,
               fmt::format("{} '{}' is at ({:g}, {:g}, {:g}), outside of any gas", kind,
                           options.name, p_B.x, p_B.y, p_B.z),
               options.loc,
               fmt::format("gas '{}' extends from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})",
                           gas.name, gas.low.x, gas.low.y, gas.low.z, high.x, high.y, high.z)};
}

/// Place in the file of the first option that makes a gas where the scene has none.
SourceLoc first_loc(const Scene& scene) {
  if (!scene.fires.empty()) return scene.fires.front().loc;
  return scene.smokes.empty() ? scene.dusts.front().loc : scene.smokes.front().loc;
}

}  // namespace

float GasSourceDescription::power_at(double time) const {
  if (!is_on(time)) return 0;
  const auto since = static_cast<float>(time - start);
  return growth > 0 ? min(power, growth * since * since) : power;
}

double GasSourceDescription::heat_until(double time) const {
  const double burning = std::clamp(time, start, std::max(start, stop)) - start;
  const double most = double{power}, rate = double{growth};
  if (rate <= 0) return most * burning;
  const double growing = std::min(burning, std::sqrt(most / rate));
  return rate * growing * growing * growing / 3 + most * (burning - growing);
}

float GasSourceDescription::mean_power(double from, double to) const {
  if (from >= start && to <= stop && power_at(from) == power) return power;
  return static_cast<float>((heat_until(to) - heat_until(from)) / (to - from));
}

float GasSourceDescription::share_on(double from, double to) const {
  if (from >= start && to <= stop) return 1;
  return static_cast<float>(std::max(std::min(to, stop) - std::max(from, start), 0.0) /
                            (to - from));
}

Result<GasesDescription> describe_gases(const CompiledWorld& world) {
  const Scene& scene = world.scene;
  GasesDescription out;
  for (const FireOptions& options : scene.fires) {
    GLOAM_TRY(GasSourceDescription source, describe_source(options, "fire", world));
    source.power = static_cast<float>(options.power);
    source.growth = kGrowthTable[row_of(kFireGrowths, options.growth)];
    out.sources.push_back(source);
  }
  for (const SmokeOptions& options : scene.smokes) {
    GLOAM_TRY(GasSourceDescription source, describe_source(options, "smoke", world));
    source.smoke = static_cast<float>(options.rate);
    source.heat = static_cast<float>(options.heat);
    if (options.velocity) source.jet = to_vec3f(*options.velocity);
    out.sources.push_back(source);
  }
  GLOAM_TRY(out.rotors, describe_rotors(world));
  out.dusts = describe_dusts(scene);
  std::vector<GasOptions> options = scene.gases;
  if (options.empty() && !(out.sources.empty() && out.dusts.empty())) {
    options.emplace_back().name = "air";
    if (!out.dusts.empty()) options.back().medium = "dust";
    options.back().loc = first_loc(scene);
  }
  GLOAM_TRY_STATUS(check_stirrers(scene, options));
  if (options.empty()) return out;
  const std::vector<Affine3f> X_WB = body_poses_at_qpos0(*world.model);
  const bool burns = !scene.fires.empty();
  for (const GasOptions& o : options) {
    Extent extent;
    if (o.size) {
      const Vec3 &c = *o.position, &s = *o.size;
      extent.add({c.x - s.x / 2, c.y - s.y / 2, c.z - s.z / 2});
      extent.add({c.x + s.x / 2, c.y + s.y / 2, c.z + s.z / 2});
    } else {
      extent = usual_extent(world, out.sources, out.dusts, X_WB);
    }
    GLOAM_TRY(GasDescription gas, describe_gas(o, extent));
    if (burns) gas.flame_absorption = flame_absorption_per_heat(gas.fuel.radiated);
    for (const GasDescription& other : out.gases) {
      if (overlap(gas, other))
        return gas_error(o, fmt::format("its box overlaps the box of gas '{}'", other.name),
                         "merge them into one box");
    }
    out.gases.push_back(std::move(gas));
  }
  const auto check = [&](const auto& options, const char* kind, size_t row) {
    const GasSourceDescription& source = out.sources[row];
    return check_inside(options, kind, source.body, source.X_BS.p, out.gases);
  };
  for (size_t i = 0; i < scene.fires.size(); ++i)
    GLOAM_TRY_STATUS(check(scene.fires[i], "fire", i));
  for (size_t i = 0; i < scene.smokes.size(); ++i)
    GLOAM_TRY_STATUS(check(scene.smokes[i], "smoke", scene.fires.size() + i));
  for (size_t i = 0; i < scene.rotors.size(); ++i) {
    GLOAM_TRY_STATUS(
        check_inside(scene.rotors[i], "rotor", out.rotors[i].body, out.rotors[i].p_B, out.gases));
  }
  return out;
}

}  // namespace gloam
