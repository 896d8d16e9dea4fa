#pragma once
// Changes of a lamp's light: a factor on its intensity, a pure function of simulation time, seed
// and lamp, so that any step can be asked for in any order, by any thread.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// On for `duty` of every period, off for the rest.
struct OnOff {
  double period = 1;  ///< [s], > 0
  double duty = 0.5;  ///< fraction of the period, 0..1
  double phase = 0;   ///< fraction of a period that is over at time 0, 0..1
};

/// Levels at times; the first holds before, the last after.
struct Keyframes {
  struct Key {
    double time = 0;   ///< [s], rising
    double level = 1;  ///< >= 0
  };
  std::vector<Key> keys;  ///< at least one
  bool linear = true;     ///< between keys; else each holds up to the next
};

/// Ripple of lamps on alternating current: 1 - depth + 2 depth sin²(2 pi f t), at twice the mains'
/// frequency. Its mean is 1, and depth is the percent flicker of IES RP-16, (max - min) / (max +
/// min).
struct MainsRipple {
  double frequency = 50;  ///< frequency of the mains [Hz], > 0: ripple of 100 Hz
  double depth = 0.3;     ///< 0..1: incandescent 0.1, fluorescent on a magnetic ballast 0.3
};

/// A fluorescent tube with a glow starter: dark, one to five weak flashes at irregular times, then
/// light that grows to 1 as the mercury warms up. A plausible course, not a measured one.
struct FluorescentStart {
  double at = 0;        ///< when it is switched on [s]
  double warm_up = 20;  ///< time constant from 0.7 to 1 [s], > 0
};

/// Flame: noise below `bandwidth` with the mean 1, within 1 - depth to 1 + depth. Flames puff at
/// 1.5 / sqrt(diameter in m) Hz (Pagni 1990, "Pool vortex shedding frequencies"): 9 Hz over
/// 2.5 cm, 1.5 Hz over 1 m.
struct Flame {
  double bandwidth = 9;  ///< [Hz], > 0
  double depth = 0.4;    ///< 0..1
};

/// Mains that fail from `at` to `until`. A lamp on them is dark in between; one for emergencies
/// shines then alone.
struct PowerCut {
  double at = 0, until = 1;  ///< [s]; until may be infinite
  bool starter = false;      ///< it comes back as a FluorescentStart
  bool emergency = false;
};

/// The product of its parts; 1 without any.
struct LightSchedule {
  using Part = std::variant<OnOff, Keyframes, MainsRipple, FluorescentStart, Flame, PowerCut>;
  std::vector<Part> parts;
};

/// Errors: a value outside of its range; the message names part and value. `loc`: where the
/// schedule was written.
Status check_schedule(const LightSchedule& schedule, const SourceLoc& loc);

/// Factor at `time` [s], >= 0, of a schedule that check_schedule allows. On simulation time, `time`
/// is step * timestep in one product: edges within a billionth of a period count as reached, so
/// that rounding decides nothing. `lamp` tells lamps with one seed apart.
double light_level(const LightSchedule& schedule, double time, uint64_t seed, uint32_t lamp);

}  // namespace gloam
