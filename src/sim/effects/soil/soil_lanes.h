#pragma once
// Touches of a body in a bed side by side, so that compilers make vector code of what a step does
// with each. What is missing of the last has no area.

#include <algorithm>
#include <cmath>

#include "base/wave_math.h"
#include "sim/effects/soil/soil_contact.h"
#include "sim/effects/soil/soil_law.h"

namespace gloam {

/// Motion of a point of a body, and others from there: linear [m/s], then angular [rad/s]; world.
struct SoilLanes {
  static constexpr size_t kSide = 8;

  double area[kSide] = {}, depth[kSide] = {};       // [m²], [m]
  double arm[3][kSide] = {}, slope[2][kSide] = {};  // from the point [m]; of the underside
  double modulus[kSide] = {};                       // k_c / b + k_phi [N/m^(n+2)]
  double bottom[kSide] = {};                        // depth of the bed [m]
  // 1 / (d d), and the true area over the area seen from above.
  double per_steep[kSide] = {}, stretch[kSide] = {};
  double loading[kSide] = {};      // on the loading curve, as it is now [Pa]
  double shearing[3][kSide] = {};  // limit that cell.shear goes to since the last step
  double share[kSide] = {};        // and how far
  // History of cells:
  double sinkage[kSide] = {}, pressure[kSide] = {}, unloading[kSide] = {}, shear[3][kSide] = {};
  // Force at a velocity u of its place: f - across u - along d (d u), where d is where the ground
  // presses to, (-slope, 1); pressing at no velocity, and less by it.
  double f[3][kSide] = {}, across[kSide] = {}, along[kSide] = {};  // [N], [N s/m]
  double load[kSide] = {}, stiffness[kSide] = {};                  // [N], [N s/m]

  /// `depth_of_bed`: where it is 0, nothing presses.
  void set(size_t i, const SoilTouch& touch, const double* point, double modulus_of_patch,
           double depth_of_bed) {
    area[i] = depth_of_bed > 0 ? touch.area : 0.0;
    depth[i] = touch.depth, modulus[i] = modulus_of_patch, bottom[i] = depth_of_bed;
    for (int a = 0; a < 3; ++a) arm[a][i] = touch.p[a] - point[a];
    for (int a = 0; a < 2; ++a) slope[a][i] = touch.slope[a];
  }

  void set(size_t i, const SoilCell& cell, double fallen) {
    sinkage[i] = cell.sinkage_under(fallen), pressure[i] = double{cell.pressure};
    for (int a = 0; a < 3; ++a) shear[a][i] = double{cell.shear[a]};
  }

  /// Finds the present state of cells: loading, shearing, covered fraction.
  void find_loading(const SoilStrength& s, const double* motion, double dt);
  /// After set() of the cells.
  void find_unloading(const SoilStrength& s);
  /// Forces at the end of a step, linear about `motion`, the body's there.
  void find_forces(const SoilStrength& s, const double* motion, double dt);

 private:
  struct Slip {
    double v[3];     // along the surface [m/s]
    double sinking;  // d v
    double speed;    // [m/s]
  };
  Slip slip_at(size_t i, const double* motion) const {
    const double a[3] = {arm[0][i], arm[1][i], arm[2][i]}, *w = motion + 3;
    const double s[2] = {slope[0][i], slope[1][i]};
    Slip out{{motion[0] + w[1] * a[2] - w[2] * a[1], motion[1] + w[2] * a[0] - w[0] * a[2],
              motion[2] + w[0] * a[1] - w[1] * a[0]}};
    out.sinking = out.v[2] - s[0] * out.v[0] - s[1] * out.v[1];
    const double part = out.sinking * per_steep[i];
    out.v[0] += part * s[0], out.v[1] += part * s[1], out.v[2] -= part;
    out.speed = std::sqrt(dot3(out.v, out.v));
    return out;
  }
  double loading_at(size_t i, double n, double z) const {
    constexpr double kMinSinkage = 1e-12;  // [m]
    z = z < bottom[i] ? z : bottom[i];
    return modulus[i] * power(z > kMinSinkage ? z : kMinSinkage, n);
  }
};

inline void SoilLanes::find_loading(const SoilStrength& s, const double* motion, double dt) {
  constexpr double kMinSlip = 1e-9;  // [m]
  const double per_way = 1 / s.shear;
  for (size_t i = 0; i < kSide; ++i) {
    const double steep = 1 + slope[0][i] * slope[0][i] + slope[1][i] * slope[1][i];
    per_steep[i] = 1 / steep, stretch[i] = std::sqrt(steep);
    loading[i] = loading_at(i, s.n, depth[i]);
    const Slip slip = slip_at(i, motion);
    const double way = slip.speed * dt, moves = way > kMinSlip ? 1.0 : 0.0;
    share[i] = moves * (1 - exponential(-way * per_way));
    const double per_speed = -moves / (slip.speed > kMinSlip ? slip.speed : 1.0);
    for (int a = 0; a < 3; ++a) shearing[a][i] = slip.v[a] * per_speed;
  }
}

inline void SoilLanes::find_unloading(const SoilStrength& s) {
  for (size_t i = 0; i < kSide; ++i) {
    unloading[i] = unloading_of(s, sinkage[i], pressure[i]);
    // Across the surface nothing shears.
    const double a[2] = {slope[0][i], slope[1][i]};
    const double part =
        (shear[2][i] - a[0] * shear[0][i] - a[1] * shear[1][i]) / (1 + a[0] * a[0] + a[1] * a[1]);
    shear[0][i] += part * a[0], shear[1][i] += part * a[1], shear[2][i] -= part;
  }
}

inline void SoilLanes::find_forces(const SoilStrength& s, const double* motion, double dt) {
  constexpr double kMinMotion = 1e-9;  // [m]
  const double per_way = 1 / s.shear;
  for (size_t i = 0; i < kSide; ++i) {
    const Slip slip = slip_at(i, motion);
    const double z = depth[i] - dt * slip.sinking;
    const double curve = loading_at(i, s.n, z), per_z = curve / (z > 0 ? z : 1.0);
    const SoilLine line = unloading_line(sinkage[i], pressure[i], unloading[i], per_z, z);
    const bool unloads = (pressure[i] > 0) & (line.p < curve);
    const double p = unloads ? line.p : curve;
    const double stiff = unloads ? line.slope : (z < bottom[i] ? s.n * per_z : 0.0);
    const double on = ((z > 0) & (p > 0)) ? area[i] : 0.0;
    stiffness[i] = on * stiff * dt;
    load[i] = on * p + stiffness[i] * slip.sinking;
    // Shear, over the true area.
    const double most = on * stretch[i] * (s.cohesion + p * s.tan_friction);
    const double way = slip.speed * dt, gone = 1 - exponential(-way * per_way);
    across[i] = most * (way > kMinMotion ? gone / slip.speed : dt * per_way);
    along[i] = stiffness[i] - across[i] * per_steep[i];
    const double held = most * (1 - gone);
    f[0][i] = held * shear[0][i] - load[i] * slope[0][i];
    f[1][i] = held * shear[1][i] - load[i] * slope[1][i];
    f[2][i] = held * shear[2][i] + load[i];
  }
}

}  // namespace gloam
