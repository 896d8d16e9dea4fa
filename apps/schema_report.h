#pragma once
// Report of `gloam info --schema`: the coverage of MuJoCo's schema.

#include "command.h"

namespace gloam::cli {

/// Exit code 1 if anything is missing.
int report_schema(const Globals& globals);

}  // namespace gloam::cli
