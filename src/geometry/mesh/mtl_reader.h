#pragma once
// Material libraries of OBJ files. Not for others.

#include "geometry/mesh/model_source.h"

namespace gloam {

/// Reads what an OBJ calls its `mtllib` and adds its materials and pictures to the model. A library
/// or picture that is missing is a note: many OBJ files travel without. Errors: a name that leads
/// out of the root, a damaged library.
Status read_mtl_library(const ModelSource& source, const std::string& name, const SourceLoc& loc,
                        MemoryBudget* budget, ModelFile* model);

/// Parses the text of a library; `file` is for messages.
Status parse_mtl(const ModelSource& source, std::string_view text, const std::string& file,
                 MemoryBudget* budget, ModelFile* model);

}  // namespace gloam
