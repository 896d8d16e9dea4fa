#pragma once
// The moving surface of a water: waves of linear theory (Airy 1845), which are a pure function of
// time, and ripples, which are a grid of heights.

#include <span>

#include "instant/surface_heights.h"
#include "world/effects/water_description.h"

namespace gloam {

/// Above the level at rest [m].
double wave_height(const WaterDescription& water, double x, double y, double time);

/// Motion of water by waves at a point.
struct WaveMotion {
  Vec3 velocity;      ///< [m/s], without the current
  Vec3 acceleration;  ///< [m/s²]
};
/// `z`: above the level at rest [m]; above it as at it.
WaveMotion wave_motion(const WaterDescription& water, double x, double y, double z, double time);

/// Ripples at a point [m], linear between the middles of cells.
double ripple_height(const WaterDescription& water, const HeightChange& ripples, double x,
                     double y);

/// Heights at the corners of the water's mesh [m], rows along y, ((ny + 1) x (nx + 1)).
void surface_heights(const WaterDescription& water, const HeightChange& ripples, double time,
                     std::span<float> heights);

/// The surface over a small rectangle, at one time: waves by a parabola through nine points along
/// each axis, which are good to 1 % where it is no longer than a half of the shortest wave, and
/// ripples by the plane that fits them best around it: what a body makes rises beside it.
class SurfacePatch {
 public:
  SurfacePatch(const WaterDescription& water, const HeightChange& ripples, double x, double y,
               double half_x, double half_y, double time);

  /// Nowhere in the rectangle is it higher [m].
  double most() const { return most_; }
  /// z of the surface in the world [m].
  double height(double x, double y) const { return waves(x, y) + ripples(x, y); }
  /// Without ripples.
  double waves(double x, double y) const {
    const double u = within((x - x_) * per_half_x_), v = within((y - y_) * per_half_y_);
    return parabola(parabola(value_[0], u), parabola(value_[1], u), parabola(value_[2], u), v);
  }

 private:
  static double within(double u) {
    u = u < 1 ? u : 1;
    return u > -1 ? u : -1;
  }
  // Through f(-1), f(0), f(1).
  static double parabola(double a, double b, double c, double u) {
    return b + u * ((c - a) / 2 + u * ((a + c) / 2 - b));
  }
  static double parabola(const double* f, double u) { return parabola(f[0], f[1], f[2], u); }
  double ripples(double x, double y) const {
    return ripple_[0] + ripple_[1] * (x - x_) + ripple_[2] * (y - y_);
  }
  void fit_ripples(const WaterDescription& water, const HeightChange& ripples);

  double x_, y_, half_x_, half_y_, per_half_x_, per_half_y_;
  double value_[3][3];  // by y, by x [m]
  double ripple_[3] = {};
  double most_;  // [m]
};

}  // namespace gloam
