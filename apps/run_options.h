#pragma once
// The options that run, render and demo share.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"

namespace gloam::cli {

/// "KEY=VALUE" of --set. Error: no '='.
Result<std::pair<std::string, std::string>> split_setting(const std::string& setting);

/// Changes to a scene that all commands which load one may make.
struct SceneOptions {
  std::optional<uint64_t> seed;
  std::vector<std::string> settings, packages;
  std::string keyframe;  ///< of a bare model; "" = as without one
  FileAccess access;

  void add_to(CLI::App& command);
  void add_keyframe_to(CLI::App& command);
  /// Loads the scene and applies every option to it.
  Result<Scene> load(const std::string& file);
  Result<World> compile(const std::string& file, const Globals& globals);
};

/// Options of commands that run or render it.
struct RunOptions : SceneOptions {
  std::optional<double> duration, timestep, ev100, error;
  std::optional<int> spp, max_depth;
  std::string tier, device, look, resolution;
  std::vector<std::string> cameras, outputs;
  std::vector<int> groups;
  bool no_denoise = false, sites = false;
  int threads = 0;

  void add_to(CLI::App& command);
  Result<Scene> load(const std::string& file);
};

}  // namespace gloam::cli
