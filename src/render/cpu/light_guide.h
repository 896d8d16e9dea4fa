#pragma once
// Finds what static geometry lets through: of which static lights, and of the sky, each cell of a
// grid sees how much. A room's sun is bright and reaches little of it; without this, most shadow
// rays would go there in vain.

#include <vector>

#include "render/cpu/embree_scene.h"

namespace gloam {

class LightGuideStore {
 public:
  /// A function of what never moves alone, so a picture does not depend on those made before it.
  /// `lights`: rows of the guide. Without static geometry the guide is empty.
  void build(SceneView scene, const EmbreeTracer& statics, const std::vector<LightView>& lights);
  LightGuide view() const;

 private:
  void look_for_lights(const SceneView& scene, const EmbreeTracer& statics, int cell);
  void look_for_sky(const SceneView& scene, const EmbreeTracer& statics, int cell);
  /// Makes the cell's guide from what it and its neighbours have seen.
  void conclude(int cell);
  /// The cell and up to six that share a face with it.
  int neighborhood(int cell, int* cells) const;
  Vec3f point_in(int cell, Vec3f u) const;

  struct SkyRay {
    Vec3f d;
    float luminance;
  };

  LightGuide grid_;
  std::vector<float> seen_;                    ///< cell-major; while building
  std::vector<std::vector<SkyRay>> sky_rays_;  ///< of each cell; while building
  std::vector<float> visible_;
  std::vector<SkyCone> sky_;
};

}  // namespace gloam
