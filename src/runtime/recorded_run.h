#pragma once
// A recorded run of a motion instead of physics.

#include <memory>

#include "gloam/run.h"
#include "sim/loop/motion.h"

namespace gloam {

/// run_and_record() of bodies that move as `motion` tells; null = by physics.
Result<RunReport> record_motion(const World& world, const RunRequest& request,
                                std::unique_ptr<Motion> motion, const ProgressCallback& progress);

}  // namespace gloam
