#pragma once
// Input and reports of the readers of model files. For them alone.

#include <atomic>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh/model_file.h"

namespace gloam {

/// A file that a model is made of. `exists` false: the model names it, it was not there.
struct ModelPart {
  std::string name;  ///< relative to the model's folder
  bool exists = true;
  uint64_t hash = 0;  ///< hash of its content
};

/// Files beside a model, none outside the root.
class ModelFolder {
 public:
  /// Without a folder: every file is refused.
  ModelFolder() = default;
  /// Error: the model is not inside the root.
  static Result<ModelFolder> open(const std::filesystem::path& model,
                                  const std::filesystem::path& root);

  /// Reads the file that the model calls `name`. Errors: it is no plain relative path, lies outside
  /// the root (links followed), is missing (kIo), too large. `loc` is where the model names it.
  Result<std::vector<uint8_t>> read(std::string_view name, const SourceLoc& loc,
                                    const ModelLimits& limits);
  const std::vector<ModelPart>& parts() const { return parts_; }

 private:
  std::filesystem::path folder_, root_;  // canonical
  std::vector<ModelPart> parts_;
};

/// Counts what is unpacked against the limit.
class MemoryBudget {
 public:
  explicit MemoryBudget(uint64_t bytes) : left_(bytes) {}
  /// False when `count` things of `size` bytes are more than what is left.
  bool take(uint64_t count, uint64_t size) {
    if (size != 0 && count > left_ / size) return false;
    left_ -= count * size;
    return true;
  }

 private:
  uint64_t left_;
};

/// Passes progress on, in order, from any thread.
class ProgressCount {
 public:
  ProgressCount(const std::function<void(double)>& report, uint64_t total)
      : report_(report), total_(total) {}
  void add(uint64_t done);

 private:
  const std::function<void(double)>& report_;
  const uint64_t total_;
  std::atomic<uint64_t> done_{0};
  std::mutex mutex_;
  double reported_ = 0;  // guarded by mutex_
};

/// One model file to read.
struct ModelSource {
  std::string name;  ///< for messages
  std::span<const uint8_t> bytes;
  ModelFolder* folder = nullptr;
  const ModelFileOptions* options = nullptr;
};

Result<ModelFile> read_gltf(const ModelSource& source);
Result<ModelFile> read_glb(const ModelSource& source);
Result<ModelFile> read_obj(const ModelSource& source);
Result<ModelFile> read_stl(const ModelSource& source);
Result<ModelFile> read_ply(const ModelSource& source);
Result<ModelFile> read_collada(const ModelSource& source);

/// Reads by content, then by the ending of the name.
Result<ModelFile> read_model_bytes(const ModelSource& source);

/// Adds a note unless there are many already.
void add_note(ModelFile* model, std::string note);

/// Checks what every mesh has to be and drops triangles of no area, counted into the model. `what`
/// names the mesh in errors. Errors: a vertex, normal or uv is not finite, an index is out of
/// range.
Status finish_mesh(TriangleMesh* mesh, const std::string& what, const std::string& file,
                   ModelFile* model);

}  // namespace gloam
