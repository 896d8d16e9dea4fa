#pragma once
// The path stage, the direct stage and the exact channels on an NVIDIA card. Where this build has
// no CUDA, or the machine no card, make() says so.

#include <memory>
#include <string>
#include <vector>

#include "render/kernel/camera/view_clip.h"
#include "render/kernel/light/ambient_path.h"
#include "render/renderer.h"
#include "render/scene/bvh_scene.h"

namespace gloam {

/// One picture, in the host's memory.
struct CudaJob {
  const RenderScene& scene;
  const BvhScene& bvh;
  SceneView view;
  CameraView32 camera;
  ViewClip clip;
  const RenderSettings& settings;
  PathOptions path;
  uint32_t log2_samples = 0;
  bool has_motion = false;  ///< something moves while the shutter is open
  bool centered = false;    ///< as in cpu/path/tile.h
};

class CudaStages {
 public:
  /// Error: no CUDA in this build, no driver, no card that can run its kernels.
  static Result<std::unique_ptr<CudaStages>> make();
  virtual ~CudaStages() = default;

  /// "NVIDIA H200"
  virtual std::string device_name() const = 0;
  /// Copies the scene to the card, after every update of the scene and of the BVH.
  virtual void update(const RenderScene& scene) = 0;
  /// Paths for AmbientCube, as trace_ambient makes them.
  virtual std::vector<AmbientPath> trace_ambient(const CudaJob& job, int width, int height) = 0;
  /// Fills a film of the right size. The tier is kPath or kDirect, without an error to reach.
  virtual RenderStats render(const CudaJob& job, Film* film) = 0;
};

}  // namespace gloam
