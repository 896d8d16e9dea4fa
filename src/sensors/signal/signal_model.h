#pragma once
// Errors of one sensor's numbers: scale, offset, white noise, bias instability, rate random walk,
// saturation, quantisation. Terms and conversions: IEEE Std 952-1997, annex C.
//
// The errors of sample k are a function of (seed, k): drift is summed up from sample 0 whether or
// not anybody read the samples between.

#include <cstdint>
#include <span>
#include <vector>

#include "sensors/signal/signal_presets.h"
#include "world/sensors/sensor_description.h"

namespace gloam {

class SignalModel {
 public:
  /// Model of a sensor with `count` numbers at `rate` [Hz]; `seed` of sensor_seed().
  SignalModel(const SignalErrors& errors, SensorKind kind, int count, double rate, uint64_t seed);

  /// Makes the truth of sample k >= 0 what the sensor says. Later samples cost nothing more; an
  /// earlier one begins anew.
  void apply(int64_t k, std::span<double> values);

  /// Allan variance at `tau` [s] of white noise, bias instability and random walk together.
  double allan_variance(double tau) const;

 private:
  void restart();
  void advance();
  double drift(size_t component, int64_t k) const;

  SignalErrors errors_;
  SensorKind kind_;
  size_t components_;
  double period_;  // [s]
  uint64_t seed_;
  // Bias instability is noise of a 1/f spectrum: relaxations of equal variance whose times grow by
  // fours, here for 4 samples to an hour and more.
  std::vector<double> times_;  // [s]
  double relaxation_variance_ = 0;
  int64_t k_ = -1;               // sample of the state below
  std::vector<double> relaxed_;  // (components x times)
  std::vector<double> walked_;   // (components)
  std::vector<double> constant_, scale_;
};

}  // namespace gloam
