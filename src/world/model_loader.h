#pragma once
// The model files of a scene's visuals, read by way of a cache on disk.

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/model_file.h"
#include "gloam/scene.h"

namespace gloam {

struct LoadedModel {
  std::filesystem::path path;  ///< as in VisualOptions::file
  std::string name;            ///< of the file, for messages
  ModelFile model;
};

/// Reads each file that a visual names, once; says on stderr how far it is when that takes more
/// than two seconds. What a file refers to is read within the scene's root (docs/security.md).
/// Errors: as read_model_file, with the place of the [[visual]].
Result<std::vector<LoadedModel>> load_visual_files(const Scene& scene);

}  // namespace gloam
