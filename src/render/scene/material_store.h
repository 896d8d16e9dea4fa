#pragma once
// Materials as the kernel reads them; they follow the live fields of PoseFrames.

#include <cstdint>
#include <vector>

#include "instant/pose_frame.h"
#include "render/kernel/scene_view.h"
#include "render/scene/level_table.h"
#include "render/scene/texture_store.h"

namespace gloam {

class MaterialStore {
 public:
  MaterialStore() = default;
  /// Store of the described materials. Both arguments must outlive it.
  MaterialStore(const RenderDescription& description, const TextureStore& textures);

  /// Takes the live fields of `frame`. An instance whose colour is no longer that of its described
  /// material gets a row of its own. True when they are not those of the last update.
  bool update(const RenderDescription& description, const TextureStore& textures,
              const PoseFrame& frame, std::vector<InstanceView>* instances);

  /// Scales what the described materials give off.
  void dim(const RenderDescription& description, const std::vector<LightLevel>& levels);

  const std::vector<MaterialView>& views() const { return views_; }
  const std::vector<MaterialLayers>& layers() const { return layers_; }

 private:
  std::vector<MaterialView> views_;  // those of the description, then own ones of instances
  std::vector<MaterialLayers> layers_;
  std::vector<int> layer_rows_;  ///< by described material; -1 = none
  std::vector<Vec3f> emission_;  ///< by described material, undimmed
  uint64_t live_serial_ = 0;
};

}  // namespace gloam
