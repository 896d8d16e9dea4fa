#pragma once
// [[hfield]] tables: ground sampled from mesh files, as height fields of the model.

#include <vector>

#include "geometry/height_field_parts.h"
#include "scene/files/model_files.h"

namespace gloam {

class CompileProgress;

/// One [[hfield]], sampled: its ground, then its slabs.
struct SampledGround {
  HeightFieldOptions options;
  std::vector<HeightField> fields;
};

/// Admits the files of the scene's hfields, so that they may be read.
Status admit_ground_files(const Scene& scene, ModelFiles* files);

/// Reads and samples; logs the result. The sources of the fields join the
/// dependencies of `files`; what the user ought to know goes to `notes`. Errors: a file that cannot
/// be read, a region that is empty, too large or has no surface, too many slabs.
Result<std::vector<SampledGround>> sample_grounds(const Scene& scene, ModelFiles* files,
                                                  std::vector<Error>* notes,
                                                  CompileProgress* progress = nullptr);

/// Adds the fields with their geoms, NAME and then NAME_2 …, to the world body; in group 3 where
/// the file itself is drawn. Error: a name that the spec has already.
Status add_grounds(const std::vector<SampledGround>& grounds, mjSpec* spec);

/// Adds a [[visual]] for each [[hfield]] whose file is drawn, unless it is there: a compiled Scene
/// has it. Error: another visual of that name.
Status add_ground_looks(Scene* scene);

}  // namespace gloam
