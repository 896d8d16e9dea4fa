#include "world/media/medium_description.h"

#include <fmt/format.h>

#include <cmath>

namespace gloam {
namespace {

constexpr const char* kBandNames[kMediumBands] = {"red",    "green",   "blue",
                                                  "905 nm", "1550 nm", "8-14 µm"};

Error bad_input(std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

bool is_rigid(const Affine3f& X) {
  const auto near = [](float value, float wanted) { return std::abs(value - wanted) < 1e-3f; };
  return near(dot(X.x, X.x), 1) && near(dot(X.y, X.y), 1) && near(dot(X.z, X.z), 1) &&
         near(dot(X.x, X.y), 0) && near(dot(X.y, X.z), 0) && near(dot(X.z, X.x), 0) &&
         std::isfinite(X.p.x + X.p.y + X.p.z);
}

Status check_grid(const VolumeDescription& volume, const VolumeGrid& grid, const char* what) {
  const uint64_t voxels = uint64_t(volume.nx) * uint64_t(volume.ny) * uint64_t(volume.nz);
  if (!grid || grid->size() == voxels) return {};
  return bad_input(fmt::format("volume '{}' has {} {} values for {} x {} x {} voxels", volume.name,
                               grid->size(), what, volume.nx, volume.ny, volume.nz));
}

}  // namespace

Status check_medium(const MediumDescription& medium) {
  for (size_t i = 0; i < kMediumBands; ++i) {
    const auto bad = [&](const char* what, float value, const char* range) {
      return bad_input(fmt::format("medium '{}' has a {} of {} in the band {}; it must be {}",
                                   medium.name, what, value, kBandNames[i], range));
    };
    const float k = medium.mass_extinction[i], a = medium.albedo[i], g = medium.g[i];
    if (!(k >= 0 && std::isfinite(k))) return bad("mass extinction", k, "0 m²/kg or more");
    if (!(a >= 0 && a <= 1)) return bad("albedo", a, "0 to 1");
    if (!(g > -1 && g < 1)) return bad("mean cosine g", g, "between -1 and 1");
  }
  if (!(medium.emission >= 0 && std::isfinite(medium.emission))) {
    return bad_input(fmt::format("medium '{}' has an emission of {}; it must be 0 or more",
                                 medium.name, medium.emission));
  }
  return {};
}

Status check_volume_voxels(const std::string& name, int64_t nx, int64_t ny, int64_t nz) {
  if (nx < 1 || ny < 1 || nz < 1) {
    return bad_input(
        fmt::format("volume '{}' has {} x {} x {} voxels; it needs at least one along each axis",
                    name, nx, ny, nz));
  }
  // In double: the product of hostile sizes does not fit into an integer.
  const double voxels = double(nx) * double(ny) * double(nz);
  if (voxels <= double(kMaxVolumeVoxels)) return {};
  return bad_input(fmt::format("volume '{}' has {} x {} x {} voxels, {:.3g} GiB per field; the "
                               "limit is {} GiB",
                               name, nx, ny, nz, voxels * sizeof(float) / 0x1p30,
                               kMaxVolumeVoxels * sizeof(float) >> 30),
                   "use fewer voxels or several volumes");
}

Status check_volume(const VolumeDescription& volume, size_t media) {
  if (volume.medium < 0 || static_cast<size_t>(volume.medium) >= media) {
    return bad_input(fmt::format("volume '{}' refers to medium {}, which does not exist",
                                 volume.name, volume.medium));
  }
  const Vec3f s = volume.size;
  const auto is_length = [](float x) { return x > 0 && std::isfinite(x); };
  if (!is_length(s.x) || !is_length(s.y) || !is_length(s.z)) {
    return bad_input(fmt::format("volume '{}' has a size of {} x {} x {} m; it must be positive",
                                 volume.name, s.x, s.y, s.z));
  }
  if (!is_rigid(volume.X_WV)) {
    return bad_input(fmt::format("volume '{}' has a pose that is not rigid", volume.name));
  }
  const auto bad = [&](const char* what, float value) {
    return bad_input(
        fmt::format("volume '{}' has a {} of {}; it must be 0 or more", volume.name, what, value));
  };
  const auto is_amount = [](float x) { return x >= 0 && std::isfinite(x); };
  if (!is_amount(volume.even_density)) return bad("density", volume.even_density);
  if (!is_amount(volume.even_temperature)) return bad("temperature", volume.even_temperature);
  if (!is_amount(volume.fade)) return bad("fade", volume.fade);
  GLOAM_TRY_STATUS(check_volume_voxels(volume.name, volume.nx, volume.ny, volume.nz));
  GLOAM_TRY_STATUS(check_grid(volume, volume.density, "density"));
  return check_grid(volume, volume.temperature, "temperature");
}

}  // namespace gloam
