#include "geometry/lens.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/angle.h"

namespace gloam {
namespace {

constexpr double kMaxPinholeAngle =
    89.4 * kDegree;                    // limit of models that have no angle beyond a right one
constexpr double kNarrowFisheye = 80;  // [deg] that a fisheye sees at least on each side

/// True if the picture still grows with the angle from the axis at `angle` [rad].
bool grows(const LensOf<double>& lens, double angle) {
  double slope;
  if (lens.model == LensModel::kEquidistant) {
    lenses::fisheye(lens, angle, &slope);
    return slope > 0;
  }
  const double r = std::tan(angle), factor = lenses::radial(lens, r * r, &slope);
  return std::isfinite(factor) && factor > 0 && factor + 2 * r * r * slope > 0;
}

/// The angle up to which the picture grows [rad].
double widest_angle(const LensOf<double>& lens) {
  const double end =
      lens.model == LensModel::kEquidistant ? lenses::kHalfTurn<double> : kMaxPinholeAngle;
  constexpr int kSteps = 1000;
  double low = 0, high = end;
  for (int i = 1; i <= kSteps; ++i) {
    high = end * i / kSteps;
    if (!grows(lens, high)) break;
    low = high;
  }
  if (low == high) return end;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (grows(lens, middle) ? low : high) = middle;
  }
  return low;
}

bool is_folding(LensModel model) {
  return model != LensModel::kPinhole && model != LensModel::kEquirectangular;
}

}  // namespace

double lens_reach(const LensOf<double>& lens) {
  if (!is_folding(lens.model)) return 0;
  const double angle = widest_angle(lens);
  return lens.model == LensModel::kEquidistant ? angle : std::tan(angle);
}

PixelRays::PixelRays(const Intrinsics& intrinsics)
    : intrinsics_(intrinsics), lens_(make_lens<double>(intrinsics)) {}

std::optional<PixelRay> PixelRays::at(double u, double v) const {
  const Intrinsics& k = intrinsics_;
  const double x = (u - k.cx) / k.fx, y = (v - k.cy) / k.fy;
  if (k.orthographic) return PixelRay{.p_C = {x, -y, 0}, .d_C = {0, 0, -1}};
  double X, Y, Z, angle;
  if (!lens_unproject(lens_, x, y, &X, &Y, &Z, &angle)) return std::nullopt;
  return PixelRay{.d_C = {X, -Y, -Z}, .depth_share = is_wide(k.lens) ? 1 : Z};
}

std::optional<PixelRay> pixel_ray(const Intrinsics& intrinsics, double u, double v) {
  return PixelRays(intrinsics).at(u, v);
}

std::string lens_fault(const Intrinsics& k) {
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!(k.fx > 0 && k.fy > 0) || !finite(k.fx) || !finite(k.fy))
    return fmt::format("its focal lengths must be positive, got {} and {} px", k.fx, k.fy);
  if (!finite(k.cx) || !finite(k.cy) ||
      !std::all_of(k.distortion.begin(), k.distortion.end(), finite)) {
    return "a parameter of its lens is not finite";
  }
  if (!is_folding(k.lens)) return {};
  const auto lens = make_lens<double>(k);
  if (k.lens == LensModel::kEquidistant) {
    if (lens.reach >= kNarrowFisheye * kDegree) return {};
    double slope;
    const double radius = lenses::fisheye(lens, lens.reach, &slope);
    const double corner =
        std::hypot(std::max(k.cx, k.width - k.cx) / k.fx, std::max(k.cy, k.height - k.cy) / k.fy);
    if (radius >= corner) return {};
    return fmt::format(
        "its distortion folds within the image: beyond {:.1f} degrees off the axis, {:.0f} px from "
        "the centre, the image radius decreases with the angle",
        lens.reach / kDegree, radius * k.fx);
  }
  // Whatever is seen inside is seen if the border is: walk around it.
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = static_cast<double>(i) / kSteps;
    const double border[4][2] = {{s * k.width, 0},
                                 {s * k.width, 1.0 * k.height},
                                 {0, s * k.height},
                                 {1.0 * k.width, s * k.height}};
    for (const auto& [u, v] : border) {
      double X, Y, Z, angle;
      if (lens_unproject(lens, (u - k.cx) / k.fx, (v - k.cy) / k.fy, &X, &Y, &Z, &angle)) continue;
      return fmt::format(
          "its distortion folds within the image: pixel ({:.0f}, {:.0f}) has no ray; the model is "
          "valid up to {:.1f} degrees off the axis",
          u, v, std::atan(lens.reach) / kDegree);
    }
  }
  return {};
}

}  // namespace gloam
