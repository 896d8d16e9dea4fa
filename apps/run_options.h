#pragma once
// The options that run, render and demo share.

#include <optional>
#include <string>
#include <vector>

#include "command.h"

namespace gloam::cli {

/// Holds what was given; apply() changes the scene accordingly.
struct RunOptions {
  std::optional<double> duration, timestep, ev100, error;
  std::optional<uint64_t> seed;
  std::optional<int> spp, max_depth;
  std::string tier, device, resolution;
  std::vector<std::string> cameras, outputs, settings, packages;
  bool no_denoise = false;
  int threads = 0;
  FileAccess access;

  void add_to(CLI::App& command);
  /// Loads the scene and applies every option to it.
  Result<Scene> load(const std::string& file);
};

}  // namespace gloam::cli
