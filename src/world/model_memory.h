#pragma once
// Memory of MuJoCo's that is taken as by `new`: std::bad_alloc where there is none.

#include "world/world.h"

namespace gloam {

/// mjData for the model, as reset. Never null.
DataPtr make_data(const mjModel& model);

/// A copy of the model. Never null.
ModelPtr copy_model(const mjModel& model);

}  // namespace gloam
