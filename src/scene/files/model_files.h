#pragma once
// The only door through which MuJoCo reads files: a virtual file system whose every open is checked
// against the roots of the models, bounded in size, remembered for the cache, and explained when it
// fails.

#include <mujoco/mujoco.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "gloam/scene.h"
#include "scene/files/dependency.h"
#include "scene/files/model_path.h"
#include "scene/files/xml_scan.h"
#include "scene/mjcf/model_text.h"

namespace gloam {

/// Files of the models of one level. Not movable: MuJoCo keeps pointers to it.
class ModelFiles {
 public:
  ModelFiles();
  ~ModelFiles();
  ModelFiles(const ModelFiles&) = delete;
  ModelFiles& operator=(const ModelFiles&) = delete;

  /// Admits a model: finds its root, reads and scans its XML and everything that includes reach.
  /// `loc` is where the scene names it (empty = the command line). Errors: missing, not a model,
  /// malformed or absurd XML, cyclic includes, a file outside the root.
  Status add_model(const std::filesystem::path& file, const FileAccess& access,
                   const SourceLoc& loc = {});

  /// Only the first step of add_model: finds the root, so that files below it may be read.
  Status admit(const std::filesystem::path& file, const FileAccess& access);

  /// Top element of a model that was added: "mujoco" or "robot".
  const std::string& root_element(const std::filesystem::path& file) const;
  /// Time that MuJoCo takes for the slowest <replicate> of all files, roughly [s].
  double slowest_replicate() const { return slowest_replicate_; }
  /// Text of a model or of a file that it includes, as on disk.
  const std::string& text(const std::filesystem::path& file) const;
  bool uses_plugins() const { return uses_plugins_; }

  /// From now on MuJoCo reads `text` instead of the file.
  void set_overlay(const std::filesystem::path& file, std::string text);
  void clear_overlay(const std::filesystem::path& file);

  /// Sets in the spec of a model in TOML what XML could not carry there; nothing for others. After
  /// parsing. Errors: with the line in its file.
  Status set_spec_only(const std::filesystem::path& file, mjSpec* spec) const;

  /// Reads through the same checks. For files that Gloam itself needs (export, cache).
  Result<std::shared_ptr<const std::string>> read(const std::filesystem::path& path);

  /// Is the file (or its absence) what the cache remembers? Roots must be admitted.
  bool is_unchanged(const Dependency& dependency);

  /// Could this file be read?
  bool readable(const std::filesystem::path& path);

  /// To be passed to mj_parseXML and mj_compile.
  const mjVFS* vfs() const { return &vfs_; }

  /// Cause and place of a failure, from MuJoCo's message and from the files that could not be
  /// opened since the last forget_failures().
  Error explain(const std::string& message, const std::filesystem::path& model) const;
  void forget_failures();

  /// Place where a model, or else a file that it includes, first has an element with this attribute
  /// (any, if empty); line 0 where none has.
  SourceLoc find_setting(const std::filesystem::path& model, const std::string& element,
                         const std::string& attribute) const;

  /// In the order of first use.
  std::vector<Dependency> dependencies() const;

 private:
  struct Failure {
    std::filesystem::path path;
    std::string reason;
    ErrorKind kind = ErrorKind::kInput;
  };
  using Content = std::shared_ptr<const std::string>;

  Status scan(const std::filesystem::path& file, const std::filesystem::path& model,
              const SourceLoc& named_at, std::vector<std::filesystem::path>& stack);
  // `is_scanned`: the caller bounds XML itself.
  Result<Content> open(const std::filesystem::path& path, std::string* hash_text,
                       bool is_scanned = false);
  void explain_picture(Error* error) const;
  void find_place(const std::string& element, Error* error,
                  const std::filesystem::path& model) const;
  SourceLoc find_reference(const std::filesystem::path& path) const;
  // Place in the file of a model in TOML for a place in its XML.
  SourceLoc written_at(SourceLoc loc) const;

  int open_resource(mjResource* resource);
  static int provider_open(mjResource* resource);
  static int provider_read(mjResource* resource, const void** buffer);
  static void provider_close(mjResource* resource);

  mjVFS vfs_;
  mjpResourceProvider provider_;
  std::vector<ModelRoot> roots_;
  std::map<std::filesystem::path, XmlScan> scans_;
  bool uses_plugins_ = false;
  double slowest_replicate_ = 0;  // [s]

  mutable std::mutex mutex_;  // MuJoCo's compiler reads assets on several threads
  std::map<std::filesystem::path, Content> contents_;
  std::map<std::filesystem::path, Content> overlays_;
  std::map<std::filesystem::path, ModelText> toml_models_;  // `contents_` holds their XML
  std::vector<Dependency> dependencies_;
  std::set<std::filesystem::path> depended_;
  std::vector<Failure> failures_;
  std::atomic<bool> lacks_memory_{false};  // an exception said so, in a callback
  uint64_t total_size_ = 0;                // [bytes]
};

}  // namespace gloam
