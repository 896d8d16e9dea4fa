#pragma once
// Options and counts of a simulation.

#include <cstdint>
#include <string>

#include "gloam/handle.h"
#include "gloam/physics_memory.h"
#include "gloam/types.h"

namespace gloam {

enum class Pace {
  kFast,      ///< as fast as possible: waits for required consumers
  kLockstep,  ///< as fast as possible, but only when told to: step(), run_until()
  kRealTime,  ///< paced by the wall clock times `speed`; late consumers lose frames
};

struct SimulationOptions {
  uint64_t seed = 1;
  double timestep = 0;  ///< [s]; 0 = the model's own
  Pace pace = Pace::kFast;
  double speed = 1;          ///< of Pace::kRealTime, > 0
  DataMaker make_data = {};  ///< empty = the simulation makes its own
};

struct SimulationStats {
  int64_t step = 0;
  double time = 0;             ///< [s]
  uint64_t hash = 0;           ///< of the state, chained over all steps
  double realtime_factor = 0;  ///< simulated seconds per wall second since the last resume
  int64_t dropped_snapshots = 0;
  int64_t commands_applied = 0;  ///< posted ones, over all runs
  int64_t warnings = 0;          ///< MuJoCo's, all types
};

/// A body under a pixel, for dragging.
struct PickResult {
  Body body;
  std::string name;
  Vec3 point_B;  ///< hit point in the body's frame [m]
  Vec3 point_W;  ///< and in the world [m]
};

}  // namespace gloam
