#pragma once
// The second stage of compiling: a ResolvedScene -> MuJoCo's model and the elements of the level.

#include <memory>

#include "scene/files/model_files.h"
#include "world/compile/resolve_scene.h"

namespace gloam {

/// A World with its model, robots and notes; describe_world() adds the rest. `files` gets the files
/// that it was made of. Errors: MuJoCo's, of files; cancelled.
Result<std::shared_ptr<CompiledWorld>> build_model(const ResolvedScene& resolved, ModelFiles* files,
                                                   CompileProgress* progress);

}  // namespace gloam
