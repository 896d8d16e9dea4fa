#pragma once
// Settings of a run: [sim], [record] and options drawn at random ([[randomize]]). Part of
// gloam/scene.h.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/render.h"
#include "gloam/scene/robot.h"

namespace gloam {

/// [sim]: the physics of a run.
struct SimOptions {
  std::optional<double> timestep = {};  ///< [s]; empty = the model's own
  double duration = 10;                 ///< [s] of simulation time, > 0
  uint64_t seed = 1;                    ///< seed of everything random
  /// fast | realtime | sensors (docs/sensors.md), unless the command names one; empty = realtime
  /// for live runs, fast for others.
  std::string pace = {};
  SourceLoc loc = {};
};

/// [record]: recorded outputs of a run.
struct RecordOptions {
  std::vector<std::string> outputs = {"video", "png",
                                      "lidar"};  ///< from kRecordOutputs (gloam/outputs.h)
  bool mcap = false;  ///< also write the run as a log, run.mcap (docs/logs.md)
  /// Topics of the log by name; * matches any text. Empty = the default set (docs/topics.md).
  std::vector<std::string> topics = {};
  Rational state_rate = {100, 1};  ///< states in the log per second of simulation time [Hz]
  /// Rows of metrics.csv per second of simulation time [Hz], also the sampling of reductions; at
  /// most one per step.
  Rational metrics_rate = {100, 1};
  bool embed = false;  ///< include the files that the scene reads in the log, not only their hashes
  bool durable = false;  ///< sync each chunk of the log to the disk before the next is written
  SourceLoc loc = {};
};

/// [[randomize]]: an option drawn at random with sim.seed (docs/environments.md), from one of the
/// distributions.
struct RandomizeOptions {
  /// Path as in set_option; * in a name matches any text, and each match has its own draw
  std::string option = {};
  std::string operation = "set";           ///< set | add | scale: operation on the written value
  std::vector<TomlText> uniform = {};      ///< from, to
  std::vector<TomlText> log_uniform = {};  ///< from, to; > 0
  std::vector<TomlText> normal = {};       ///< mean, standard deviation; within the option's range
  std::vector<TomlText> choice = {};       ///< one of these
  std::vector<double> weights = {};        ///< weights of the choices; empty = equal
  std::optional<uint64_t> seed = {};       ///< seed of this draw; empty = sim.seed
  SourceLoc loc = {};
};

/// Value that a [[randomize]] gave an option.
struct DrawnOption {
  std::string option = {};  ///< full path
  std::string value = {};   ///< as in a scene file
};

}  // namespace gloam
