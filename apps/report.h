#pragma once
// Runs a job and reports on it: progress, the place of the results, JSON.

#include "command.h"

namespace gloam::cli {

/// Costs and rates of streams as lines of text; none for none.
std::vector<std::string> sensor_table(const std::vector<SensorCost>& sensors);
/// Prints it; returns the exit code.
int tell_of(const Result<RunReport>& report, const Globals& globals);
int run_and_report(const World& world, const RunRequest& request, const Globals& globals);

}  // namespace gloam::cli
