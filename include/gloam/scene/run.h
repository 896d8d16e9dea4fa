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
  /// fast | realtime | sensors (docs/sensors.md), unless the command names one; empty = realtime
  /// for live runs, fast for others.
  std::string pace = {};
  SourceLoc loc = {};
};

/// [render]: rendering of images.
struct RenderOptions {
  /// path | interactive | direct (docs/light.md); empty = interactive for cameras that open while
  /// the simulation runs in real time, path for others.
  std::string tier = {};
  std::optional<int> spp = {};  ///< samples per pixel, 1 … 65536; with `error` the maximum, from 16
  /// Error bound of the path tier: each pixel is sampled until its standard error is this fraction
  /// of its value, 0.0001 … 1 (docs/light.md); empty = the same number of samples in every pixel.
  std::optional<double> error = {};
  /// Path vertices after the camera, 1 … 64; empty = 5, or 24 with media, where fog is white due to
  /// multiple scattering, and in the interactive tier.
  std::optional<int> max_depth = {};
  /// cpu | cuda | auto (an NVIDIA GPU if this build and this machine support one, otherwise the
  /// CPU).
  std::string device = "auto";
  bool denoise = true;  ///< except in the interactive tier, which has its own filter
  /// auto | studio | model: light for models without lights. studio: a soft sky, a key light and a
  /// floor, only in colour images; model: the lights of MuJoCo; auto: studio for models without
  /// lamps and sky (docs/light.md).
  std::string look = "auto";
  /// Exposure value at ISO 100; empty = determined by the scene (docs/light.md).
  std::optional<double> ev100 = {};
  /// Rendered groups of geoms, skins, flexes, tendons and sites, 0 … 5; empty = 0 to 2, and the
  /// collision shapes of bodies that have no other geoms
  std::vector<int> groups = {};
  bool sites = false;  ///< render sites; only cameras see them
  SourceLoc loc = {};

  /// tier, or the default one.
  std::string tier_or_default(bool real_time) const {
    return !tier.empty() ? tier : (real_time && !error ? "interactive" : "path");
  }
  /// spp; if it is empty, 4, or 4096 with `error`.
  int samples() const { return spp.value_or(error ? 4096 : 4); }
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
