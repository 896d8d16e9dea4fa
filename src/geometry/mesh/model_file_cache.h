#pragma once
// Model files that were read once, kept so that a second start does not parse again. An entry is
// found by the content of the model file and holds good while every file that it was made of has
// the same content. A damaged entry is as good as none; one that cannot be written is no error.

#include "geometry/mesh/model_file.h"

namespace gloam {

/// As read_model_file, by way of `folder`, which is made when needed. `was_cached` (may be null):
/// whether an entry was used.
Result<ModelFile> read_model_file_cached(const std::filesystem::path& path,
                                         const std::filesystem::path& folder,
                                         const ModelFileOptions& options = {},
                                         bool* was_cached = nullptr);

}  // namespace gloam
