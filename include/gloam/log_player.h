#pragma once
// LogPlayer: plays a logged run as a Simulation, at any speed and from any instant.

#include <memory>

#include "gloam/log_replay.h"
#include "gloam/simulation.h"

namespace gloam {

class LogPlayer {
 public:
  /// Bodies follow the interpolated logged states; everything else is rendered again, as `replay`
  /// requests. Only `simulation` of its request is used. Errors: as for replay_log.
  static Result<std::unique_ptr<LogPlayer>> open(const LogReplay& replay);
  virtual ~LogPlayer() = default;

  /// Runs from 0 to end() and stops there. Cameras, LiDARs, sensors and topics open as in any other
  /// simulation; Commands are accepted but have no effect.
  virtual Simulation& simulation() = 0;
  virtual double end() const = 0;  ///< [s]
  /// Moves to an instant, forwards or backwards, and continues from there if it was playing.
  /// Snapshots belong to a new run. Blocks: smoke and other effects are solved again from the
  /// beginning. Errors: not in [0, end()], the log cannot be read there.
  virtual Status seek(double time) = 0;
};

}  // namespace gloam
