#pragma once
// A World as one MJCF, and what stock MuJoCo makes of it.

#include <filesystem>
#include <string>
#include <vector>

#include "world/world.h"

namespace gloam {

/// Comparison of the World's model with the one that stock MuJoCo loads from the written files.
struct ExportedModel {
  int compared = 0;                    ///< fields of mjModel
  std::vector<std::string> differing;  ///< those that are not equal in every bit
  std::string why;                     ///< MJCF cannot say the level exactly; "" = it can
};

/// Writes `folder`/scene.xml with its assets, and loads it again. Errors: the files have changed
/// since the World was made, or cannot be read or written.
/// With `left_out`, as World::export_mjcf: visual geoms join what has been compared.
Result<ExportedModel> write_mjcf(const CompiledWorld& world, const std::filesystem::path& folder,
                                 std::vector<Error>* left_out = nullptr);

/// A model file as any user of MuJoCo loads it: without Gloam's limits of what may be read.
Result<ModelPtr> load_stock_model(const std::filesystem::path& file);

}  // namespace gloam
