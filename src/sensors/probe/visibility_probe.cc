#include "sensors/probe/visibility_probe.h"

#include <algorithm>

#include "world/media/authored_volume.h"

namespace gloam {

Result<VisibilityProbe> VisibilityProbe::make(const CompiledWorld& world) {
  RenderDescription description;
  if (world.scene.weather) {  // roofs keep rain off
    GLOAM_TRY(description, describe_for_rendering(world));
  } else {
    GLOAM_TRY_STATUS(author_volumes(world.scene.volumes, &description));
    author_gases(world.gases.gases, &description);
  }
  return make(description);
}

Result<VisibilityProbe> VisibilityProbe::make(const RenderDescription& description) {
  VisibilityProbe probe;
  std::vector<VolumeDescription> volumes = description.volumes;
  for (VolumeDescription& volume : volumes) {
    probe.shown_.push_back({volume.field, volume.flame});
    if (volume.field < 0) continue;
    // A grid, for the store to keep its voxels.
    const size_t voxels = size_t(volume.nx) * size_t(volume.ny) * size_t(volume.nz);
    volume.density = std::make_shared<const std::vector<float>>(voxels, 0.0f);
  }
  GLOAM_TRY(probe.store_, VolumeStore::make(description.media, volumes));
  return probe;
}

double VisibilityProbe::visibility(const SnapshotData& snapshot, Vec3f p_W) const {
  const MediaView media = store_.view();
  double extinction = 0;  // [1/m]
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    VolumeView volume = media.volumes[i];
    const Vec3f p_G = transform_point(volume.X_GW, p_W);
    if (!media::is_inside(volume, p_G)) continue;
    const auto density_in = [&](const VolumeGrid& grid) {
      if (grid == nullptr) return 0.0f;
      volume.density = {grid->data(), static_cast<uint32_t>(grid->size())};
      return media::density_at(volume, p_G);
    };
    float density = 0;
    if (const Shown& shown = shown_[i]; shown.field < 0) {
      density = media::density_at(volume, p_G);
    } else if (const FieldWindow& window = snapshot.effects.media[static_cast<size_t>(shown.field)];
               window.before != nullptr) {
      const auto density_of = [&](const MediumField& field) {
        field.wait();
        return density_in(shown.flame ? field.flame() : field.density());
      };
      density = density_of(*window.before);
      if (window.share > 0 && window.after != nullptr)
        density = lerp(density, density_of(*window.after), window.share);
    }
    extinction +=
        double(density) * double(volume.mass_extinction[static_cast<int>(MediumBand::kGreen)]);
  }
  return extinction > 0 ? std::min(kKoschmieder / extinction, kMaxVisibility) : kMaxVisibility;
}

}  // namespace gloam
