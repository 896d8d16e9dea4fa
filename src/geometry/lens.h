#pragma once
// Lens models: directions to the picture and back. O is the camera's optical frame: X right, Y
// down, Z forward. A picture point (x, y) is in focal lengths: u = cx + fx x, v = cy + fy y.
// T: float in kernels, double for checks. Device-safe.
//
// Sources: Brown, "Decentering distortion of lenses" (1966) in the form of OpenCV's and ROS's
// plumb_bob and rational_polynomial; Kannala and Brandt, "A generic camera model and calibration
// method for conventional, wide-angle, and fish-eye lenses" (2006) as ROS's equidistant.

#include <cmath>
#include <optional>
#include <string>

#include "base/device.h"
#include "base/vec.h"
#include "geometry/lens_distortion.h"
#include "geometry/mesh/single.h"
#include "gloam/camera.h"

namespace gloam {

/// Projects the direction (X, Y, Z) of O to the picture; false where the lens does not see it.
template <class T>
GLOAM_HD bool lens_project(const LensOf<T>& lens, T X, T Y, T Z, T* x, T* y) {
  if (lens.model == LensModel::kEquirectangular) {
    const T level = std::sqrt(X * X + Z * Z);
    *x = std::atan2(X, Z);
    *y = std::atan2(Y, level);
    return level > 0 || Y != 0;
  }
  if (lens.model == LensModel::kEquidistant) {
    const T across = std::sqrt(X * X + Y * Y), theta = std::atan2(across, Z);
    if (theta > lens.reach) return false;
    T slope;
    const T radius = lenses::fisheye(lens, theta, &slope);
    const T scale = across > 0 ? radius / across : T(0);
    *x = X * scale;
    *y = Y * scale;
    return true;
  }
  if (!(Z > T(1e-9))) return false;
  *x = X / Z;
  *y = Y / Z;
  if (lens.model == LensModel::kPinhole) return true;
  if (*x * *x + *y * *y > lens.reach * lens.reach) return false;
  const auto at = lenses::distort(lens, *x, *y);
  *x = at.x;
  *y = at.y;
  return at.determinant() > 0;
}

/// The unit direction seen at (x, y); false where the lens sees nothing. `angle`: that a length of
/// 1 in the picture spans there [rad], the mean of all directions.
template <class T>
GLOAM_HD bool lens_unproject(const LensOf<T>& lens, T x, T y, T* X, T* Y, T* Z, T* angle) {
  if (lens.model == LensModel::kEquirectangular) {
    const T level = std::cos(y);
    *X = std::sin(x) * level;
    *Y = std::sin(y);
    *Z = std::cos(x) * level;
    *angle = std::sqrt(level > T(1e-3) ? level : T(1e-3));
    const T most = lenses::kHalfTurn<T> * T(1.000001);
    return std::fabs(x) <= most && std::fabs(y) <= T(0.5) * most;
  }
  if (lens.model == LensModel::kEquidistant) {
    const T radius = std::sqrt(x * x + y * y);
    T slope;
    if (radius > lenses::fisheye(lens, lens.reach, &slope)) return false;
    const T theta = lenses::rising_root(radius, lens.reach, [&](T at, T* at_slope) {
      return lenses::fisheye(lens, at, at_slope) - radius;
    });
    lenses::fisheye(lens, theta, &slope);
    const T sine = std::sin(theta), scale = radius > 0 ? sine / radius : T(1);
    *X = x * scale;
    *Y = y * scale;
    *Z = std::cos(theta);
    *angle = std::sqrt(scale / (slope > T(1e-3) ? slope : T(1e-3)));
    return true;
  }
  T stretch = 1;
  if (lens.model != LensModel::kPinhole) {
    lenses::Distorted<T> there;
    if (!lenses::undistort(lens, x, y, &x, &y, &there)) return false;
    stretch = there.determinant();
  }
  const T scale = T(1) / std::sqrt(T(1) + x * x + y * y);
  *X = x * scale;
  *Y = y * scale;
  *Z = scale;
  *angle = scale / std::sqrt(stretch > T(1e-3) ? stretch : T(1e-3));
  return true;
}

/// Finds LensOf::reach: where the model folds, or ends. Host only.
double lens_reach(const LensOf<double>& lens);

/// The lens of a camera, its reach found.
template <class T>
LensOf<T> make_lens(const Intrinsics& intrinsics) {
  LensOf<double> lens;
  lens.model = intrinsics.lens;
  for (int i = 0; i < 8; ++i) lens.d[i] = intrinsics.distortion[static_cast<size_t>(i)];
  lens.reach = lens_reach(lens);
  LensOf<T> out;
  out.model = lens.model;
  for (int i = 0; i < 8; ++i) out.d[i] = static_cast<T>(lens.d[i]);
  out.reach = static_cast<T>(lens.reach);
  return out;
}

/// Rays of a camera's pixels: the lens's, whatever it is. For many pixels of one camera;
/// pixel_ray() of gloam/camera.h for a single one. Host only.
class PixelRays {
 public:
  explicit PixelRays(const Intrinsics& intrinsics);
  std::optional<PixelRay> at(double u, double v) const;

 private:
  Intrinsics intrinsics_;
  LensOf<double> lens_;
};

/// Reason why the camera's lens cannot be right: focal lengths that are not positive, coefficients
/// that are not finite, a distortion that folds within the picture. Empty = nothing is wrong.
std::string lens_fault(const Intrinsics& intrinsics);

}  // namespace gloam
