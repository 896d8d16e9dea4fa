#pragma once
// Trajectories as the command line names them: a file, or a topic of a log.

#include <string>

#include "gloam/result.h"
#include "gloam/trajectory.h"

namespace gloam::cli {

/// Only topic with poses of a log. Errors: none, or several, by their names.
Result<std::string> only_pose_topic(const std::string& log);

/// "odom.tum", "LOG.mcap:/odom", "LOG.mcap:/tf:robot/base", or "LOG.mcap" with one topic of poses.
Result<Trajectory> load_trajectory(const std::string& source);

}  // namespace gloam::cli
