#include "sensors/camera_models.h"

#include <fmt/format.h>

#include "render/film/tone_map.h"

namespace gloam {
namespace {

Exposure own_exposure(const ImagerOptions& imager) {
  const ExposureOptions& exposure = *imager.exposure;
  return {exposure.f_number, exposure.shutter, exposure.iso};
}

}  // namespace

Result<std::unique_ptr<CameraModels>> CameraModels::create(const RenderDescription& description,
                                                           int camera, const Intrinsics& intrinsics,
                                                           const ModelOutputs& outputs,
                                                           double ev100, uint64_t seed) {
  std::unique_ptr<CameraModels> models(new CameraModels(description, camera, intrinsics, outputs));
  const CameraSensing& sensing = models->sensing_;
  const auto refuse = [&](const char* output, const char* table) {
    return Error{ErrorKind::kInput,
                 fmt::format("camera '{}' has no {} for the output '{}'",
                             description.cameras[static_cast<size_t>(camera)].name, table, output),
                 {},
                 fmt::format("add a [camera.{}] to the scene (docs/sensors.md)", table)};
  };
  if (outputs.raw && !sensing.imager) return refuse("raw", "imager");
  const bool own = sensing.imager && sensing.imager->exposure;
  models->exposure_ =
      own ? own_exposure(*sensing.imager) : exposure_at(ev100, ExposureOptions().f_number);
  models->ev100_ = own ? models->exposure_.ev100() : ev100;
  if (sensing.imager && (outputs.rgb || outputs.raw))
    models->imager_ = std::make_unique<Imager>(*sensing.imager, intrinsics, seed);
  return models;
}

void CameraModels::set_ev100(double ev100) {
  const double f_number = exposure_.f_number;
  exposure_ = sensing_.imager && sensing_.imager->auto_exposure
                  ? program_exposure(ev100, f_number, *sensing_.imager->auto_exposure)
                  : exposure_at(ev100, f_number);
  ev100_ = exposure_.ev100();
}

uint64_t CameraModels::memory() const {
  return imager_ ? Imager::memory(*sensing_.imager, intrinsics_) : 0;
}

void CameraModels::develop(const std::vector<Vec3f>& radiance, CameraFrame* frame) {
  frame->ev100 = ev100_;
  if (imager_) {
    imager_->develop(radiance, exposure_, frame->index, outputs_.rgb ? &frame->rgb : nullptr,
                     outputs_.raw ? &frame->raw : nullptr);
  } else if (outputs_.rgb) {
    tone_map(radiance, intrinsics_.width, intrinsics_.height, {.ev100 = static_cast<float>(ev100_)},
             &frame->rgb);
  }
}

void CameraModels::measure(const Film&, const CameraView&, CameraFrame*) {}

}  // namespace gloam
