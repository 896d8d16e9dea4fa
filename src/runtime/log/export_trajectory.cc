// Trajectories out of logs, and as others' files.

#include <fmt/format.h>

#include <array>
#include <map>

#include "gloam/log_export.h"
#include "runtime/log/topic_reader.h"

namespace gloam {
namespace {

/// Where a type of message has its pose: names of the parts.
struct PosePlace {
  const char *prefix, *position, *orientation;
};

const std::map<std::string, PosePlace>& pose_places() {
  static const std::map<std::string, PosePlace> places = {
      {"nav_msgs/msg/Odometry", {"pose.pose.", "position", "orientation"}},
      {"geometry_msgs/msg/PoseStamped", {"pose.", "position", "orientation"}},
      {"geometry_msgs/msg/PoseWithCovarianceStamped", {"pose.pose.", "position", "orientation"}},
      {"geometry_msgs/msg/TransformStamped", {"transform.", "translation", "rotation"}},
  };
  return places;
}
constexpr PosePlace kTransform = {"transform.", "translation", "rotation"};
constexpr const char* kFrames = "tf2_msgs/msg/TFMessage";

Result<StampedPose> pose_at(const DynamicMessage& message, const std::string& above,
                            const PosePlace& place) {
  GLOAM_TRY(const int64_t seconds, message.integer(above + "header.stamp.sec"));
  GLOAM_TRY(const int64_t nanoseconds, message.integer(above + "header.stamp.nanosec"));
  GLOAM_TRY(const auto p, message.numbers(above + place.prefix + place.position));
  GLOAM_TRY(const auto q, message.numbers(above + place.prefix + place.orientation));
  if (p.size() != 3 || q.size() != 4)
    return Error{ErrorKind::kInput, "a pose must have 3 position and 4 orientation numbers"};
  return StampedPose{seconds * 1'000'000'000 + nanoseconds,
                     {{p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]}}};
}

Status take_frames(const DynamicMessage& message, const std::string& frame,
                   std::vector<StampedPose>* poses) {
  GLOAM_TRY(const size_t count, message.count("transforms"));
  for (size_t i = 0; i < count; ++i) {
    const std::string above = fmt::format("transforms[{}].", i);
    GLOAM_TRY(const std::string child, message.text(above + "child_frame_id"));
    if (child != frame) continue;
    GLOAM_TRY(const StampedPose pose, pose_at(message, above, kTransform));
    poses->push_back(pose);
  }
  return {};
}

// Rows of the rotation matrix of a unit quaternion.
std::array<double, 9> matrix_of(const Quat& q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

std::string line_of(const StampedPose& at, TrajectoryFormat format) {
  const Vec3& p = at.X_AB.p;
  const Quat& q = at.X_AB.q;
  switch (format) {
    case TrajectoryFormat::kTum:
      return fmt::format("{}.{:09} {} {} {} {} {} {} {}\n", at.stamp / 1'000'000'000,
                         at.stamp % 1'000'000'000, p.x, p.y, p.z, q.x, q.y, q.z, q.w);
    case TrajectoryFormat::kEuroc:
      return fmt::format("{},{},{},{},{},{},{},{}\n", at.stamp, p.x, p.y, p.z, q.w, q.x, q.y, q.z);
    case TrajectoryFormat::kKitti:
      break;
  }
  const auto R = matrix_of(q);
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}\n", R[0], R[1], R[2], p.x, R[3], R[4],
                     R[5], p.y, R[6], R[7], R[8], p.z);
}

}  // namespace

Result<std::vector<std::string>> trajectory_topics(const std::filesystem::path& log) {
  GLOAM_TRY(const McapReader reader, McapReader::open(log));
  GLOAM_TRY_STATUS(refuse_empty_log(reader));
  std::vector<std::string> topics;
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = reader.schemas().find(channel.schema);
    if (schema != reader.schemas().end() && pose_places().contains(schema->second.name))
      topics.push_back(channel.topic);
  }
  return topics;
}

Result<std::vector<StampedPose>> read_trajectory(const std::filesystem::path& log,
                                                 const std::string& topic) {
  GLOAM_TRY(const McapReader reader, McapReader::open(log));
  const size_t colon = topic.find(':');
  const std::string frame = colon == std::string::npos ? "" : topic.substr(colon + 1);
  GLOAM_TRY(const TopicReader logged, TopicReader::find(reader, topic.substr(0, colon)));
  std::vector<StampedPose> poses;
  if (logged.schema.name() == kFrames && !frame.empty()) {
    GLOAM_TRY_STATUS(logged.for_each(
        reader, [&](const DynamicMessage& m) { return take_frames(m, frame, &poses); }));
  } else if (const auto place = pose_places().find(logged.schema.name());
             place != pose_places().end() && frame.empty()) {
    GLOAM_TRY_STATUS(logged.for_each(reader, [&](const DynamicMessage& m) -> Status {
      GLOAM_TRY(const StampedPose pose, pose_at(m, "", place->second));
      poses.push_back(pose);
      return {};
    }));
  } else {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("topic '{}' has the type {}, which contains no pose", topic,
                             logged.schema.name()),
                 {},
                 "choose an Odometry or PoseStamped topic, or a frame such as /tf:robot/base"};
  }
  if (poses.empty())
    return Error{ErrorKind::kInput,
                 fmt::format("topic '{}' has no poses in {}", topic, log.string())};
  return poses;
}

std::string trajectory_text(const std::vector<StampedPose>& poses, TrajectoryFormat format) {
  std::string text;
  if (format == TrajectoryFormat::kEuroc)
    text =
        "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y "
        "[], q_RS_z []\n";
  for (const StampedPose& pose : poses) text += line_of(pose, format);
  return text;
}

}  // namespace gloam
