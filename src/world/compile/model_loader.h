#pragma once
// The model files of a scene's visuals and objects, read by way of a cache on disk.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "geometry/mesh/model_file.h"
#include "gloam/scene.h"

namespace gloam {

/// The error as one of `user`, "visual 'chair'", at `loc`.
Error said_of(const std::string& user, const SourceLoc& loc, const Error& error);

struct LoadedModel {
  std::filesystem::path path;  ///< as in VisualOptions::file
  std::string name;            ///< name of the file, for messages
  ModelFile model;
};

/// Reads one, by way of the cache. What it refers to is read within the scene's root
/// (docs/security.md). Errors: as read_model_file, said of `user` at `loc`.
Result<ModelFile> load_model_file(const Scene& scene, const std::filesystem::path& file,
                                  const std::string& user, const SourceLoc& loc,
                                  const std::function<void(double share)>& progress = {});

struct FileUse {
  std::filesystem::path path;
  std::string user;  ///< "visual 'chair'", for messages
  SourceLoc loc;
};

class CompileProgress;

/// Reads each file, once; says how far it is to whoever watches `progress`, else on stderr when it
/// takes more than two seconds. Errors: as load_model_file; it was cancelled.
Result<std::vector<LoadedModel>> load_model_files(const Scene& scene,
                                                  const std::vector<FileUse>& uses,
                                                  CompileProgress* progress = nullptr);

}  // namespace gloam
