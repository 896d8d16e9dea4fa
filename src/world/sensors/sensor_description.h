#pragma once
// MuJoCo's sensors without its types: where their numbers stand in a Snapshot.

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
  int first = 0;     ///< index of its numbers in SnapshotData::sensordata
  int count = 1;
  SensorKind kind = SensorKind::kNumbers;
  const SensorOptions* options = nullptr;  ///< the scene's last [[sensor]] that fits, or null
};

/// All of the model's, in its order. The options live as long as the World.
std::vector<SensorDescription> describe_sensors(const CompiledWorld& world);

/// Error: a [[sensor]] that fits none of the model's sensors.
Status check_sensors(const CompiledWorld& world);

}  // namespace gloam
