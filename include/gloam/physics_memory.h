#pragma once
// Memory in which physics steps, for access between two steps.

#include <functional>
#include <memory>

struct mjModel_;
struct mjData_;

namespace gloam {

/// MuJoCo's structs of a running simulation. While it is paused they do not change and hold the
/// present instant. They stay readable after a recompile, a failure or the simulation's end, but
/// are then no longer stepped: memory() returns the current ones.
struct PhysicsMemory {
  std::shared_ptr<const mjModel_> model;  ///< for reading; live fields change through Commands
  std::shared_ptr<mjData_> data;
};

/// Creates the mjData in which a simulation steps, for the given model: the simulation's own copy,
/// which shares meshes, textures and bounding volumes with the World. Called at creation and
/// whenever the World is replaced, on the requesting thread. Returning null is an Error.
using DataMaker = std::function<std::shared_ptr<mjData_>(const std::shared_ptr<mjModel_>& model)>;

}  // namespace gloam
