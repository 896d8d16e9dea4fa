#pragma once
// ControlLease: the claim of one client on a robot.

#include <span>
#include <string>

#include "gloam/command.h"
#include "gloam/result.h"

namespace gloam {

/// Gives its holder exclusive control of a robot, except that every client may stop its
/// trajectories; destroying it releases the robot. Must be
/// destroyed before its simulation. Any thread. A recompile keeps it for the robot of the same
/// name.
class ControlLease {
 public:
  virtual ~ControlLease() = default;
  virtual std::string robot() const = 0;  ///< name
  /// Simulation::post for the holder. Errors: as for post; a Command to a robot that another client
  /// has claimed.
  virtual Status post(std::span<const Command> commands) = 0;
  Status post(const Command& command) { return post(std::span<const Command>(&command, 1)); }
};

}  // namespace gloam
