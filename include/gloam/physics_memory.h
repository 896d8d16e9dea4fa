#pragma once
// Memory that physics steps in, for those who look into it between two steps.

#include <functional>
#include <memory>

struct mjModel_;
struct mjData_;

namespace gloam {

/// MuJoCo's structs of a running simulation. While it is paused they stand still and are the
/// present instant. Kept, they stay readable after a recompile, a failure or the simulation's end,
/// but are then no longer stepped: memory() tells the present ones.
struct PhysicsMemory {
  std::shared_ptr<const mjModel_> model;  ///< for reading; live fields change through Commands
  std::shared_ptr<mjData_> data;
};

/// Makes the mjData that a simulation steps in, of the model that it is given: the simulation's own
/// copy, whose meshes, textures and trees of bounds are still the World's. Called at creation and
/// whenever the World is exchanged, on the thread that asks for that. Null: refused, which is an
/// Error.
using DataMaker = std::function<std::shared_ptr<mjData_>(const std::shared_ptr<mjModel_>& model)>;

}  // namespace gloam
