#pragma once
// Runs a job and tells the user about it: progress, where the results lie, JSON.

#include "command.h"

namespace gloam::cli {

/// Costs and rates of streams as lines of text; none for none.
std::vector<std::string> sensor_table(const std::vector<SensorCost>& sensors);
/// Prints it; returns the exit code.
int tell_of(const Result<RunReport>& report, const Globals& globals);
int run_and_report(const World& world, const RunRequest& request, const Globals& globals);

}  // namespace gloam::cli
