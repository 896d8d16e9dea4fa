#pragma once
// Sensors of an instant without MuJoCo's types: its own, with where their numbers stand in a
// Snapshot, and the scene's probes.

#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/sensor.h"

namespace gloam {

struct CompiledWorld;

/// Kinds of values, which decide how errors may change them.
enum class SensorKind {
  kNumbers,    ///< each by itself
  kDistance,   ///< each by itself; below 0 = nothing there, which stays
  kDirection,  ///< a unit vector
  kRotation,   ///< a unit quaternion wxyz; errors are small rotations in its own frame [rad]
};

struct SensorDescription {
  std::string name;  ///< full name, or "sensor_ID" where the model gives none
  int first = 0;     ///< index of its numbers in SnapshotData::sensordata; not of probes
  int count = 1;
  SensorKind kind = SensorKind::kNumbers;
  const SensorOptions* options = nullptr;  ///< the scene's last [[sensor]] that fits, or null
  int probe = -1;                          ///< row of CompiledWorld::probes; -1 = MuJoCo's
  Rational rate = {0, 1};                  ///< samples per second [Hz]; 0 = every step
  SourceLoc loc = {};                      ///< line that asks for that
};

/// All of the model's, in its order, then all probes. The options live as long as the World.
std::vector<SensorDescription> describe_sensors(const CompiledWorld& world);

/// Error: a [[sensor]] that fits no sensor and no probe.
Status check_sensors(const CompiledWorld& world);

}  // namespace gloam
