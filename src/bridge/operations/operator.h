#pragma once
// Operator: what a client may do to a simulation, the same over every bridge. Thread-safe; calls
// that change the World come one after the other.

#include <atomic>

#include "gloam/simulation.h"

namespace gloam::bridge {

class Operator {
 public:
  explicit Operator(Simulation& simulation) : simulation_(simulation) {}

  Simulation& simulation() { return simulation_; }
  /// Asks the program to end.
  void ask_end() { end_asked_ = true; }
  bool end_asked() const { return end_asked_; }

 private:
  Simulation& simulation_;
  std::atomic<bool> end_asked_{false};
};

}  // namespace gloam::bridge
