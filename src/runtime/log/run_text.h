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

// All in CDR, so that every reader of ROS 2's logs opens the whole log.
inline constexpr const char* kWorldTopic = "/gloam/world";  ///< std_msgs/String with RunText, JSON
inline constexpr const char* kCommandTopic = "/gloam/commands";  ///< String with command_text, JSON
inline constexpr const char* kInputTopic = "/gloam/inputs";      ///< gloam_msgs::StepInput
inline constexpr const char* kStateTopic = "/gloam/states";      ///< gloam_msgs::State

struct RunText {
  struct File {
    std::string path;  ///< PortablePaths::name
    uint64_t hash = 0;
  };
  struct Package {
    std::string name, folder;  ///< package://NAME and PortablePaths::name of its folder
  };
  /// 1 = absolute paths, and model_hash covers them; 2 = paths as seen from the scene's folder.
  int format = 2;
  int64_t run = 0, step = 0;  ///< from which the simulation is in this World
  std::string version, mujoco, configuration;
  uint64_t seed = 1;
  double timestep = 0;  ///< instead of the model's [s]; 0 = the model's
  /// `folder`: of the scene, as seen from the log's folder; empty where that would tell whose
  /// machine it was. `file` lies in it; "" = from text.
  std::string name, folder, file, bare_model, keyframe;
  std::string toml;               ///< of the scene as it was given
  uint64_t model_hash = 0;        ///< hash_model, sim/state/model_hash.h
  std::vector<File> files;        ///< all that the World was made of, files/run_files.h
  std::vector<Package> packages;  ///< FileAccess::packages
  bool has_root = false;          ///< FileAccess::root was given
  /// The run began from a checkpoint, and the Commands that led there from its beginning are
  /// logged.
  bool has_history = false;
};

/// A run's text and the files behind its RunText::files, in the same order.
struct DescribedRun {
  RunText text;
  std::filesystem::path folder;  ///< of the scene, absolute
  std::vector<std::filesystem::path> files;
};
/// `log`: the file that it is written to.
DescribedRun describe_run(const CompiledWorld& world, uint64_t seed, std::optional<double> timestep,
                          const std::filesystem::path& log);
std::string to_json(const RunText& text);
/// Errors: no JSON of this kind.
Result<RunText> parse_run_text(std::string_view json);

/// Where the files of a logged scene are on this machine (files/scene_folder.h).
struct SceneFolder {
  std::filesystem::path path;
  FileAccess access = {};
};
/// The Scene as it was given. Errors: those of parse_scene and load_scene.
Result<Scene> scene_of(const RunText& text, const SceneFolder& folder);
/// Compiles it. Errors: the compiler's, with the files that have changed.
Result<std::shared_ptr<const CompiledWorld>> compile_run(const RunText& text,
                                                         const SceneFolder& folder);
/// Whether stepping this World can give the logged bits. Error: another version wrote the log, or
/// another model came out: names the files that have changed.
Status check_same_bits(const RunText& text, const CompiledWorld& world, const SceneFolder& folder);

/// Path of a file of the run below the scene's folder.
std::filesystem::path path_in(const std::filesystem::path& folder, const RunText::File& file);
/// True if the file exists there with the logged content.
bool is_in_place(const std::filesystem::path& folder, const RunText::File& file);

}  // namespace gloam
