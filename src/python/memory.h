#pragma once
// Fields of mjModel and mjData as arrays.

#include "core.h"
#include "gloam/physics_memory.h"
#include "model_mirror.h"

namespace gloam::python {

void bind_memory(nb::module_& m);
/// A DataMaker that calls `make(ModelKeeper)` -> (address of mjData, what keeps it and its model).
DataMaker data_maker(nb::object make, std::shared_ptr<ModelMirrors> mirrors);

}  // namespace gloam::python
