#pragma once
// [[probe]]: a quantity of the scene, read as a sensor (docs/sensors.md). Part of gloam/scene.h.

#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[probe]]: the true value of one quantity at a place, on a body or of a camera. The quantity
/// determines the required keys.
struct ProbeOptions {
  std::string name = {};  ///< unique, and different from all sensors of the model
  /// wind | gas_velocity | gas_density | gas_temperature | visibility | water_height | illuminance
  /// | contact_force | sinkage | soil_work | exposure | sun_disc
  std::string quantity = {};
  std::optional<Vec3> position = {};  ///< place, in the world or in the frame of `body` [m]
  std::string body = {};    ///< full name; for quantities measured on bodies, * matches any text
  std::string agent = {};   ///< person or vehicle on which it is measured, with all its parts
  std::string camera = {};  ///< camera to which it applies
  std::optional<Vec3> normal =
      {};  ///< illuminance: normal of the lit side, in the frame of `position`; empty = +Z
  Rational rate = {10, 1};  ///< samples per second of simulation time [Hz]
  SourceLoc loc = {};
};

}  // namespace gloam
