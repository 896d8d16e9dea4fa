#pragma once
// Fields of mjModel and mjData as arrays.

#include "core.h"
#include "gloam/physics_memory.h"

namespace gloam::python {

void bind_memory(nb::module_& m);
/// A DataMaker that calls `make(ModelKeeper)` -> (address of mjData, object that keeps it).
DataMaker data_maker(nb::object make);

}  // namespace gloam::python
