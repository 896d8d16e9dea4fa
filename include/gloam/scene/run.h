#pragma once
// Settings of a run: [sim], [render], [record] and options drawn at random ([[randomize]]). Part of
// gloam/scene.h.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/robot.h"

namespace gloam {

/// [sim]: the physics of a run.
struct SimOptions {
  std::optional<double> timestep = {};  ///< [s]; empty = the model's own
  double duration = 10;                 ///< [s] of simulation time, > 0
  uint64_t seed = 1;                    ///< seed of everything random
  /// fast | realtime | sensors (docs/sensors.md), where the command names none; empty = realtime
  /// for live runs, fast for others.
  std::string pace = {};
  SourceLoc loc = {};
};

/// [render]: how pictures are made.
struct RenderOptions {
  std::string tier = "path";    ///< path | fast | direct (docs/light.md)
  std::optional<int> spp = {};  ///< samples per pixel, 1 … 65536; with `error` at most, from 16
  /// Error bound of the path tier: each pixel is sampled until its standard error is this fraction
  /// of its value, 0.0001 … 1 (docs/light.md); empty = as many samples in every pixel.
  std::optional<double> error = {};
  /// Path vertices after the camera, 1 … 64; empty = 5, where there are media 24: fog is white by
  /// light that it scatters many times.
  std::optional<int> max_depth = {};
  /// cpu | cuda | auto (an NVIDIA card where this build and this machine have one, else the CPU).
  std::string device = "auto";
  bool denoise = true;  ///< but of the fast tier, which has a filter of its own
  /// auto | studio | model: the light of models that bring none. studio: a soft sky, a key light
  /// and a floor, in colour pictures alone; model: what MuJoCo shows; auto: the studio for models
  /// without lamps and sky (docs/light.md).
  std::string look = "auto";
  /// Exposure value at ISO 100; empty = the scene's rule (docs/light.md).
  std::optional<double> ev100 = {};
  /// Groups of geoms, skins, flexes, tendons and sites that are drawn, 0 … 5; empty = 0 to 2, and
  /// collision shapes of what has nothing else to show
  std::vector<int> groups = {};
  bool sites = false;  ///< sites are drawn: seen by cameras alone
  SourceLoc loc = {};

  /// spp, or where it is empty 4, with `error` 4096.
  int samples() const { return spp.value_or(error ? 4096 : 4); }
};

/// [record]: what is written of a run.
struct RecordOptions {
  std::vector<std::string> outputs = {"video", "png",
                                      "lidar"};  ///< those of kRecordOutputs (gloam/outputs.h)
  bool mcap = false;  ///< writes the run as a log, run.mcap, too (docs/logs.md)
  /// Topics of the log by name; * stands for any text. Empty = the usual ones (docs/topics.md).
  std::vector<std::string> topics = {};
  Rational state_rate = {100, 1};  ///< states in the log per second of simulation time [Hz]
  /// Rows of metrics.csv per second of simulation time [Hz], which metrics are summed up over, too;
  /// at most one a step.
  Rational metrics_rate = {100, 1};
  bool embed = false;    ///< files that the scene reads are in the log, not their hashes alone
  bool durable = false;  ///< each chunk of the log is synced to the disk before the next is written
  SourceLoc loc = {};
};

/// [[randomize]]: an option that sim.seed draws (docs/environments.md). One of the distributions.
struct RandomizeOptions {
  /// Path as of set_option; * in a name stands for any text, and each that it fits has its own draw
  std::string option = {};
  std::string operation = "set";           ///< set | add | scale: what is done to what is written
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
