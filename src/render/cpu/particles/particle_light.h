#pragma once
// The light that falls on drops and flakes before a camera.

#include <algorithm>
#include <vector>

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/scene_view.h"

namespace gloam {

/// Light that arrives at p_W from all around, save that of lamps.
AmbientCube light_around(const SceneView& scene, const CpuTracer& tracer, Vec3f p_W);

/// The picture as drops show it: a blur of some twenty degrees, on a coarse grid.
class BlurredPicture {
 public:
  /// `focal`: length [px].
  BlurredPicture(const std::vector<Vec3f>& picture, int width, int height, float focal);

  Vec3f at(Vec2f uv) const {
    const auto cell = [&](float x, int n) {
      return std::clamp(static_cast<int>(x / static_cast<float>(cell_)), 0, n - 1);
    };
    return light_[static_cast<size_t>(cell(uv.y, ny_) * nx_ + cell(uv.x, nx_))];
  }

 private:
  int cell_, nx_, ny_;
  std::vector<Vec3f> light_;
};

}  // namespace gloam
