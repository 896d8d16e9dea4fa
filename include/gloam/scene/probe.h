#pragma once
// [[probe]]: a number of the scene read as a sensor (docs/sensors.md). Part of gloam/scene.h.

#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[probe]]: the truth of one quantity at a place, on a body or of a camera. Which keys it needs
/// is the quantity's to say.
struct ProbeOptions {
  std::string name = {};  ///< unique, and no sensor's of the model
  /// wind | gas_velocity | gas_density | gas_temperature | visibility | water_height | illuminance
  /// | contact_force | sinkage | soil_work | exposure | sun_disc
  std::string quantity = {};
  std::optional<Vec3> position = {};  ///< place, in the world or in the frame of `body` [m]
  std::string body = {};    ///< full name; of what is measured on bodies * stands for any text
  std::string agent = {};   ///< person or vehicle that it is measured on, with all its parts
  std::string camera = {};  ///< camera that it is of
  std::optional<Vec3> normal = {};  ///< illuminance: side that is lit, as `position`; empty = +Z
  Rational rate = {10, 1};          ///< samples per second of simulation time [Hz]
  SourceLoc loc = {};
};

}  // namespace gloam
