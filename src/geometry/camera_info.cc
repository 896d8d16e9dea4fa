#include <algorithm>

#include "gloam/camera.h"

namespace gloam {

CameraInfo camera_info(const std::string& camera, const Intrinsics& k) {
  CameraInfo info;
  info.frame_id = camera + "_optical_frame";
  info.width = k.width;
  info.height = k.height;
  size_t coefficients = 0;
  switch (k.lens) {
    case LensModel::kPinhole:
    case LensModel::kPlumbBob:
      info.distortion_model = "plumb_bob";
      coefficients = 5;
      break;
    case LensModel::kRationalPolynomial:
      info.distortion_model = "rational_polynomial";
      coefficients = 8;
      break;
    case LensModel::kEquidistant:
      info.distortion_model = "equidistant";
      coefficients = 4;
      break;
    case LensModel::kEquirectangular:
      info.distortion_model = "equirectangular";
      break;
  }
  if (k.orthographic) {
    info.distortion_model = "orthographic";
    coefficients = 0;
  }
  info.d.assign(k.distortion.begin(), k.distortion.begin() + coefficients);
  const double cx = k.cx - 0.5, cy = k.cy - 0.5;
  info.k = {k.fx, 0, cx, 0, k.fy, cy, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {k.fx, 0, cx, 0, 0, k.fy, cy, 0, 0, 0, 1, 0};
  return info;
}

Pose optical_pose(const Pose& X_WC) {
  // Half a turn about the camera's own x: q * (0, 1, 0, 0).
  const Quat& q = X_WC.q;
  return {X_WC.p, {0 - q.x, q.w, q.z, 0 - q.y}};  // 0 - x: no minus zeros in tables
}

}  // namespace gloam
