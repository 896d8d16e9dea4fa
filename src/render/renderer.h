#pragma once
// The renderer's face: one World's visuals, moved by PoseFrames, seen by any number of cameras.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "gloam/result.h"
#include "render/film/film.h"
#include "sim/pose_frame.h"
#include "world/render_description.h"

namespace gloam {

/// A camera at the two ends of the shutter. C looks along -Z with +Y up.
struct CameraView {
  Intrinsics intrinsics;
  Affine3f X_WC_open, X_WC_close;
  Affine3f X_WC_previous;  ///< at the previous frame, for `motion`
};

enum class RenderTier : uint8_t {
  kPath,    ///< unbiased path tracing
  kDirect,  ///< primary hit, direct light with shadows, one ambient light by facing
  kFast,    ///< direct light, cached indirect light, one specular bounce; filtered over pictures
};

/// What the fast tier remembers of one camera's earlier pictures. A picture is a function of the
/// scene, the seed and the pictures since the history was made.
class ViewHistory {
 public:
  virtual ~ViewHistory() = default;
};

struct RenderSettings {
  RenderTier tier = RenderTier::kPath;
  int spp = 4;           ///< samples per pixel of this call; with `error` at most
  int first_sample = 0;  ///< index of the first of them: calls with disjoint ranges may be averaged
  int max_depth = 5;     ///< path vertices after the camera (Mitsuba's max_depth)
  int roulette_depth = 100;  ///< vertices before Russian roulette starts (Mitsuba's rr_depth)
  uint64_t seed = 1;
  uint32_t frame = 0;          ///< draws are keyed (seed, frame, pixel, sample)
  bool exact_channels = true;  ///< depth, distance, part, center_normal, center_albedo, motion
  bool variance = false;
  /// For a denoiser, of pictures with fewer samples than this: albedo and normal of so many rays at
  /// edges, of the pixel's centre elsewhere. 0 = always those of the samples. Needs exact_channels.
  int guide_samples = 0;
  ViewHistory* history = nullptr;  ///< fast tier: of this camera; null = a picture by itself
  /// Path tier: sampling goes on until the standard error of a pixel's mean is this share of its
  /// value (render/cpu/adaptive_tile.h), 0 … 1; 0 = `spp` samples in every pixel. Then first_sample
  /// is 0 and spp at least kLeastAdaptiveSpp.
  float error = 0;
  float error_floor = 0;  ///< [cd/m²] darker pixels count as of this value
  /// Told how much of the picture is done, 0..1, about ten times a second, from the threads that
  /// render but never by two at once. Returns false to end the render: the film then is unfinished.
  std::function<bool(double done)> progress = {};
};

/// Samples of a pixel before its error is looked at.
inline constexpr int kLeastAdaptiveSpp = 16;

struct RenderStats {
  uint64_t paths = 0, rays = 0;
  uint64_t unreached = 0;    ///< pixels that had `spp` samples and not yet the error asked for
  double trace_seconds = 0;  ///< wall time of the call [s]
  /// On a card: time of the stages, and of the copy of the scene before them [s].
  double device_seconds = 0, upload_seconds = 0;
  bool finished = true;  ///< false: `progress` ended it
};

/// Not thread-safe; renders with all threads of parallel_for. The RenderDescription must outlive
/// it.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Moves instances, lights and deformables. `open` and `close` bracket the shutter (may be the
  /// same object); `previous` is the frame before, for motion vectors.
  virtual void update(const PoseFrame& open, const PoseFrame& close, const PoseFrame& previous) = 0;
  /// Fills `film` (resized to the view's resolution).
  virtual RenderStats render(const CameraView& view, const RenderSettings& settings,
                             Film* film) = 0;
  /// For RenderSettings::history; of this renderer alone.
  virtual std::unique_ptr<ViewHistory> make_history() const = 0;
};

/// "Embree 3.13.5"
std::string ray_tracer_version();

enum class RayTracer : uint8_t {
  kEmbree,
  kOwn,  ///< our own BVH, which is the card's too: slower, to compare with
};

/// Renders on the CPU. Errors: out of memory, a description that refers to things it does not hold.
Result<std::unique_ptr<Renderer>> make_cpu_renderer(const RenderDescription& description,
                                                    RayTracer tracer = RayTracer::kEmbree);

/// Renders on the first NVIDIA card what it has stages for (path and direct tier, exact channels),
/// the rest on the CPU. Errors: as above; no CUDA in this build, no card.
Result<std::unique_ptr<Renderer>> make_cuda_renderer(const RenderDescription& description);
/// On "cpu", "cuda", or with "auto" on a card where this build and this machine have one.
Result<std::unique_ptr<Renderer>> make_renderer(const RenderDescription& description,
                                                const std::string& device);
/// "NVIDIA H200", or why make_cuda_renderer would fail.
Result<std::string> cuda_device_name();

/// Camera `camera` of the description as it stands in `frame`.
CameraView view_at(const RenderDescription& description, int camera, const PoseFrame& open,
                   const PoseFrame& close, const PoseFrame& previous);

}  // namespace gloam
