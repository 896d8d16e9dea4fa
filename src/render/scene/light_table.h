#pragma once
// The lights that are sampled, and how often.

#include <span>
#include <vector>

#include "instant/pose_frame.h"
#include "render/scene/level_table.h"
#include "render/scene/light_tree_table.h"
#include "render/scene/moving_sky.h"

namespace gloam {

class LightTable {
 public:
  /// Poses of the keys and live fields of the first; then the emitters among `instances`, whose
  /// `light` is set. `levels`: of the description's lights, by their schedules; `sun`: of a sky
  /// that moves.
  void update(const RenderDescription& description, std::span<const PoseFrame* const> keys,
              const std::vector<LightLevel>& levels, const MovingSun* sun,
              const std::vector<MaterialView>& materials, const std::vector<MeshView>& meshes,
              std::vector<InstanceView>* instances);
  /// Headlights sit at the camera. `keys`: where it is at the keys; empty = it stands still.
  void place_headlights(const Affine3f& X_WC, std::span<const Affine3f> keys);

  /// Static lights that cast shadows, whether on or off, and static things described as emitters,
  /// in the order of LightView::guide. `materials` and `meshes` as described; `instances` get the
  /// materials and lights that they are described with.
  static std::vector<LightView> guided(const RenderDescription& description, const PoseFrame& frame,
                                       const std::vector<MaterialView>& materials,
                                       const std::vector<MeshView>& meshes,
                                       std::vector<InstanceView>* instances);

  const std::vector<LightView>& lights() const { return lights_; }
  /// SceneView::light_keys.
  const std::vector<LightKey>& keys() const { return keys_; }
  uint32_t key_count() const { return key_count_; }
  /// Tree over the lights where they are many, else empty.
  LightTreeView tree() const { return tree_.view(); }
  /// Whether a ray can hit some sphere or sun.
  bool has_visible() const { return has_visible_; }

 private:
  /// Brings the tree up to date where `before`, the lights of the last update, were others.
  void update_tree(const std::vector<LightView>& before,
                   const std::vector<uint32_t>& headlights_before);

  void set_keys(std::span<const LightKey> keys, LightView* light);

  std::vector<LightView> lights_;
  std::vector<LightKey> keys_;
  size_t lamp_keys_ = 0;  ///< of keys_; the rest is of headlights
  uint32_t key_count_ = 0;
  std::vector<uint32_t> headlights_;  ///< rows of lights_
  LightTreeTable tree_;
  bool has_visible_ = false;
};

}  // namespace gloam
