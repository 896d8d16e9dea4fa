#pragma once
// The lights that are sampled, and how often.

#include <vector>

#include "render/kernel/scene_view.h"
#include "sim/pose_frame.h"

namespace gloam {

class LightTable {
 public:
  /// Poses and live fields of the frame; then the emitters among `instances`, whose `light` is set.
  /// `levels`: of the description's lights, by their schedules.
  void update(const RenderDescription& description, const PoseFrame& frame,
              const std::vector<float>& levels, const std::vector<MaterialView>& materials,
              const std::vector<MeshView>& meshes, std::vector<InstanceView>* instances);
  /// Headlights sit at the camera.
  void place_headlights(const Affine3f& X_WC);

  /// Static lights that cast shadows, whether on or off, and static things described as emitters,
  /// in the order of LightView::guide.
  static std::vector<LightView> guided(const RenderDescription& description,
                                       const PoseFrame& frame);

  const std::vector<LightView>& lights() const { return lights_; }

 private:
  std::vector<LightView> lights_;
  std::vector<size_t> headlights_;  ///< rows of lights_
};

}  // namespace gloam
