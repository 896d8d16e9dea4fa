#pragma once
// The fast tier: what a camera remembers from picture to picture, and one picture more.

#include "render/cpu/fast_frame.h"
#include "render/cpu/irradiance_cache.h"
#include "render/renderer.h"

namespace gloam {

class FastHistory final : public ViewHistory {
 public:
  /// Renders into film->radiance, albedo, normal and the exact channels.
  RenderStats render(const SceneView& scene, const EmbreeTracer& tracer, const CameraView32& camera,
                     const RenderSettings& settings, Film* film);

 private:
  void trace(const SceneView& scene, const EmbreeTracer& tracer, const CameraView32& camera,
             const RenderSettings& settings, Film* film);
  void compose(Film* film) const;

  IrradianceCache cache_;
  FastFrame now_, before_;
  FastFilter filter_;
  std::vector<CacheRequest> requests_;
  uint64_t rays_ = 0;
  bool warm_ = false;
};

}  // namespace gloam
