#pragma once
// Assets: mesh files of packages that the robots' descriptions name. No other file is given away.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/simulation.h"

namespace gloam::bridge::foxglove {

/// Names of the files of a URDF's meshes, each once.
std::vector<std::string> mesh_names(std::string_view urdf);

/// One thread's alone: files are read.
class Assets {
 public:
  explicit Assets(Simulation& simulation) : simulation_(simulation) {}

  /// Bytes of what a URI stands for. Errors: no robot's description names it, it cannot be read, it
  /// is too large.
  Result<std::shared_ptr<const std::vector<uint8_t>>> fetch(const std::string& uri);

 private:
  void follow();

  Simulation& simulation_;
  std::shared_ptr<const CompiledWorld> world_;
  std::map<std::string, std::filesystem::path> files_;  // by URI
};

}  // namespace gloam::bridge::foxglove
