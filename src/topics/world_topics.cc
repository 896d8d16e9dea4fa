// Topics of the whole world: clock, frames, contacts.

#include <algorithm>
#include <cmath>

#include "ros/messages/gloam_msgs.h"
#include "ros/messages/rosgraph_msgs.h"
#include "ros/messages/tf2_msgs.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/model_names.h"
#include "world/streams.h"
#include "world/world.h"

namespace gloam {
namespace {

geometry_msgs::TransformStamped transform_of(double time, const std::string& parent,
                                             const std::string& child, const Pose& X_PC) {
  return {ros_header(time, parent), child, {ros_vector(X_PC.p), ros_quaternion(X_PC.q)}};
}

Status encode_clock(const TopicInfo&, TopicInstant& at, MessageBytes* out) {
  encode(rosgraph_msgs::Clock{ros_time(at.snapshot().time())}, out);
  return {};
}

Status encode_moving_frames(const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
  const mjModel& m = at.model();
  tf2_msgs::TFMessage message;
  for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
    if (!moves_in_parent(m, body)) continue;
    const int parent = m.body_parentid[body];
    GLOAM_TRY(const Pose X_WB, at.X_WB(body));
    GLOAM_TRY(const Pose X_WP, at.X_WB(parent));
    message.transforms.push_back(transform_of(at.snapshot().time(),
                                              parent == 0 ? topic.frame_id : body_frame(m, parent),
                                              body_frame(m, body), product(inverse(X_WP), X_WB)));
  }
  encode(message, out);
  return {};
}

// Optical frames look along +Z, x to the right (REP 103); MuJoCo's cameras along -Z, y up.
constexpr Pose kOptical = {{}, {0, 1, 0, 0}};

LatchedEncoder static_frames(const TopicWorld& world) {
  return [world](const TopicInfo& topic, const LatchedInputs& at, MessageBytes* out) {
    const double time = at.time;
    const mjModel& m = *world->model;
    tf2_msgs::TFMessage message;
    const auto frame = [&](int body) { return body == 0 ? topic.frame_id : body_frame(m, body); };
    for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
      if (moves_in_parent(m, body)) continue;
      const mjtNum *p = m.body_pos + 3 * body, *q = m.body_quat + 4 * body;
      message.transforms.push_back(transform_of(time, frame(m.body_parentid[body]),
                                                body_frame(m, body),
                                                {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}}));
    }
    std::vector<std::string> known;
    for (const StreamInfo& stream : list_streams(*world)) {
      const bool is_camera = stream.kind == StreamKind::kCamera;
      const bool is_placed =
          is_camera || stream.kind == StreamKind::kLidar || stream.kind == StreamKind::kSensor;
      const std::string parent = frame(stream.parent.id);
      const bool has_frame = stream.frame_id != parent && stream.frame_id != topic.frame_id;
      if (!is_placed || !has_frame || std::ranges::count(known, stream.frame_id) > 0) continue;
      known.push_back(stream.frame_id);
      message.transforms.push_back(transform_of(
          time, parent, stream.frame_id, is_camera ? product(stream.X_PS, kOptical) : stream.X_PS));
    }
    encode(message, out);
    return Status();
  };
}

Status encode_contacts(const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
  const mjModel& m = at.model();
  GLOAM_TRY(const Instant* forces, at.forces());
  gloam_msgs::Contacts message;
  message.header = ros_header(at.snapshot().time(), topic.frame_id);
  for (const ContactState& contact : forces->contacts()) {
    gloam_msgs::Contact& one = message.contacts.emplace_back();
    std::string* const bodies[2] = {&one.body1, &one.body2};
    std::string* const geoms[2] = {&one.geom1, &one.geom2};
    for (int side = 0; side < 2; ++side) {
      const int geom = contact.geoms[side].id;
      if (geom < 0) continue;
      *geoms[side] = name_of(m, mjOBJ_GEOM, geom);
      *bodies[side] = body_frame(m, m.geom_bodyid[geom]);
    }
    one.position = ros_point(contact.position);
    one.normal = ros_vector(contact.normal);
    const Vec3 &f = contact.force, &t = contact.torque;  // on the second; on the first: reversed
    one.wrench = {{-f.x, -f.y, -f.z}, {-t.x, -t.y, -t.z}};
    one.depth = -contact.distance;
  }
  encode(message, out);
  return {};
}

}  // namespace

void add_world_topics(const TopicWorld& world, TopicTable* table) {
  const mjModel& m = *world->model;
  table->push_back({{.name = "/clock",
                     .type = type_name<rosgraph_msgs::Clock>(),
                     .rate = kSampleRate,
                     .qos = kSensorQos,
                     .source = {.name = "simulation time"}},
                    {},
                    {},
                    InstantEncoder(encode_clock)});
  table->push_back({{.name = "/tf_static",
                     .type = type_name<tf2_msgs::TFMessage>(),
                     .frame_id = kWorldFrameId,
                     .qos = kLatchedQos,
                     .source = {.name = "static bodies, sensors"},
                     .is_large = true},
                    {},
                    {},
                    static_frames(world)});
  bool any_moves = false;
  for (int body = 1; body < static_cast<int>(m.nbody); ++body)
    any_moves = any_moves || moves_in_parent(m, body);
  if (any_moves)
    table->push_back({{.name = "/tf",
                       .type = type_name<tf2_msgs::TFMessage>(),
                       .frame_id = kWorldFrameId,
                       .rate = kStateRate,
                       .qos = {.depth = 100},
                       .source = {.name = "moving bodies"}},
                      {},
                      {},
                      InstantEncoder(encode_moving_frames)});
  if (m.nv > 0)
    table->push_back({{.name = "/contacts",
                       .type = type_name<gloam_msgs::Contacts>(),
                       .frame_id = kWorldFrameId,
                       .rate = kStateRate,
                       .source = {.name = "contacts"}},
                      {},
                      {},
                      InstantEncoder(encode_contacts)});
}

}  // namespace gloam
