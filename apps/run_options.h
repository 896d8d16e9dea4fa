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

/// Rendering options that replace the scene's.
struct RenderFlags {
  std::optional<double> ev100, error;
  std::optional<int> spp, max_depth;
  std::optional<RenderTier> tier;
  std::optional<RenderDevice> device;
  std::optional<RenderLook> look;
  std::vector<int> groups;
  bool no_denoise = false, sites = false;
  int threads = 0;

  void add_to(CLI::App& command);
  void apply_to(RenderOptions* render) const;
  /// The same as --set would change them: option of the scene and value.
  std::vector<std::pair<std::string, std::string>> as_settings() const;
};

/// Options of commands that run or render it.
struct RunOptions : SceneOptions, RenderFlags {
  std::optional<double> duration, timestep;
  std::string resolution;
  std::vector<std::string> cameras, outputs;

  void add_to(CLI::App& command);
  Result<Scene> load(const std::string& file);
};

}  // namespace gloam::cli
