#pragma once
// The renderer's face: one World's visuals, moved by PoseFrames, seen by any number of cameras.

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/render.h"
#include "instant/pose_frame.h"
#include "render/film/film.h"
#include "render/kernel/camera/camera.h"
#include "render/kernel/film/tone.h"
#include "world/render_description.h"

namespace gloam {

struct LidarView;    // render/lidar_view.h
class RenderTurns;   // render/turns.h
struct LidarReturn;  // render/kernel/lidar/lidar_detect.h

/// A camera, where it is, and when it sees. C looks along -Z with +Y up. Times are those of the
/// scene's keys: 0 the first, 1 the last.
struct CameraView {
  Intrinsics intrinsics;
  Affine3f X_WC_open;                 ///< at time 0
  Affine3f X_WC_previous;             ///< at the previous frame, for `motion`
  std::vector<Affine3f> X_WC_keys{};  ///< one per key of the scene; empty = it stands still
  Shutter shutter{};                  ///< of the exact channels its opening counts
  Aperture aperture{};                ///< path tier; the exact channels are of its middle
  // Surfaces that its own rays pass, in all channels; shadows and reflections are of all.
  float near = 0;                                        ///< [m]
  bool culls_backs = false;                              ///< surfaces seen from behind
  std::shared_ptr<const std::vector<uint8_t>> hidden{};  ///< by instance; null = none
};

/// Memory of one camera's earlier pictures, for the interactive tier. A picture is a function of
/// the scene, the seed and the pictures since the history was made.
class ViewHistory {
 public:
  virtual ~ViewHistory() = default;
};

/// Steps that a renderer applies to a picture's light before it returns the picture: the same as a
/// Denoiser and tone_map(), without a copy through the host's memory.
struct PictureFinish {
  bool denoise = false;     ///< Film::radiance is without noise, albedo and normal stay empty
  bool to_display = false;  ///< Film::rgb instead of Film::radiance
  ToneMapSettings tone{};   ///< of it
};

struct RenderSettings {
  RenderTier tier = RenderTier::kPath;
  int spp = 4;           ///< samples per pixel of this call; with `error` at most
  int first_sample = 0;  ///< index of the first of them: calls with disjoint ranges may be averaged
  int max_depth = 5;     ///< path vertices after the camera (Mitsuba's max_depth)
  int roulette_depth = 100;  ///< vertices before Russian roulette starts (Mitsuba's rr_depth)
  uint64_t seed = 1;
  uint32_t frame = 0;          ///< draws are keyed (seed, frame, pixel, sample)
  bool exact_channels = true;  ///< depth, distance, part
  bool exact_details = true;   ///< with them center_normal, center_albedo, motion, scene_flow
  bool cover = false;          ///< Film::cover, by the label's instance of what is drawn
  bool variance = false;
  /// For a denoiser, of pictures with fewer samples than this: albedo and normal of so many rays at
  /// edges, of the pixel's centre elsewhere. 0 = always those of the samples. Needs exact_details.
  int guide_samples = 0;
  ViewHistory* history = nullptr;  ///< interactive tier: of this camera; null = a picture by itself
  /// Path tier: sampling goes on until the standard error of a pixel's mean is this share of its
  /// value (render/cpu/path/adaptive_tile.h), 0 … 1; 0 = `spp` samples in every pixel. Then
  /// first_sample is 0 and spp at least kLeastAdaptiveSpp.
  float error = 0;
  PictureFinish finish{};  ///< only where Renderer::finishes() says so
  float error_floor = 0;   ///< [cd/m²] darker pixels count as of this value
  /// Told how much of the picture is done, 0..1, about ten times a second, from the threads that
  /// render but never by two at once. Returns false to end the render: the film then is unfinished.
  std::function<bool(double done)> progress = {};
  /// The caller's turn at this renderer, which render() passes on, between two tiles, to sensors
  /// that should have it first. The keys of update() and `previous` must then live until render()
  /// returns. null = nobody else uses the renderer.
  RenderTurns* turns = nullptr;
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
  /// Moves instances, lights and deformables. `keys`: one or more frames that follow each other
  /// evenly in time and bracket the exposure of all rows; between them everything moves evenly.
  /// `previous` is the frame before, for motion vectors. Lights and live fields are those of the
  /// first key.
  virtual void update(std::span<const PoseFrame* const> keys, const PoseFrame& previous) = 0;
  /// Two keys, or one if they are the same object.
  void update(const PoseFrame& open, const PoseFrame& close, const PoseFrame& previous) {
    const PoseFrame* const keys[] = {&open, &close};
    update(std::span(keys, &open == &close ? 1 : 2), previous);
  }
  /// Fills `film` (resized to the view's resolution).
  RenderStats render(const CameraView& view, const RenderSettings& settings, Film* film) {
    return begin(view, settings, film).get();
  }
  /// Begins to fill `film`, which must live until the result has been taken. A card goes on by
  /// itself: others may update the renderer and begin pictures before this one is finished. The
  /// result may be taken on any thread, and only while the renderer lives.
  virtual std::future<RenderStats> begin(const CameraView& view, const RenderSettings& settings,
                                         Film* film) = 0;
  /// Whether render() carries out `settings.finish`; a card does, save for adaptive samples.
  virtual bool finishes(const RenderSettings& settings) = 0;
  /// Draws what is strewn through the air over a finished picture of the view [cd/m²], whose film
  /// has the exact channel `distance`.
  virtual void draw_particles(const CameraView& view, const Film& film,
                              std::vector<Vec3f>* radiance) = 0;
  /// Illuminance [lx] of a surface at p_W that faces n_W, a unit vector.
  virtual float illuminance(Vec3f p_W, Vec3f n_W) = 0;
  /// Fractions of light from far away that reach the middle of a view's lens along each direction
  /// (unit, world), into `passed`: past what its pictures show, and through media.
  virtual void distant_light(const CameraView& view, std::span<const Vec3f> directions,
                             std::span<float> passed) = 0;
  /// Sends out the beams of a LiDAR; `returns`: view.optics.most_returns of each, in their order.
  virtual void scan(const LidarView& view, std::span<LidarReturn> returns) = 0;
  /// For RenderSettings::history; of this renderer alone.
  virtual std::unique_ptr<ViewHistory> make_history() const = 0;
  /// True at the first call alone: cameras that share a renderer warn once of its pictures' noise.
  bool first_to_warn() { return !has_warned_.exchange(true); }

 private:
  std::atomic<bool> has_warned_ = false;
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
/// kAuto: on a card where this build and this machine have one.
Result<std::unique_ptr<Renderer>> make_renderer(const RenderDescription& description,
                                                RenderDevice device);
/// Whether make_renderer takes a card for `device`.
bool renders_on_card(RenderDevice device);
/// "NVIDIA H200", or why make_cuda_renderer would fail.
Result<std::string> cuda_device_name();

/// Camera `camera` of the description as it stands in the frames, which are those of update().
CameraView view_at(const RenderDescription& description, int camera,
                   std::span<const PoseFrame* const> keys, const PoseFrame& previous);

}  // namespace gloam
