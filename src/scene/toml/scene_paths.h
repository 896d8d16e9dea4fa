#pragma once
// Paths that a scene names, of every table, to be listed or rewritten.

#include <filesystem>
#include <functional>

#include "gloam/scene.h"

namespace gloam {

/// Calls `f` with every path that an option of the scene holds, which `f` may replace. Values
/// without a type of their own (params of a controller, values of a [[randomize]]) hold a path
/// where a file of that name exists; `f` gets its absolute path.
void visit_scene_paths(Scene* scene, const std::function<void(std::filesystem::path*)>& f);

}  // namespace gloam
