#pragma once
// The first stage of compiling: a scene as its file has it -> all values chosen, places generated,
// meshes read. Nothing refers to MuJoCo's model yet.

#include <optional>
#include <vector>

#include "gloam/scene.h"
#include "places/place.h"
#include "world/compile/mesh_object.h"
#include "world/compile/progress/compile_progress.h"
#include "world/world.h"

namespace gloam {

struct ResolvedScene {
  Scene written;  ///< with the tables of robot models, before anything was drawn
  Scene scene;
  std::optional<Place> place;
  MeshObjects objects;
  std::vector<DrawnOption> drawn;
  std::vector<Error> notes;  ///< of its props
  uint64_t place_hash = 0;   ///< of all geometry that is generated or read
};

/// Time of the stages, for CompileProgress.
double compile_weight(const Scene& scene);

/// `written`: valid, with the tables of robot models. Errors: files, generators, names in
/// [[randomize]]; cancelled.
Result<ResolvedScene> resolve_scene(Scene written, CompileProgress* progress);

}  // namespace gloam
