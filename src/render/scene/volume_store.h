#pragma once
// Volumes as the kernel reads them: their grids as they were handed over, bounds of the density,
// and where they give off light.

#include <vector>

#include "instant/pose_frame.h"
#include "render/scene/glow_table.h"

namespace gloam {

class VolumeStore {
 public:
  VolumeStore() = default;
  /// Errors: media and volumes that check_medium and check_volume refuse, more than kMaxVolumes,
  /// grids with values that are negative or not finite, extinctions above kMaxExtinction.
  static Result<VolumeStore> make(const std::vector<MediumDescription>& media,
                                  const std::vector<VolumeDescription>& volumes);

  /// Another pose, other grids or another number of voxels of one volume; its medium stays. Nothing
  /// is allocated while the number of voxels stays and no more of it glows. Errors as of make():
  /// then all is as it was.
  Status replace(size_t volume, const VolumeDescription& with);

  /// The grids that the frame has for `volumes`, those of make(); others stay.
  void follow(const std::vector<VolumeDescription>& volumes, const PoseFrame& frame);

  /// Valid until the next replace(), or until the store is moved or gone.
  MediaView view() const;

 private:
  /// Volume `changed` has other fields or another pose.
  void find_glow(size_t changed);

  struct Fields {
    VolumeGrid density, temperature;
    std::vector<CellBounds> cells, spare;  ///< spare: scratch for the next ones
  };

  std::vector<VolumeView> views_;
  std::vector<Fields> fields_;          ///< of each volume
  std::vector<GlowTable> glow_tables_;  ///< of each volume
  std::vector<GlowView> glows_;         ///< of those that glow
  std::vector<Vec3f> black_body_;
};

}  // namespace gloam
