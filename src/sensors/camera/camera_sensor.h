#pragma once
// A camera: an instant's poses in, one CameraFrame out. Every channel is of the same rays; the
// picture is a pure function of (World, seed, camera, frame index, poses).

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gloam/camera.h"
#include "gloam/result.h"
#include "gloam/simulation.h"
#include "instant/pose_frame.h"
#include "render/film/denoise.h"
#include "render/renderer.h"
#include "render/turns.h"
#include "sensors/camera/camera_channels.h"
#include "sensors/camera/camera_models.h"
#include "sensors/camera/lens_drops.h"
#include "world/render_description.h"

namespace gloam {

/// Memory that pictures take, nearly [bytes].
struct PictureMemory {
  uint64_t working = 0;  ///< memory of the sensor, from its first picture on
  uint64_t frame = 0;    ///< memory of each CameraFrame
};

/// Longest path of a picture, in vertices: RenderOptions::max_depth, or by default 5, 8 in the
/// interactive tier, and 24 in scenes with media.
int path_depth(const RenderOptions& render, bool has_media);

class CameraSensor {
 public:
  /// `description` must outlive the sensor. Errors: unknown camera (with the nearest name), channel
  /// or tier; a number out of its range.
  static Result<std::unique_ptr<CameraSensor>> create(const RenderDescription& description,
                                                      const CameraRequest& request, uint64_t seed);

  /// Renders the exposure that starts with the first of `keys`, which follow each other evenly and
  /// reach over window(); with a single key the instant of that one. Has a turn of `turns` while
  /// the shared renderer works, not while this sensor denoises and converts. `previous` is the
  /// first key of the frame before, for motion. Null if the progress callback ended it.
  std::shared_ptr<const CameraFrame> capture(Renderer& renderer, RenderTurns& turns,
                                             std::span<const PoseFrame* const> keys,
                                             const PoseFrame& previous, int64_t frame_index);
  std::shared_ptr<const CameraFrame> capture(Renderer& renderer, RenderTurns& turns,
                                             const PoseFrame& now, const PoseFrame& previous,
                                             int64_t frame_index) {
    const PoseFrame* const key = &now;
    return capture(renderer, turns, {&key, 1}, previous, frame_index);
  }
  /// Announces that the next capture is of the same instant as the last one, or not. If its pose is
  /// the same too, it adds samples to the picture: the light is the mean over the captures since
  /// the first, which it replaces (that one's samples may lie at pixel centres). Not for the
  /// interactive tier, which has a history of its own, for adaptive samples or for events.
  void set_same_instant(bool same) { same_instant_ = same; }
  /// Pictures have draws of their own even where the camera stands still and a denoiser is on: of
  /// stills, which are no frames of one video.
  void set_draws_by_index(bool by_index) { draws_by_index_ = by_index; }
  /// From the first row's exposure to the end of the last one's [s]; 0 = an instant.
  Rational window() const;

  /// Exposure value of a meter, before a capture; without it the exposure is the camera's own.
  void set_ev100(double ev100) { models_->set_ev100(ev100); }
  /// Track for the output events, else null.
  const std::shared_ptr<EventTrack>& events() const { return models_->events(); }
  /// Before the first capture; `leads` as of EventTrack::see.
  void share_events(std::shared_ptr<EventTrack> events, bool leads) {
    models_->share_events(std::move(events), leads);
  }
  /// The scene's [[temperature]]s, for the output thermal. Error: one that fits nothing.
  Status set_temperatures(const std::vector<TemperatureOptions>& temperatures) {
    return models_->set_temperatures(temperatures);
  }
  /// Progress callback for the rendering of each picture, see RenderSettings::progress. It may also
  /// end the denoising, which is then no part of the picture.
  void set_progress(std::function<bool(double done)> progress);
  /// Wall time spent waiting for turns at the renderer, over all pictures [s].
  double waited() const { return use_.waited; }
  /// Statistics of the last picture.
  const RenderStats& stats() const { return stats_; }
  const Intrinsics& intrinsics() const { return intrinsics_; }
  const Rational& rate() const { return rate_; }
  const CameraSensing& sensing() const {
    return description_.cameras[static_cast<size_t>(camera_)].sensing;
  }
  /// To be compared with memory_room() before the first picture.
  PictureMemory memory() const;
  /// Pose of the free camera in the world; may be set from any thread.
  void set_free_pose(const Pose& X_WC);
  Pose free_pose() const;

 private:
  CameraSensor(const RenderDescription& description, int camera, const CameraChannels& channels);
  /// The light of the next picture, in a turn at the renderer; null = as denoise() gives it.
  std::vector<Vec3f>* render(Renderer& renderer, RenderTurns& turns, const CameraView& view,
                             std::span<const PoseFrame* const> keys, const PoseFrame& previous);
  /// Leaves to the renderer what it can finish of the next picture: nothing then is copied for
  /// that.
  void plan_finish(Renderer& renderer);
  /// The film's light, denoised where it is to be.
  std::vector<Vec3f>* denoise();
  Shutter shutter(std::span<const PoseFrame* const> keys) const;
  /// Which random numbers a picture is made of. A denoised one has the same as the one before while
  /// the camera stands still, so that what rests in it does not swim, and others where it has
  /// moved, so that no pattern moves along with it. An event camera sees changes: it has the same
  /// always. Pictures that keep their noise have their own, so that their mean converges.
  uint32_t draws(const CameraView& view, int64_t frame_index) const;
  void begin_samples(const CameraView& view);
  /// Tells, once in a run, that a denoiser cannot mend a picture of so few samples.
  void warn_of_noise(Renderer& renderer);
  void accumulate();
  /// `light`: that of the finished picture; null = as denoise() gives it.
  void convert(const PoseFrame& now, int64_t frame_index, const CameraView& view,
               std::vector<Vec3f>* light, CameraFrame* frame);
  const CameraDescription& camera() const {
    return description_.cameras[static_cast<size_t>(camera_)];
  }

  const RenderDescription& description_;
  const int camera_;
  const CameraChannels channels_;
  RenderSettings settings_;
  RenderStats stats_;
  RenderUse use_;
  Intrinsics intrinsics_;
  Rational rate_;
  std::unique_ptr<CameraModels> models_;  // models after the light
  std::unique_ptr<ViewHistory> history_;  // history of the interactive tier
  std::optional<LensDrops> drops_;
  bool denoises_ = false;                      // false: the samples as they are
  RenderDevice device_ = RenderDevice::kAuto;  // of the renderer
  bool needs_exact_ = false;                   // exact channels, by outputs or particles
  bool needs_details_ = false;                 // their details, by outputs
  std::unique_ptr<Denoiser> denoiser_;  // where the renderer does not denoise; made when needed
  Film film_;
  std::vector<Vec3f> clean_;
  bool same_instant_ = false, draws_by_index_ = false;
  Affine3f accumulated_from_;   // pose of the camera
  int pictures_ = 0;            // in a row of one instant from one pose
  std::vector<Vec3f> sums_[3];  // sums of radiance, albedo and normal over them
  mutable std::mutex pose_mutex_;
  Affine3f free_pose_, previous_free_pose_;
};

/// Rigid pose <-> affine map.
Pose to_pose(const Affine3f& X);
Affine3f to_affine(const Pose& X);
/// Between the world and a render scene whose origin is there (RenderDescription::origin).
Pose in_world(const Affine3f& X, const Vec3& origin);
Pose from_origin(const Pose& X_W, const Vec3& origin);

}  // namespace gloam
