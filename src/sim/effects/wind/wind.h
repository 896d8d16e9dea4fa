#pragma once
// Wind with gusts: a pure function of time and height.
//
// The mean grows with height by the logarithmic law over open country (Stull 1988, "An Introduction
// to Boundary Layer Meteorology"; roughness length 3 cm, class 3 of Davenport's, WMO-No. 8); to
// that come world/weather/gusts.h.

#include <optional>

#include "sim/effects/bodies/body_drag.h"
#include "sim/loop/step_schedule.h"
#include "world/weather/gusts.h"
#include "world/world.h"

namespace gloam {

class Wind {
 public:
  explicit Wind(const WindDescription& wind);

  bool blows() const { return wind_.blows(); }
  /// Along the wind [m/s]; `height` above z = 0 [m], below 0.1 m as there.
  double mean_speed(double height) const;
  /// Deviation from the mean by gusts [m/s], world.
  Vec3 gust(double time) const;
  Vec3 at(double time, double height) const {
    return blows() ? with_mean(gust(time), height) : Vec3{};
  }
  /// Wind there for that gust.
  Vec3 with_mean(Vec3 gust, double height) const;

 private:
  WindDescription wind_;
  std::optional<Gusts> gusts_;  // gusts, if it blows
};

// ICAO's standard atmosphere at sea level, rounded.
inline constexpr double kAirDensity = 1.2;       ///< [kg/m³]
inline constexpr double kAirViscosity = 1.8e-5;  ///< [Pa s]
inline constexpr Fluid kAir{kAirDensity, kAirViscosity};

/// Gives a model that MuJoCo's own model of a fluid is to act in (has_own_drag), and that has no
/// fluid, air to move in.
void give_air(mjOption* option);

/// Blows on bodies: MuJoCo's option has one wind for all of them, that at the mean height of the
/// robots' root bodies, weighted by mass; without robots of all that floats.
class WindOnBodies {
 public:
  WindOnBodies(const CompiledWorld& world, Rational timestep);

  /// Sets the wind of step `step`, from `qpos`. Gusts change at 100 Hz.
  void blow(int64_t step, const double* qpos, mjOption* option);

 private:
  struct Root {
    int qpos;          // place of its height, -1 = it stays
    double z, weight;  // height [m] and its weight
  };
  Wind wind_;
  StepSchedule schedule_;
  double timestep_;  // [s]
  int64_t gust_step_ = -1;
  Vec3 gust_;  // gust of that step [m/s]
  std::vector<Root> roots_;
};

}  // namespace gloam
