#pragma once
// Parts of a simulation that its streams use.

#include "runtime/rendering/shared_renderer.h"
#include "runtime/streams/sensor_costs.h"
#include "sim/loop/simulator.h"

namespace gloam {

struct StreamContext {
  Simulator& simulator;
  SharedRenderers& renderers;
  SensorCosts& costs;
  uint64_t seed = 1;
};

}  // namespace gloam
