#pragma once
// Options of <compiler> that a model loses when it joins others in one spec: MuJoCo applies them to
// the whole level, or not at all.

#include <mujoco/mujoco.h>

#include <filesystem>
#include <string>
#include <vector>

#include "scene/files/model_files.h"

namespace gloam {

/// Applies `settotalmass` to the model alone, as explicit inertias, and where its options of
/// <lengthrange> are not `level`'s finds the length ranges by them. Call it before anything joins
/// the model or it joins anything. Notes `fusestatic`, without which static bodies stay bodies.
/// `title` = "robot 'x'" or "the environment". Errors: the model does not compile.
Status settle_compiler_options(const std::filesystem::path& file, const std::string& title,
                               const mjLROpt& level, ModelFiles* files, mjSpec* model,
                               std::vector<Error>* notes);

}  // namespace gloam
