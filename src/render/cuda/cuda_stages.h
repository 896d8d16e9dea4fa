#pragma once
// The path stage, the direct stage, the interactive tier and the exact channels on an NVIDIA card.
// Where this build has no CUDA, or the machine no card, make() says so.

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "render/kernel/camera/view_clip.h"
#include "render/kernel/path/path_state.h"
#include "render/lidar_view.h"
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
  bool has_motion = false;        ///< something moves while the shutter is open
  bool centered = false;          ///< as in cpu/path/tile.h
  bool measures_ambient = false;  ///< for the direct tier, as measure_ambient() does
  int guide_samples = 0;  ///< rays for a denoiser's guides at edges; 0 = those of the samples
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
  /// Of pictures of the interactive tier; for these stages alone.
  virtual std::unique_ptr<ViewHistory> make_history() const = 0;
  /// Whether render() can finish pictures so.
  virtual bool finishes(const PictureFinish& finish) = 0;
  /// Fills a film of the right size, without an error to reach.
  /// As scan_beams() does; the job's settings and camera are not used.
  virtual void scan(const CudaJob& job, const LidarView& view, std::span<LidarReturn> returns) = 0;
  /// The result is finished when it is taken; the job's tables may change before.
  virtual std::future<RenderStats> begin(const CudaJob& job, Film* film) = 0;
};

}  // namespace gloam
