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
inline constexpr const char* kInputTopic = "/gloam/inputs";      ///< gloam_msgs::StepInput, CDR
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
  std::string name, folder, file, bare_model, keyframe;  ///< `file` in `folder`; "" = from text
  std::string toml;                                      ///< of the scene as it was given
  uint64_t model_hash = 0;                               ///< of all of mjModel
  std::vector<File> files;                               ///< of models and scene that exist
  /// The run began from a checkpoint, and the Commands that led there from its beginning are
  /// logged.
  bool has_history = false;
};

/// Hash of a model with all its arrays and names.
uint64_t hash_model(const mjModel& model);

RunText describe_run(const CompiledWorld& world, uint64_t seed, std::optional<double> timestep);
std::string to_json(const RunText& text);
/// Errors: no JSON of this kind.
Result<RunText> parse_run_text(std::string_view json);

/// Folder of the scene: `folder`, or where it was.
std::filesystem::path folder_of(const RunText& text, const std::filesystem::path& folder);
/// The Scene as it was given. Errors: those of parse_scene and load_scene.
Result<Scene> scene_of(const RunText& text, const std::filesystem::path& folder);
/// Compiles it. Errors: the compiler's, with the files that have changed.
Result<std::shared_ptr<const CompiledWorld>> compile_run(const RunText& text,
                                                         const std::filesystem::path& folder);
/// Whether stepping this World can give the logged bits. Error: another version wrote the log, or
/// another model came out: names the files that have changed.
Status check_same_bits(const RunText& text, const CompiledWorld& world,
                       const std::filesystem::path& folder);

}  // namespace gloam
