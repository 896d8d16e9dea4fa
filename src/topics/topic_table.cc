#include "topics/topic_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/text.h"
#include "geometry/mesh/single.h"
#include "ros/message_types.h"
#include "topics/topic_names.h"
#include "world/view/render_origin.h"
#include "world/world.h"

namespace gloam {
namespace {

// A new kind of topics is a line here.
constexpr void (*kKinds[])(const TopicWorld&, TopicTable*) = {
    add_world_topics,        add_metric_topics, add_air_topics,      add_diagnostic_topics,
    add_object_topics,       add_robot_topics,  add_actuator_topics, add_sensor_topics,
    add_camera_topics,       add_label_topics,  add_lidar_topics,    add_input_topics,
    add_object_scene_topics,
};

std::vector<std::string> names_of(const TopicTable& table) {
  std::vector<std::string> names;
  for (const Topic& topic : table) names.push_back(topic.info.name);
  return names;
}

// Line of the last [[topic]] that gives a topic this name.
SourceLoc loc_of_rename(const Scene& scene, const std::string& name) {
  SourceLoc loc;
  for (const TopicOptions& options : scene.topics)
    if (options.rename == name) loc = options.loc;
  return loc;
}

}  // namespace

Result<Pose> TopicInstant::X_WB(int body) {
  if (body == 0) return Pose{};
  if (!has_poses_) GLOAM_TRY_STATUS(solver_.solve_bodies(snapshot_, poses_));
  has_poses_ = true;
  const auto id = static_cast<size_t>(body);
  const double *p = poses_.body_p.data() + 3 * id, *R = poses_.body_R.data() + 9 * id;
  mjtNum q[4];
  mju_mat2Quat(q, R);
  const Vec3& o = snapshot_.data().world->render_origin;
  return Pose{{p[0] + o.x, p[1] + o.y, p[2] + o.z}, {q[0], q[1], q[2], q[3]}};
}

Result<const Instant*> TopicInstant::forces() {
  if (!has_forces_) GLOAM_TRY_STATUS(instant_.solve(snapshot_));
  has_forces_ = true;
  return const_cast<const Instant*>(&instant_);
}

const char* to_string(TopicSource::Kind kind) {
  switch (kind) {
    case TopicSource::Kind::kSimulation:
      return "simulation";
    case TopicSource::Kind::kRobot:
      return "robot";
    case TopicSource::Kind::kCamera:
      return "camera";
    case TopicSource::Kind::kLidar:
      return "lidar";
    case TopicSource::Kind::kSensor:
      return "sensor";
    case TopicSource::Kind::kGas:
      return "gas";
    case TopicSource::Kind::kBody:
      return "body";
  }
  return "simulation";
}

std::string to_string(const TopicSource& source) {
  if (source.kind == TopicSource::Kind::kSimulation) return source.name;
  const char* const mocap = source.kind == TopicSource::Kind::kBody ? "mocap " : "";
  return fmt::format("{}{} {}", mocap, to_string(source.kind), source.name);
}

Result<std::vector<const Topic*>> find_topics(const TopicTable& table, const std::string& pattern) {
  std::vector<const Topic*> found;
  for (const Topic& topic : table)
    if (topic.info.name == pattern || fits_pattern(pattern, topic.info.name))
      found.push_back(&topic);
  if (!found.empty()) return found;
  return Error{ErrorKind::kInput,
               fmt::format("there is no topic '{}'", pattern),
               {},
               suggest_name(pattern, names_of(table))};
}

namespace {

// By the rules alone, without the scene's [[topic]]s.
TopicTable table_by_rules(const TopicWorld& world, std::vector<Error>* notes) {
  TopicTable table;
  for (const auto add : kKinds) add(world, &table);
  make_names_unique(&table, notes);
  return table;
}

}  // namespace

Result<TopicTable> make_topic_table(const std::shared_ptr<const CompiledWorld>& world) {
  std::vector<Error> notes;
  TopicTable table = table_by_rules(world, &notes);
  // A later line wins, as elsewhere in scenes; names are those of the rules.
  const std::vector<std::string> names = names_of(table);
  std::vector<bool> is_off(table.size());
  for (const TopicOptions& options : world->scene.topics) {
    bool fits_one = false;
    for (size_t i = 0; i < table.size(); ++i) {
      if (names[i] != options.name && !fits_pattern(options.name, names[i])) continue;
      fits_one = true;
      TopicInfo& info = table[i].info;
      if (!options.rename.empty()) info.name = options.rename;
      if (!options.frame.empty()) info.frame_id = options.frame;
      if (options.rate) info.rate = *options.rate;
      if (options.log) info.is_logged = *options.log;
      if (options.off) is_off[i] = *options.off;
    }
    if (!fits_one)
      return Error{ErrorKind::kInput, fmt::format("there is no topic '{}'", options.name),
                   options.loc, suggest_name(options.name, names)};
  }
  TopicTable on;
  std::set<std::string> taken;
  for (size_t i = 0; i < table.size(); ++i) {
    if (is_off[i]) continue;
    if (!taken.insert(table[i].info.name).second)
      return Error{ErrorKind::kInput,
                   fmt::format("two topics would have the name '{}'", table[i].info.name),
                   loc_of_rename(world->scene, table[i].info.name), "choose another `rename`"};
    on.push_back(std::move(table[i]));
  }
  return on;
}

std::vector<Error> topic_notes(const World& world) {
  std::vector<Error> notes;
  table_by_rules(world.compiled(), &notes);
  return notes;
}

Result<std::vector<TopicInfo>> list_topics(const World& world) {
  GLOAM_TRY(const TopicTable table, make_topic_table(world.compiled()));
  std::vector<TopicInfo> infos;
  for (const Topic& topic : table) infos.push_back(topic.info);
  return infos;
}

Result<MessageInfo> message_info(std::string_view type) {
  if (const MessageType* found = find_message_type(type); found != nullptr)
    return MessageInfo{found->dds_name, found->text, found->hash};
  std::vector<std::string> names;
  for (const MessageType& known : message_types()) names.push_back(known.name);
  return Error{ErrorKind::kInput,
               fmt::format("unknown message type '{}'", type),
               {},
               suggest_name(std::string(type), names)};
}

}  // namespace gloam
