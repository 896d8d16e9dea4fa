#include "world/media/authored_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/memory.h"
#include "base/text.h"
#include "geometry/volume_file.h"
#include "world/media/flame.h"
#include "world/media/medium_presets.h"
#include "world/media/volume_pattern.h"
#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

using Bands6 = std::array<float, kMediumBands>;

Error volume_error(const VolumeOptions& options, std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, fmt::format("volume '{}': {}", options.name, message), options.loc,
          std::move(hint)};
}
/// Errors of the functions below, which have no place in the file, get the volume's.
Status placed(Status status, const VolumeOptions& options) {
  if (status.ok()) return status;
  return Error{status.error().kind, status.error().message, options.loc, status.error().hint};
}

/// One number stands for all bands, none for `usual`.
Bands6 bands_of(const std::vector<double>& numbers, float usual) {
  Bands6 out;
  out.fill(usual);
  for (size_t i = 0; i < out.size() && !numbers.empty(); ++i)
    out[i] = static_cast<float>(numbers[std::min(i, numbers.size() - 1)]);
  return out;
}

Result<MediumDescription> medium_of(const VolumeOptions& options) {
  MediumDescription medium;
  if (options.medium.empty()) {
    medium.name = options.name;
    medium.mass_extinction = bands_of(options.mass_extinction, 0);
    medium.albedo = bands_of(options.albedo, 0);
    medium.g = bands_of(options.g, 0);
  } else {
    const MediumDescription* preset = find_medium(options.medium);
    if (preset == nullptr) {
      return volume_error(options, fmt::format("there is no medium '{}'", options.medium),
                          suggest_name(options.medium, medium_names()));
    }
    medium = *preset;
  }
  medium.emission = static_cast<float>(options.emission);
  GLOAM_TRY_STATUS(placed(check_medium(medium), options));
  return medium;
}

/// [kg/m³], of a value of one.
Result<float> density_of(const VolumeOptions& options, const MediumDescription& medium) {
  if (options.density) return static_cast<float>(*options.density);
  const float extinction = medium.mass_extinction[static_cast<size_t>(MediumBand::kGreen)];
  if (!(extinction > 0)) {
    return volume_error(options, "its medium does not attenuate green light",
                        "specify 'density' instead");
  }
  return static_cast<float>(kKoschmieder / *options.visibility) / extinction;
}

Result<VolumeFile> read_grid(const VolumeOptions& options, const std::filesystem::path& path) {
  Result<VolumeFile> grid = read_npy(path, kMaxVolumeVoxels);
  if (grid.ok()) return grid;
  return volume_error(options, grid.error().to_string());
}

/// Sets the shape of the volume and one of its grids, times `scale`.
Status set_grid(const VolumeOptions& options, VolumeFile grid, float scale,
                VolumeDescription* volume, VolumeGrid* out) {
  const bool has_shape = volume->density != nullptr;
  if (has_shape && (grid.nx != volume->nx || grid.ny != volume->ny || grid.nz != volume->nz)) {
    return volume_error(
        options,
        fmt::format("its temperatures have {} x {} x {} voxels, but its densities {} x {} x {}",
                    grid.nx, grid.ny, grid.nz, volume->nx, volume->ny, volume->nz));
  }
  volume->nx = grid.nx, volume->ny = grid.ny, volume->nz = grid.nz;
  for (float& value : grid.values) {
    value *= scale;
    if (!std::isfinite(value))
      return volume_error(options, "its grid times its density is infinite");
  }
  *out = std::make_shared<const std::vector<float>>(std::move(grid.values));
  return {};
}

Status set_grids(const VolumeOptions& options, float density, VolumeDescription* volume) {
  volume->even_density = density;
  if (options.pattern) {
    const auto edge = static_cast<uint64_t>(options.pattern->resolution);
    GLOAM_TRY_STATUS(
        placed(check_memory(edge * edge * edge * sizeof(float),
                            fmt::format("volume '{}': a pattern of up to {} voxels along an edge",
                                        options.name, edge),
                            "reduce its resolution"),
               options));
    return set_grid(options, make_pattern(*options.pattern, volume->size), density, volume,
                    &volume->density);
  }
  if (!options.grid.empty()) {
    GLOAM_TRY(VolumeFile grid, read_grid(options, options.grid));
    GLOAM_TRY_STATUS(set_grid(options, std::move(grid), density, volume, &volume->density));
  }
  if (options.temperature_grid.empty()) return {};
  GLOAM_TRY(VolumeFile grid, read_grid(options, options.temperature_grid));
  return set_grid(options, std::move(grid), 1, volume, &volume->temperature);
}

}  // namespace

Status author_volumes(const std::vector<VolumeOptions>& options, RenderDescription* out) {
  std::map<std::pair<std::string, double>, int> shared;  // rows of presets, by name and emission
  for (const VolumeOptions& o : options) {
    GLOAM_TRY(MediumDescription medium, medium_of(o));
    VolumeDescription volume;
    volume.name = o.name;
    const Quat q = o.orientation.value_or(Quat{});
    const mjtNum p[3] = {o.position.x, o.position.y, o.position.z};
    const mjtNum wxyz[4] = {q.w, q.x, q.y, q.z};
    volume.X_WV = rigid_pose(p, wxyz);
    volume.size = {static_cast<float>(o.size.x), static_cast<float>(o.size.y),
                   static_cast<float>(o.size.z)};
    volume.even_temperature = static_cast<float>(o.temperature);
    volume.fade = static_cast<float>(o.fade);
    GLOAM_TRY(const float density, density_of(o, medium));
    GLOAM_TRY_STATUS(set_grids(o, density, &volume));

    volume.medium = static_cast<int>(out->media.size());
    if (!o.medium.empty())
      volume.medium = shared.try_emplace({o.medium, o.emission}, volume.medium).first->second;
    if (volume.medium == static_cast<int>(out->media.size()))
      out->media.push_back(std::move(medium));
    GLOAM_TRY_STATUS(placed(check_volume(volume, out->media.size()), o));
    out->volumes.push_back(std::move(volume));
  }
  return {};
}

void author_gases(const std::vector<GasDescription>& gases, RenderDescription* out) {
  for (size_t i = 0; i < gases.size(); ++i) {
    const GasDescription& gas = gases[i];
    VolumeDescription volume;
    volume.name = gas.name;
    volume.medium = static_cast<int>(out->media.size());
    volume.size = gas.size();
    volume.X_WV.p = gas.low + gas.size() * 0.5f;
    volume.nx = gas.nx, volume.ny = gas.ny, volume.nz = gas.nz;
    volume.even_temperature = gas.temperature;
    volume.field = static_cast<int>(i);
    out->media.push_back(gas.medium);
    out->volumes.push_back(volume);
    if (gas.flame_absorption <= 0) continue;
    volume.name += "/flame";
    volume.medium = static_cast<int>(out->media.size());
    volume.even_temperature = kFlameTemperature;
    volume.flame = true;
    out->media.push_back(flame_medium());
    out->volumes.push_back(std::move(volume));
  }
}

}  // namespace gloam
