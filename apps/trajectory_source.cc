#include "trajectory_source.h"

#include <filesystem>

#include "gloam/log_export.h"
#include "log_report.h"

namespace gloam::cli {

Result<std::string> only_pose_topic(const std::string& log) {
  GLOAM_TRY(const auto topics, trajectory_topics(log));
  if (topics.size() == 1) return topics[0];
  std::string all;
  for (const std::string& topic : topics) all += (all.empty() ? "" : ", ") + topic;
  return Error{
      ErrorKind::kUsage,
      topics.empty() ? "the log has no pose topics" : "the log has several pose topics: " + all,
      {},
      "choose one with --topic or as LOG.mcap:/topic; a frame is written as /tf:robot/base"};
}

Result<Trajectory> load_trajectory(const std::string& source) {
  const size_t split = source.find(":/");
  const std::string file = source.substr(0, split);
  if (!is_log(file)) {
    // "a.bag:/odom" names a topic of a log, but a file name may contain a colon as well.
    std::error_code code;
    return read_trajectory_file(std::filesystem::exists(source, code) ? source : file);
  }
  std::string topic;
  if (split != std::string::npos) {
    topic = source.substr(split + 1);
  } else {
    GLOAM_TRY(topic, only_pose_topic(file));
  }
  GLOAM_TRY(const auto poses, read_trajectory(file, topic));
  return make_trajectory(poses, file + ":" + topic);
}

}  // namespace gloam::cli
