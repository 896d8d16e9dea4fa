#pragma once
// Runs a job and tells the user about it: progress, where the results lie, JSON.

#include "command.h"

namespace gloam::cli {

int run_and_report(const World& world, const RunRequest& request, const Globals& globals);

}  // namespace gloam::cli
