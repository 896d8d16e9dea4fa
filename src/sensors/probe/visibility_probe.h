#pragma once
// Visibility in the media at a point, without a camera there.

#include "base/vec.h"
#include "render/scene/volume_store.h"
#include "sim/snapshots/snapshot.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {

class VisibilityProbe {
 public:
  /// No further than that [m]: clean air's own, about.
  static constexpr double kMaxVisibility = 1e5;

  /// Errors: those of the scene's media.
  static Result<VisibilityProbe> make(const CompiledWorld& world);
  /// Makes a probe of a World that is described already.
  static Result<VisibilityProbe> make(const RenderDescription& description);

  /// Is there anything that could be in the way?
  bool has_media() const { return !store_.view().volumes.empty(); }
  /// At p_W [m]: Koschmieder's 3.912 / extinction at 550 nm, as if all were as it is here. Waits
  /// for what of the snapshot's media is not solved for yet.
  double visibility(const SnapshotData& snapshot, Vec3f p_W) const;

 private:
  /// Grid that a volume shows.
  struct Shown {
    int field = -1;      ///< row of SnapshotData::effects.media; -1 = it stays
    bool flame = false;  ///< its flames
  };

  VolumeStore store_;
  std::vector<Shown> shown_;  ///< by volume
};

}  // namespace gloam
