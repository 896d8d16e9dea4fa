#pragma once
// Requests and reports of batch runs.

#include "core.h"
#include "gloam/run.h"

namespace gloam::python {

RunRequest run_request(const nb::dict& options);
nb::dict report_dict(const RunReport& report);

}  // namespace gloam::python
