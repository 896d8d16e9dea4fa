#pragma once
// Finds what static geometry lets through: of which static lights, and of the sky, each cell of a
// grid sees how much, and from where light comes to it. A room's sun is bright and reaches little
// of it, and lights the rest from one patch of the floor; without this, most rays would go in vain.

#include <vector>

#include "render/cpu/guide/guide_grid.h"
#include "render/scene/render_scene.h"

namespace gloam {

class LightGuideStore {
 public:
  /// A function of what never moves alone, so a picture does not depend on those made before it.
  /// Without static geometry the guide is empty.
  void build(SceneView scene, const CpuTracer& statics, const DescribedLook& look);
  LightGuide view() const;

 private:
  void find_rows(const SceneView& scene, const CpuTracer& statics);
  void look_for_lights(const SceneView& scene, const CpuTracer& statics, int row);
  void look_for_sky(const SceneView& scene, const CpuTracer& statics, int row);
  /// Weights of a row, of what it and its neighbours have seen.
  void conclude(int row);

  LightGuide grid_;
  std::vector<GuideRow> rows_;           ///< while building
  std::vector<float> found_, sky_seen_;  ///< as gain_ and sky_visible_; while building
  std::vector<uint32_t> surface_row_;
  std::vector<float> gain_, sky_visible_, arriving_;
};

}  // namespace gloam
