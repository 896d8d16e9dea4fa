#pragma once
// The models of one camera that come after the light, in a row: imager, stereo depth, events,
// thermal. A camera without them puts out what it always did, bit by bit.

#include <memory>
#include <optional>
#include <vector>

#include "gloam/camera.h"
#include "gloam/result.h"
#include "render/film/film.h"
#include "render/renderer.h"
#include "sensors/camera/camera_channels.h"
#include "sensors/depth/stereo_depth.h"
#include "sensors/event/event_track.h"
#include "sensors/imager/imager.h"
#include "sensors/sensor_air.h"
#include "sensors/thermal/thermal_camera.h"
#include "world/render_description.h"

namespace gloam {

/// Exposure of a camera without a meter: its imager's, else that of `ev100`.
Exposure fixed_exposure(const CameraSensing& sensing, double ev100);
/// Exposure for what a meter says [EV], with the f-number of the fixed one.
Exposure metered_exposure(const CameraSensing& sensing, double f_number, double ev100);

class CameraModels {
 public:
  /// Makes the models of camera row `camera`; `ev100` where its imager does not say, `seed` of
  /// sensor_seed(). Errors: an output without its table in the scene.
  static Result<std::unique_ptr<CameraModels>> create(const RenderDescription& description,
                                                      int camera, const Intrinsics& intrinsics,
                                                      const CameraChannels& channels, double ev100,
                                                      uint64_t seed);

  void set_ev100(double ev100);
  /// The scene's [[temperature]]s, for thermal cameras. Error: one that fits nothing.
  Status set_temperatures(const std::vector<TemperatureOptions>& temperatures);
  double ev100() const { return ev100_; }
  /// Whether `rgb` is the plain tone map of the light, and no model needs the light itself.
  bool shows_light() const {
    return channels_.has("rgb") && imager_ == nullptr && events_ == nullptr;
  }
  uint64_t memory() const;
  /// Track for the output events, else null: the camera's own until it is given one that others
  /// share.
  const std::shared_ptr<EventTrack>& events() const { return events_; }
  void share_events(std::shared_ptr<EventTrack> events, bool leads) {
    events_ = std::move(events);
    leads_events_ = leads;
  }

  /// When frame k arrives that was taken at `time` [s].
  double delivery_of(int64_t k, double time) const;
  /// Fills rgb, raw and events from light [cd/m²], (height x width). The frame's index and time are
  /// set; `run` counts the resets before it.
  void develop(const std::vector<Vec3f>& radiance, int64_t run, CameraFrame* frame);
  /// Fills sensor_depth and thermal from the exact channels, and the air at `now`.
  void measure(const PoseFrame& now, const Film& film, const CameraView& view, CameraFrame* frame);

 private:
  CameraModels(const RenderDescription& description, int camera, const Intrinsics& intrinsics,
               const CameraChannels& channels)
      : description_(description),
        sensing_(description.cameras[static_cast<size_t>(camera)].sensing),
        intrinsics_(intrinsics),
        channels_(channels) {}

  const RenderDescription& description_;
  const CameraSensing sensing_;
  const Intrinsics intrinsics_;
  const CameraChannels channels_;
  uint64_t seed_ = 0;
  double ev100_ = 0;
  Exposure exposure_;  // exposure of that value, for the imager
  std::unique_ptr<Imager> imager_;
  std::optional<StereoDepthModel> stereo_;
  std::shared_ptr<EventTrack> events_;
  bool leads_events_ = true;
  std::optional<ThermalCamera> thermal_;
  SensorAir air_;  // air of these two
};

}  // namespace gloam
