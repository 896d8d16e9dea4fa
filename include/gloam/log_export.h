#pragma once
// Export of logs for other tools: trajectories as TUM, KITTI and EuRoC files, topics as tables.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/trajectory.h"

namespace gloam {

/// Reads the poses of one topic in the order of the log: Odometry, PoseStamped,
/// PoseWithCovarianceStamped, TransformStamped, or "/tf:FRAME" for one child frame of a TFMessage,
/// relative to its parent. Accepts logs of any writer. Errors: no such topic, another type, no pose
/// in it, a malformed message.
Result<std::vector<StampedPose>> read_trajectory(const std::filesystem::path& log,
                                                 const std::string& topic);
/// Topics that read_trajectory() accepts, except TFMessages.
Result<std::vector<std::string>> trajectory_topics(const std::filesystem::path& log);

enum class TrajectoryFormat : uint8_t {
  kTum,    ///< "t x y z qx qy qz qw" [s], [m]
  kKitti,  ///< rows of the 3x4 matrix, no times
  kEuroc,  ///< CSV: [ns], [m], qw qx qy qz
};
std::string trajectory_text(const std::vector<StampedPose>& poses, TrajectoryFormat format);

/// Writes the messages of a topic as CSV: a row for each message, a column for every number and
/// text of the first message except long arrays of bytes. Additional fields of later messages are
/// omitted; missing ones are empty. Returns the number of rows. Errors: no such topic, the file
/// already exists.
Result<int64_t> write_topic_table(const std::filesystem::path& log, const std::string& topic,
                                  const std::filesystem::path& to);

}  // namespace gloam
