#pragma once
// Finds what static geometry lets through: of which static lights, and of the sky, each cell of a
// grid sees how much. A room's sun is bright and reaches little of it; without this, most shadow
// rays would go there in vain.

#include <vector>

#include "render/cpu/guide_grid.h"

namespace gloam {

class LightGuideStore {
 public:
  /// A function of what never moves alone, so a picture does not depend on those made before it.
  /// `lights`: those of the guide. Without static geometry the guide is empty.
  void build(SceneView scene, const EmbreeTracer& statics, const std::vector<LightView>& lights);
  LightGuide view() const;

 private:
  /// Where the rays of one row start: at surfaces, or anywhere in the cell.
  struct Row {
    int cell = 0;
    int facing = -1;  ///< -1: anywhere
    std::vector<SurfacePoint> points;
  };
  struct SkyRay {
    Vec3f d;
    float luminance;
  };

  void find_rows(const SceneView& scene, const EmbreeTracer& statics);
  void look_for_lights(const SceneView& scene, const EmbreeTracer& statics, int row);
  void look_for_sky(const SceneView& scene, const EmbreeTracer& statics, int row);
  /// Makes the row's guide from what it and its neighbours have seen.
  void conclude(int row);
  /// The row and up to six like it in cells that share a face with its own.
  int neighborhood(int row, int* rows) const;
  SurfacePoint start_of(const Row& row, int ray, Sampler* sampler) const;

  LightGuide grid_;
  std::vector<Row> rows_;                      ///< while building
  std::vector<float> seen_;                    ///< row-major; while building
  std::vector<std::vector<SkyRay>> sky_rays_;  ///< of each row; while building
  std::vector<int> surface_row_;
  std::vector<float> visible_;
  std::vector<SkyCone> sky_;
};

}  // namespace gloam
