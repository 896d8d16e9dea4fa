#include "scene/validate/validate_imager.h"

#include <fmt/format.h>

namespace gloam {
namespace {

Error wrong(const std::string& camera, const std::string& what, const SourceLoc& loc,
            std::string hint) {
  return {ErrorKind::kInput, fmt::format("camera '{}': {}", camera, what), loc, std::move(hint)};
}

Status validate_imager(const std::string& camera, const ImagerOptions& imager) {
  if (imager.pixel) {
    const PixelOptions& pixel = *imager.pixel;
    if (pixel.bits == 0 && pixel.black_level > 0)
      return wrong(camera, "'black_level' needs 'bits'", pixel.loc, "set 'bits' of the converter");
    if (pixel.bits > 0 && pixel.black_level >= 1 << (pixel.bits - 1)) {
      return wrong(
          camera,
          fmt::format("'black_level' is {}, which is not below half of the {} pixel values",
                      pixel.black_level, 1 << pixel.bits),
          pixel.loc, "a typical black level is one sixteenth of the range");
    }
  }
  if (imager.auto_exposure && imager.auto_exposure->min_ev100 > imager.auto_exposure->max_ev100)
    return wrong(camera, "'min_ev100' is greater than 'max_ev100'", imager.auto_exposure->loc, "");
  return {};
}

Status validate_stereo_depth(const std::string& camera, const StereoDepthOptions& depth) {
  if (depth.preset == "none" && !depth.baseline)
    return wrong(camera, "stereo_depth needs 'baseline'", depth.loc,
                 "set it, or use a preset: d435, kinect");
  if (depth.baseline && *depth.baseline == 0)
    return wrong(camera, "a baseline of 0 m has no disparity", depth.loc, "");
  if (depth.min_range && depth.max_range && *depth.max_range > 0 &&
      *depth.min_range >= *depth.max_range)
    return wrong(camera, "'min_range' must be less than 'max_range'", depth.loc, "");
  return {};
}

Status validate_rig(const RigOptions& rig, const SourceLoc& loc) {
  if (rig.look_at && rig.orientation)
    return Error{ErrorKind::kInput,
                 fmt::format("rig '{}' has both 'look_at' and 'orientation'", rig.name), loc,
                 "specify only one of them"};
  if (rig.look_at && *rig.look_at == rig.position)
    return Error{ErrorKind::kInput, fmt::format("rig '{}' looks at its own position", rig.name),
                 loc, "change 'look_at' or 'position'"};
  return {};
}

}  // namespace

Status validate_sensing(const std::string& camera, const CameraSensing& sensing) {
  if (sensing.imager) GLOAM_TRY_STATUS(validate_imager(camera, *sensing.imager));
  if (sensing.stereo_depth) GLOAM_TRY_STATUS(validate_stereo_depth(camera, *sensing.stereo_depth));
  if (sensing.thermal && sensing.thermal->min >= sensing.thermal->max)
    return wrong(camera, "'min' of [camera.thermal] must be less than 'max'", sensing.thermal->loc,
                 "");
  return {};
}

Status validate_rigs(const Scene& scene) {
  for (const StereoOptions& stereo : scene.stereo) {
    GLOAM_TRY_STATUS(validate_rig(stereo, stereo.loc));
    GLOAM_TRY_STATUS(validate_sensing(stereo.name, stereo.sensing));
  }
  for (const RgbdOptions& rgbd : scene.rgbd) {
    GLOAM_TRY_STATUS(validate_rig(rgbd, rgbd.loc));
    GLOAM_TRY_STATUS(validate_sensing(rgbd.name, rgbd.sensing));
    GLOAM_TRY_STATUS(validate_stereo_depth(rgbd.name, rgbd.depth));
  }
  return {};
}

}  // namespace gloam
