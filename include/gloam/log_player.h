#pragma once
// LogPlayer: a logged run as a Simulation that can be played, slowed, and gone about in.

#include <memory>

#include "gloam/log_replay.h"
#include "gloam/simulation.h"

namespace gloam {

class LogPlayer {
 public:
  /// Bodies are where the logged states say, interpolated between; all else is seen anew, as
  /// `replay` asks. Of its request only `simulation` counts. Errors: errors of replay_log.
  static Result<std::unique_ptr<LogPlayer>> open(const LogReplay& replay);
  virtual ~LogPlayer() = default;

  /// Runs from 0 to end() and stands still there. Cameras, LiDARs, sensors and topics open as on
  /// any other; Commands are taken and do nothing.
  virtual Simulation& simulation() = 0;
  virtual double end() const = 0;  ///< [s]
  /// Goes to an instant, forwards or back, and plays on from there if it played. Snapshots are of a
  /// new run. Blocks: smoke and other effects are solved again from the beginning. Errors: not in
  /// [0, end()], the log cannot be read there.
  virtual Status seek(double time) = 0;
};

}  // namespace gloam
