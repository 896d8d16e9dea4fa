#pragma once
// What `gloam info --schema` prints: how much of MuJoCo's schema is mirrored.

#include "command.h"

namespace gloam::cli {

/// Exit code 1 if anything is missing.
int report_schema(const Globals& globals);

}  // namespace gloam::cli
