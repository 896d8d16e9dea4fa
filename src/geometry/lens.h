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
#include "geometry/mesh/single.h"
#include "gloam/camera.h"

namespace gloam {

template <class T>
struct LensOf {
  LensModel model = LensModel::kPinhole;
  T d[8] = {};  ///< as Intrinsics::distortion
  /// How far from the axis the model is one to one: plumb_bob and rational_polynomial: tangent of
  /// the angle, equidistant: the angle [rad]. lens_reach() tells it.
  T reach = 0;
};

/// Angles are what such a lens divides evenly, nearly: depth along an axis would mean nothing.
GLOAM_HD bool is_wide(LensModel model) {
  return model == LensModel::kEquidistant || model == LensModel::kEquirectangular;
}

namespace lenses {

template <class T>
inline constexpr T kHalfTurn = T(3.14159265358979323846);

/// Radial factor of plumb_bob and rational_polynomial at the squared radius r2, and its derivative.
template <class T>
GLOAM_HD T radial(const LensOf<T>& lens, T r2, T* slope) {
  const T *d = lens.d, k1 = d[0], k2 = d[1], k3 = d[4], k4 = d[5], k5 = d[6], k6 = d[7];
  const T top = T(1) + r2 * (k1 + r2 * (k2 + r2 * k3));
  const T bottom = T(1) + r2 * (k4 + r2 * (k5 + r2 * k6));
  const T top_slope = k1 + r2 * (T(2) * k2 + r2 * T(3) * k3);
  const T bottom_slope = k4 + r2 * (T(2) * k5 + r2 * T(3) * k6);
  *slope = (top_slope * bottom - top * bottom_slope) / (bottom * bottom);
  return top / bottom;
}

/// Of a fisheye: radius in the picture at the angle `theta`, and its derivative.
template <class T>
GLOAM_HD T fisheye(const LensOf<T>& lens, T theta, T* slope) {
  const T* k = lens.d;
  const T t2 = theta * theta;
  *slope = T(1) + t2 * (T(3) * k[0] + t2 * (T(5) * k[1] + t2 * (T(7) * k[2] + t2 * T(9) * k[3])));
  return theta * (T(1) + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

template <class T>
struct Distorted {
  T x, y;            ///< in the picture
  T xx, xy, yx, yy;  ///< derivatives: xy = of x by the undistorted y
  GLOAM_HD T determinant() const { return xx * yy - xy * yx; }
};

template <class T>
GLOAM_HD Distorted<T> distort(const LensOf<T>& lens, T x, T y) {
  const T r2 = x * x + y * y, p1 = lens.d[2], p2 = lens.d[3];
  T slope;
  const T factor = radial(lens, r2, &slope);
  Distorted<T> out;
  out.x = x * factor + T(2) * p1 * x * y + p2 * (r2 + T(2) * x * x);
  out.y = y * factor + p1 * (r2 + T(2) * y * y) + T(2) * p2 * x * y;
  out.xx = factor + T(2) * x * x * slope + T(2) * p1 * y + T(6) * p2 * x;
  out.xy = out.yx = T(2) * x * y * slope + T(2) * p1 * x + T(2) * p2 * y;
  out.yy = factor + T(2) * y * y * slope + T(6) * p1 * y + T(2) * p2 * x;
  return out;
}

/// The root of a rising function in [0, high], by Newton's method within a bracket; `value` gives
/// the function less what is sought, and its slope.
template <class T, class Value>
GLOAM_HD T rising_root(T start, T high, const Value& value) {
  T low = 0, at = start < high ? start : high;
  for (int i = 0; i < 40; ++i) {
    T slope;
    const T off = value(at, &slope);
    if (off == 0) return at;
    if (off > 0) {
      high = at;
    } else {
      low = at;
    }
    T next = slope > 0 ? at - off / slope : low;
    if (!(next > low && next < high)) next = T(0.5) * (low + high);
    const T step = next - at;
    at = next;
    if (std::fabs(step) <= T(1e-7) * at) break;
  }
  return at;
}

/// Undoes distort(); false beyond the lens's reach.
template <class T>
GLOAM_HD bool undistort(const LensOf<T>& lens, T x, T y, T* ux, T* uy, Distorted<T>* there) {
  const T sought = std::sqrt(x * x + y * y);
  const T r = rising_root(sought, lens.reach, [&](T at, T* slope) {
    T factor_slope;
    const T factor = radial(lens, at * at, &factor_slope);
    *slope = factor + T(2) * at * at * factor_slope;
    return at * factor - sought;
  });
  const T scale = sought > 0 ? r / sought : T(1);
  *ux = x * scale;
  *uy = y * scale;
  T miss = 0;
  for (int i = 0; i < 12; ++i) {  // decentering is small: few rounds do
    *there = distort(lens, *ux, *uy);
    const T dx = x - there->x, dy = y - there->y, det = there->determinant();
    miss = std::fabs(dx) + std::fabs(dy);
    if (!(det > 0)) return false;
    if (miss <= T(2e-7) * (T(1) + sought)) break;
    *ux += (there->yy * dx - there->xy * dy) / det;
    *uy += (there->xx * dy - there->yx * dx) / det;
  }
  return miss <= T(1e-5) * (T(1) + sought) &&
         *ux * *ux + *uy * *uy <= lens.reach * lens.reach * T(1.00001);
}

}  // namespace lenses

/// Where the direction (X, Y, Z) of O appears; false where the lens does not see it.
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

/// Why the camera's lens cannot be right: focal lengths that are not positive, coefficients that
/// are not finite, a distortion that folds within the picture. Empty = nothing is wrong.
std::string lens_fault(const Intrinsics& intrinsics);

}  // namespace gloam
