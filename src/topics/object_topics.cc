// Topics of moving elements other than robots: objects as boxes, people and vehicles.

#include <algorithm>
#include <cmath>

#include "ros/messages/visualization_msgs.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/agents/agent_bodies.h"
#include "world/world.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

using visualization_msgs::Marker;

constexpr Rational kMarkerRate = {10, 1};  // [Hz]
constexpr double kThinnest = 1e-3;         // RViz shows nothing of a marker without extent [m]

/// A body that moves as one, and the box around its geoms in its axes.
struct ObjectBox {
  int body = 0;
  std::string name;
  Vec3 centre, size;  // in the body [m]
};

// The body that a body moves with, 0 = none.
int mover_of(const mjModel& m, int body) {
  while (body > 0 && !moves_in_parent(m, body)) body = m.body_parentid[body];
  return body;
}

// Pose of a body in the one that it moves with.
Pose pose_in_mover(const mjModel& m, int body, int mover) {
  Pose X = {};
  for (; body != mover; body = m.body_parentid[body]) {
    const mjtNum *p = m.body_pos + 3 * body, *q = m.body_quat + 4 * body;
    X = product({{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}}, X);
  }
  return X;
}

struct Bounds {
  double low[3] = {mjMAXVAL, mjMAXVAL, mjMAXVAL}, high[3] = {-mjMAXVAL, -mjMAXVAL, -mjMAXVAL};

  /// A geom's box, by the pose of the geom.
  void add(const Pose& X, const mjtNum* box) {
    const mjtNum q[4] = {X.q.w, X.q.x, X.q.y, X.q.z};
    mjtNum R[9], centre[3];
    mju_quat2Mat(R, q);
    mju_mulMatVec3(centre, R, box);
    const double p[3] = {X.p.x, X.p.y, X.p.z};
    for (int i = 0; i < 3; ++i) {
      double half = 0;
      for (int k = 0; k < 3; ++k) half += std::abs(R[3 * i + k]) * box[3 + k];
      low[i] = std::min(low[i], p[i] + centre[i] - half);
      high[i] = std::max(high[i], p[i] + centre[i] + half);
    }
  }
};

ObjectBox box_of(const mjModel& m, int body) {
  Bounds bounds;
  for (int geom = 0; geom < static_cast<int>(m.ngeom); ++geom) {
    const int holder = m.geom_bodyid[geom];
    if (m.geom_type[geom] == mjGEOM_PLANE || mover_of(m, holder) != body) continue;
    const mjtNum *p = m.geom_pos + 3 * geom, *q = m.geom_quat + 4 * geom;
    const Pose X_HG = {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
    bounds.add(product(pose_in_mover(m, holder, body), X_HG), m.geom_aabb + 6 * geom);
  }
  ObjectBox box{body, body_frame(m, body), {}, {}};
  if (bounds.low[0] > bounds.high[0]) return box;  // no geoms
  const double *a = bounds.low, *b = bounds.high;
  box.centre = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
  box.size = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return box;
}

// Bodies that float or are moved by hand, of no robot and no agent.
std::vector<int> object_bodies(const CompiledWorld& world) {
  const mjModel& m = *world.model;
  std::vector<int> bodies;
  for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
    const bool floats = m.body_jntnum[body] > 0 && m.jnt_type[m.body_jntadr[body]] == mjJNT_FREE;
    if ((!floats && m.body_mocapid[body] < 0) || find_agent(world, body) != nullptr) continue;
    if (std::ranges::any_of(world.robots, [&](const RobotInstance& robot) {
          return robot.root_body > 0 && is_part_of(m, body, robot.root_body);
        }))
      continue;
    bodies.push_back(body);
  }
  return bodies;
}

Marker cube(const TopicInfo& topic, double time, const std::string& name) {
  Marker marker;
  marker.header = ros_header(time, topic.frame_id);
  marker.ns = marker.text = name;
  marker.type = Marker::CUBE;
  return marker;
}

InstantEncoder objects(std::vector<ObjectBox> boxes) {
  return [boxes = std::move(boxes)](const TopicInfo& topic, TopicInstant& at,
                                    MessageBytes* out) -> Status {
    visualization_msgs::MarkerArray message;
    for (const ObjectBox& box : boxes) {
      Marker& marker = message.markers.emplace_back(cube(topic, at.snapshot().time(), box.name));
      GLOAM_TRY(const Pose X_WB, at.X_WB(box.body));
      marker.pose = ros_pose(product(X_WB, {box.centre, {}}));
      marker.scale = {std::max(box.size.x, kThinnest), std::max(box.size.y, kThinnest),
                      std::max(box.size.z, kThinnest)};
      marker.color = {0.4f, 0.6f, 0.8f, 0.8f};
    }
    encode(message, out);
    return {};
  };
}

Status encode_agents(const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
  visualization_msgs::MarkerArray message;
  for (const AgentDescription& agent : at.snapshot().data().world->agents) {
    Marker& marker = message.markers.emplace_back(cube(topic, at.snapshot().time(), agent.name));
    GLOAM_TRY(const Pose X_WA, at.X_WB(agent.body[0]));
    marker.pose = ros_pose(X_WA);
    marker.scale = {2 * agent.radius, 2 * agent.radius, agent.height};
    marker.color = {0.9f, 0.5f, 0.1f, 0.8f};
  }
  encode(message, out);
  return {};
}

}  // namespace

void add_object_topics(const TopicWorld& world, TopicTable* table) {
  const auto add = [table](const char* name, const char* source, InstantEncoder encode) {
    table->push_back({{.name = name,
                       .type = type_name<visualization_msgs::MarkerArray>(),
                       .frame_id = kWorldFrameId,
                       .rate = kMarkerRate,
                       .source = {.name = source},
                       .is_large = true},
                      {},
                      {},
                      std::move(encode)});
  };
  std::vector<ObjectBox> boxes;
  for (const int body : object_bodies(*world)) boxes.push_back(box_of(*world->model, body));
  if (!boxes.empty()) add("/objects", "floating bodies", objects(std::move(boxes)));
  if (!world->agents.empty()) add("/agents", "people and vehicles", encode_agents);
}

}  // namespace gloam
