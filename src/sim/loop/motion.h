#pragma once
// Motion: where bodies are at every step, told to a simulation in place of physics: a recorded run
// that is looked at again, under another sky.

#include <mujoco/mujoco.h>

#include <cstdint>
#include <span>

#include "gloam/result.h"

namespace gloam {

class Motion {
 public:
  virtual ~Motion() = default;
  /// Brings positions, velocities, mocap poses, controls and time of `data`, of the simulation's
  /// own World, to `step`, the next one; 0 at first. Error: the motion has no such step.
  virtual Status advance(int64_t step, mjData* data) = 0;
  /// Whether the motion has the poses of the World's people and vehicles. Those that were added to
  /// the World walk by themselves.
  virtual bool moves_agents() const { return true; }
  /// After advance(): writes the readings of MuJoCo's sensors that the motion has recorded over
  /// those computed from the poses. `sensordata` is that of the simulation's own World.
  virtual void read_sensors(std::span<double> /*sensordata*/) const {}
};

}  // namespace gloam
