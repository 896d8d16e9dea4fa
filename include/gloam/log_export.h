#pragma once
// Logs for other tools: trajectories as TUM, KITTI and EuRoC files, topics as tables.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/trajectory.h"

namespace gloam {

/// Poses of one topic in the order of the log: Odometry, PoseStamped, PoseWithCovarianceStamped,
/// TransformStamped, or "/tf:FRAME" for one child frame of a TFMessage, in its parent. Logs of any
/// writer. Errors: no such topic, none of these types, no pose in it, a damaged message.
Result<std::vector<StampedPose>> read_trajectory(const std::filesystem::path& log,
                                                 const std::string& topic);
/// Topics that read_trajectory() takes, without those of TFMessages.
Result<std::vector<std::string>> trajectory_topics(const std::filesystem::path& log);

enum class TrajectoryFormat : uint8_t {
  kTum,    ///< "t x y z qx qy qz qw" [s], [m]
  kKitti,  ///< rows of the 3x4 matrix, no times
  kEuroc,  ///< CSV: [ns], [m], qw qx qy qz
};
std::string trajectory_text(const std::vector<StampedPose>& poses, TrajectoryFormat format);

/// Messages of a topic as CSV: a row each, a column for every number and text of the first message;
/// long arrays of bytes are left out. What later messages have more is left out, what they have
/// less is empty. Returns the number of rows. Errors: no such topic, a file that is there already.
Result<int64_t> write_topic_table(const std::filesystem::path& log, const std::string& topic,
                                  const std::filesystem::path& to);

}  // namespace gloam
