#include "scene/camera_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/lens.h"

namespace gloam {
namespace {

struct ModelName {
  const char* name;
  LensModel model;
  size_t most;   ///< coefficients
  size_t least;  ///< if there are any
};
constexpr ModelName kModels[] = {{"pinhole", LensModel::kPinhole, 0, 0},
                                 {"plumb_bob", LensModel::kPlumbBob, 5, 4},
                                 {"rational_polynomial", LensModel::kRationalPolynomial, 8, 8},
                                 {"equidistant", LensModel::kEquidistant, 4, 4},
                                 {"equirectangular", LensModel::kEquirectangular, 0, 0}};

const ModelName& model_of(const LensOptions& lens) {
  return *std::find_if(std::begin(kModels), std::end(kModels),
                       [&](const ModelName& m) { return lens.model == m.name; });
}

Error refuse(const CameraOptions& camera, std::string what, std::string hint = {}) {
  const SourceLoc& loc = camera.lens->loc.line > 0 ? camera.lens->loc : camera.loc;
  return {ErrorKind::kInput, fmt::format("the lens of camera '{}' {}", camera.name, what), loc,
          std::move(hint)};
}

/// Focal lengths where none are given: the vertical field of view stays that of the pinhole.
void set_default_focus(Intrinsics* k) {
  constexpr double kPi = 3.14159265358979323846;
  if (k->lens == LensModel::kEquirectangular) {
    k->fx = k->width / (2 * kPi);
    k->fy = k->height / kPi;
    return;
  }
  if (k->lens != LensModel::kEquidistant) return;
  double slope;
  const double half_height = 0.5 * k->height, half_angle = std::atan(half_height / k->fy);
  k->fx = k->fy = half_height / lenses::fisheye(make_lens<double>(*k), half_angle, &slope);
}

}  // namespace

Status validate_lens(const CameraOptions& camera) {
  if (!camera.lens) return {};
  const LensOptions& lens = *camera.lens;
  const ModelName& model = model_of(lens);
  if (lens.d.size() > model.most || (!lens.d.empty() && lens.d.size() < model.least)) {
    return refuse(
        camera,
        fmt::format("has {} coefficients 'd'; {} takes {}", lens.d.size(), model.name,
                    model.least == model.most ? fmt::format("{}", model.most)
                                              : fmt::format("{} or {}", model.least, model.most)),
        "the order is the same as in ROS CameraInfo: docs/cameras.md");
  }
  if (lens.sensor_size && (lens.fx || lens.fy))
    return refuse(camera, "has both 'sensor_size' and 'fx' or 'fy'", "specify only one of them");
  if (lens.fy && !lens.fx) return refuse(camera, "has 'fy' but no 'fx'");
  if (lens.sensor_size && !lens.focal_length)
    return refuse(camera, "has 'sensor_size' but no 'focal_length'");
  if (lens.focal_length && !lens.sensor_size && !lens.f_number)
    return refuse(camera, "has 'focal_length' but no 'sensor_size'",
                  "specify it, or 'fx' and 'fy' in pixels");
  if (lens.model == "equirectangular" && (lens.focal_length || lens.f_number))
    return refuse(camera, "is a panorama and has no focal length or aperture");
  if (lens.f_number.has_value() != lens.focus_distance.has_value())
    return refuse(camera, "needs both 'f_number' and 'focus_distance'");
  if (lens.f_number && !lens.focal_length)
    return refuse(camera, "has 'f_number' but no 'focal_length'",
                  "the aperture diameter is focal_length / f_number");
  if (lens.focus_distance && *lens.focus_distance <= *lens.focal_length)
    return refuse(camera, "must focus farther away than its focal length");
  return {};
}

Status apply_lens(const CameraOptions& camera, Intrinsics* k) {
  if (!camera.lens) return {};
  const LensOptions& lens = *camera.lens;
  if (k->orthographic) return refuse(camera, "cannot be used: the camera is orthographic");
  k->lens = model_of(lens).model;
  k->distortion = {};
  std::copy(lens.d.begin(), lens.d.end(), k->distortion.begin());
  if (lens.fx) {
    k->fx = *lens.fx;
    k->fy = lens.fy.value_or(*lens.fx);
  } else if (lens.sensor_size) {
    k->fx = *lens.focal_length / (*lens.sensor_size)[0] * k->width;
    k->fy = *lens.focal_length / (*lens.sensor_size)[1] * k->height;
  } else {
    set_default_focus(k);
  }
  k->cx = lens.cx.value_or(0.5 * k->width);
  k->cy = lens.cy.value_or(0.5 * k->height);
  if (const std::string fault = lens_fault(*k); !fault.empty()) {
    return refuse(camera, "is invalid: " + fault,
                  "check the order and signs of 'd', fx and fy, and the image size");
  }
  return {};
}

}  // namespace gloam
