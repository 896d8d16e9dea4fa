#pragma once
// Worlds for the tests of sim/, straight from MJCF text.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "base/rng.h"
#include "sim/loop/simulator.h"

namespace gloam {

/// A World of one bare model with one robot whose root is body 1.
std::shared_ptr<CompiledWorld> world_from_mjcf(const std::string& xml);

/// Something of everything that has state: floating and fixed bases, contacts, activations, delays,
/// histories, mocap, equalities, tendons, springs.
extern const char* const kRichModel;

std::unique_ptr<Simulator> make_simulator(std::shared_ptr<const CompiledWorld> world,
                                          SimulatorOptions options = {});
inline SimulatorOptions lockstep() { return {.pace = Pace::kLockstep}; }

/// Control `i` at step `step`, uniform in [-1, 1], the same wherever it is drawn.
double random_control(int64_t step, int i);

/// Writes random_control into all controls at its rate.
class RandomController final : public Controller {
 public:
  void reset(const mjModel*, const mjData*) override { ++resets; }
  void control(const ControlInputs& in) override {
    for (int i = 0; i < in.model->nu; ++i) in.data->ctrl[i] = random_control(in.step, i);
    ++calls;
  }
  int64_t calls = 0, resets = 0;
};

}  // namespace gloam
