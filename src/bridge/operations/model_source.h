#pragma once
// ModelSource: which files a client may name, and what they become in a Scene. A client reaches the
// files that the scene itself could name (gloam/scene.h, FileAccess) and those that come with
// Gloam.

#include <filesystem>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "bridge/operations/spawning.h"
#include "gloam/scene.h"

namespace gloam::bridge {

/// The extension of a file, with its dot, in lower case.
std::string lower_extension_of(const std::filesystem::path& path);

/// One entity more in a Scene.
using SceneEntity = std::variant<RobotOptions, ObjectOptions, PropOptions>;

class ModelSource {
 public:
  ModelSource() = default;
  /// Removes the files that clients gave as text.
  ~ModelSource();
  ModelSource(const ModelSource&) = delete;
  ModelSource& operator=(const ModelSource&) = delete;

  /// Entity that a request asks for, without a name and with its pose in the world. `model_name`:
  /// the name that a model gives itself; `failure`: the cause of an Error.
  Result<SceneEntity> find(const SpawnRequest& request, const Scene& scene, const Pose& X_WE,
                           std::string* model_name, SpawnFailure* failure);
  /// An absolute path for a path or an address of a client. Errors: not there, not to be read.
  static Result<std::filesystem::path> resolve(const std::string& uri, const Scene& scene);
  /// The same of a folder.
  static Result<std::filesystem::path> resolve_folder(const std::string& uri, const Scene& scene);
  /// Whether a file is one of a client's text.
  bool is_own(const std::filesystem::path& file) const;

 private:
  /// Writes a text into a folder of its own, out of which the model reads nothing.
  Result<std::filesystem::path> write(const std::string& text, const std::string& extension);

  mutable std::mutex mutex_;
  std::filesystem::path folder_;  // empty until the first
  int count_ = 0;
  size_t written_ = 0;  // [bytes]
};

/// Name of a prop's kind in "gloam://prop/KIND"; empty = another address.
std::string prop_kind_of(const std::string& uri);

}  // namespace gloam::bridge
