#pragma once
// RunText: the World of a run as a log holds it, from which it can be compiled again.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "world/world.h"

namespace gloam {

inline constexpr const char* kWorldTopic = "/gloam/world";       ///< RunText, JSON
inline constexpr const char* kCommandTopic = "/gloam/commands";  ///< command_text, JSON
inline constexpr const char* kStateTopic = "/gloam/states";      ///< gloam_msgs::State, CDR

struct RunText {
  struct File {
    std::string path;  ///< as seen from `folder` where it lies near it
    uint64_t hash = 0;
  };
  int64_t run = 0, step = 0;  ///< from which the simulation is in this World
  std::string version, mujoco, configuration;
  uint64_t seed = 1;
  double timestep = 0;  ///< instead of the model's [s]; 0 = the model's
  std::string name, folder, bare_model, keyframe;
  std::string toml;         ///< of the scene as it was given
  uint64_t model_hash = 0;  ///< of all of mjModel
  std::vector<File> files;  ///< of models and scene that exist
};

/// Hash of a model with all its arrays and names.
uint64_t hash_model(const mjModel& model);

RunText describe_run(const CompiledWorld& world, uint64_t seed, std::optional<double> timestep);
std::string to_json(const RunText& text);
/// Errors: no JSON of this kind.
Result<RunText> parse_run_text(std::string_view json);

/// Compiles it. `folder`: where its files are now; empty = where they were. Errors: the compiler's;
/// another model comes out: names the files that have changed, or the version.
Result<std::shared_ptr<const CompiledWorld>> compile_run(const RunText& text,
                                                         const std::filesystem::path& folder);

}  // namespace gloam
