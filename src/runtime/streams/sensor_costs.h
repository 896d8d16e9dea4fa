#pragma once
// Time that each stream of a simulation takes, and the rate that it reaches. Measured by the wall
// clock: for people, never for what is simulated.

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gloam/simulation_options.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

/// One stream's. Any thread.
class SensorAccount {
 public:
  SensorAccount(std::string name, double rate);
  /// Another message was made, of the instant `time` [s].
  void add_message(double time);
  /// Wall time in which messages were made, of which `waited` passed while others rendered [s].
  void add_time(double seconds, double waited);
  void set_dropped(int64_t dropped);
  SensorCost cost() const;

 private:
  mutable std::mutex mutex_;
  SensorCost cost_;
  double seconds_ = 0, waited_ = 0;  // [s]
  double last_ = 0, span_ = 0;       // of simulation time: the last message, first to last [s]
};

/// The accounts of all sensors of a simulation. Any thread.
class SensorCosts {
 public:
  /// `rate`: messages that are asked for [Hz of simulation time].
  std::shared_ptr<SensorAccount> open(std::string name, double rate);
  std::vector<SensorCost> list() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<SensorAccount>> accounts_;
};

/// Mean rate of an uneven schedule [Hz]; `due` as SubscriptionOptions::due.
double rate_of(const std::function<int64_t(int64_t step)>& due, Rational timestep);

}  // namespace gloam
