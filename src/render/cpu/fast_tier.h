#pragma once
// The fast tier: what a camera remembers from picture to picture, and one picture more.

#include "render/cpu/fast_filter.h"
#include "render/cpu/irradiance_cache.h"
#include "render/renderer.h"

namespace gloam {

class FastHistory final : public ViewHistory {
 public:
  /// Renders into film->radiance.
  RenderStats render(const SceneView& scene, const CpuTracer& tracer, const CameraView32& camera,
                     const RenderSettings& settings, Film* film);

 private:
  /// One picture of the sequence; `pass` tells those of one instant apart.
  void add_picture(const SceneView& scene, const CpuTracer& tracer, const CameraView32& camera,
                   const RenderSettings& settings, uint32_t pass);
  void trace(const SceneView& scene, const CpuTracer& tracer, const CameraView32& camera,
             const RenderSettings& settings, uint32_t pass);
  void look_up(const IrradianceCacheView& cache);
  void compose();

  IrradianceCache cache_;
  FastFrame now_, before_;
  FastFilter filter_;
  std::vector<std::vector<CacheRequest>> asked_;  ///< by tile
  std::vector<CacheRequest> requests_;
  uint64_t rays_ = 0;
  uint32_t pictures_ = 0;  ///< taken, those of one instant too
};

}  // namespace gloam
