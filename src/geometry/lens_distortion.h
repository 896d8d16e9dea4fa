#pragma once
// Distortion of lenses and its inverse. A picture point (x, y) is in focal lengths. T: float in
// kernels, double for checks. Device-safe. geometry/lens.h names the sources.

#include <cmath>

#include "base/device.h"
#include "gloam/camera.h"

namespace gloam {

template <class T>
struct LensOf {
  LensModel model = LensModel::kPinhole;
  T d[8] = {};  ///< as Intrinsics::distortion
  /// Distance from the axis up to which the model is one to one: plumb_bob and rational_polynomial:
  /// tangent of the angle, equidistant: the angle [rad]. lens_reach() computes it.
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

/// Radius of a fisheye's picture at the angle `theta`, and its derivative.
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

}  // namespace gloam
