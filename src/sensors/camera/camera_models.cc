#include "sensors/camera/camera_models.h"

#include <fmt/format.h>

#include "geometry/lens.h"
#include "render/film/tone_map.h"
#include "sensors/timing.h"

namespace gloam {

Exposure fixed_exposure(const CameraSensing& sensing, double ev100) {
  if (!sensing.imager || !sensing.imager->exposure)
    return exposure_at(ev100, ExposureOptions().f_number);
  const ExposureOptions& exposure = *sensing.imager->exposure;
  return {exposure.f_number, exposure.shutter, exposure.iso};
}

Exposure metered_exposure(const CameraSensing& sensing, double f_number, double ev100) {
  return sensing.imager && sensing.imager->auto_exposure
             ? program_exposure(ev100, f_number, *sensing.imager->auto_exposure)
             : exposure_at(ev100, f_number);
}

Result<std::unique_ptr<CameraModels>> CameraModels::create(const RenderDescription& description,
                                                           int camera, const Intrinsics& intrinsics,
                                                           const CameraChannels& channels,
                                                           double ev100, uint64_t seed) {
  std::unique_ptr<CameraModels> models(new CameraModels(description, camera, intrinsics, channels));
  const CameraSensing& sensing = models->sensing_;
  const std::string& name = description.cameras[static_cast<size_t>(camera)].name;
  if (const CameraChannel* channel = channels.without_model(sensing); channel != nullptr) {
    return Error{ErrorKind::kInput,
                 fmt::format("camera '{}' has no {} for the output '{}'", name, channel->model,
                             channel->name),
                 {},
                 fmt::format("add a [camera.{}] to the scene (docs/sensors.md)", channel->model)};
  }
  if (channels.has("sensor_depth") && (intrinsics.orthographic || is_wide(intrinsics.lens))) {
    return Error{
        ErrorKind::kInput,
        fmt::format("camera '{}' does not support stereo depth: disparity requires a lens that "
                    "preserves straight lines",
                    name),
        {},
        "use the lens pinhole, plumb_bob or rational_polynomial with [camera.stereo_depth]"};
  }
  const bool own = sensing.imager && sensing.imager->exposure;
  models->exposure_ = fixed_exposure(sensing, ev100);
  models->seed_ = seed;
  models->ev100_ = own ? models->exposure_.ev100() : ev100;
  if (sensing.imager && (channels.has("rgb") || channels.has("raw")))
    models->imager_ = std::make_unique<Imager>(*sensing.imager, intrinsics, seed);
  if (channels.has("sensor_depth")) models->stereo_ = stereo_depth_model(*sensing.stereo_depth);
  if (channels.has("events"))
    models->events_ = std::make_shared<EventTrack>(
        EventCamera(*sensing.events, intrinsics.width, intrinsics.height, seed));
  if (channels.has("sensor_depth") || channels.has("thermal")) {
    GLOAM_TRY(models->air_, SensorAir::make(description));
  }
  GLOAM_TRY_STATUS(models->set_temperatures({}));
  return models;
}

Status CameraModels::set_temperatures(const std::vector<TemperatureOptions>& temperatures) {
  if (!channels_.has("thermal")) return {};
  GLOAM_TRY(thermal_, ThermalCamera::make(*sensing_.thermal, temperatures, description_, seed_));
  return {};
}

void CameraModels::set_ev100(double ev100) {
  exposure_ = metered_exposure(sensing_, exposure_.f_number, ev100);
  ev100_ = exposure_.ev100();
}

uint64_t CameraModels::memory() const {
  const auto pixels =
      static_cast<uint64_t>(intrinsics_.width) * static_cast<uint64_t>(intrinsics_.height);
  constexpr uint64_t kEvents = 20, kStereo = 14;  // [bytes] of a pixel
  return (imager_ ? Imager::memory(*sensing_.imager, intrinsics_) : 0) +
         (events_ ? kEvents * pixels : 0) + (stereo_ ? kStereo * pixels : 0);
}

double CameraModels::delivery_of(int64_t k, double time) const {
  return sensing_.timing ? delivery_time(*sensing_.timing, seed_, k, time) : time;
}

void CameraModels::develop(const std::vector<Vec3f>& radiance, int64_t run, CameraFrame* frame) {
  frame->ev100 = ev100_;
  if (imager_) {
    imager_->develop(radiance, exposure_, frame->index,
                     channels_.has("rgb") ? &frame->rgb : nullptr,
                     channels_.has("raw") ? &frame->raw : nullptr);
  } else if (channels_.has("rgb")) {
    tone_map(radiance, intrinsics_.width, intrinsics_.height, {.ev100 = static_cast<float>(ev100_)},
             &frame->rgb);
  }
  if (events_) {
    const double top = static_cast<double>(max_luminance(static_cast<float>(ev100_)));
    frame->events = events_->see({run, frame->index}, frame->time, radiance, top, leads_events_);
  }
}

void CameraModels::measure(const PoseFrame& now, const Film& film, const CameraView& view,
                           CameraFrame* frame) {
  if (!stereo_ && !thermal_) return;
  air_.follow(description_, now);
  if (stereo_) {
    const std::vector<float> signal = stereo_->half_signal > 0
                                          ? projector_signal(description_, air_.view(), film, view)
                                          : std::vector<float>();
    frame->sensor_depth = measure_stereo_depth(*stereo_, intrinsics_, film.depth, signal,
                                               seed_ ^ sensing_.stereo_depth->seed, frame->index);
  }
  if (thermal_) frame->thermal = thermal_->see(film, view, frame->index, air_.view());
}

}  // namespace gloam
