// The topic /scene: what is simulated as Foxglove's primitives, an entity a body in the frame that
// /tf moves. Said once; visuals of files that are only drawn are not in it.

#include <algorithm>
#include <cmath>

#include "gloam/scene.h"
#include "ros/messages/foxglove_msgs.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/shapes/visual_site.h"
#include "world/world.h"

namespace gloam {
namespace {

using foxglove_msgs::Color;
using foxglove_msgs::SceneEntity;

constexpr double kPlaneSize = 100;         // edge of a plane without end [m]
constexpr double kPlaneThickness = 1e-3;   // [m], below its surface
constexpr size_t kMostPoints = 2'000'000;  // points of meshes in the message: 48 MB; then boxes
constexpr int kMostSamples = 256;          // of a height field along an edge
constexpr float kNoColor[4] = {0.5f, 0.5f, 0.5f, 1};  // MuJoCo's default: the material's counts

Pose geom_pose(const mjModel& m, int geom) {
  const mjtNum *p = m.geom_pos + 3 * geom, *q = m.geom_quat + 4 * geom;
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

Color geom_color(const mjModel& m, int geom) {
  const float* rgba = m.geom_rgba + 4 * geom;
  const int material = m.geom_matid[geom];
  if (material >= 0 && std::equal(rgba, rgba + 4, kNoColor)) rgba = m.mat_rgba + 4 * material;
  return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

class EntityMaker {
 public:
  EntityMaker(const mjModel& model, size_t* points) : m_(model), points_(points) {}

  void add(int geom, SceneEntity* entity) {
    const mjtNum* size = m_.geom_size + 3 * geom;
    const Pose X_BG = geom_pose(m_, geom);
    const Color color = geom_color(m_, geom);
    switch (m_.geom_type[geom]) {
      case mjGEOM_PLANE:
        return add_plane(size, X_BG, color, entity);
      case mjGEOM_BOX:
        entity->cubes.push_back({ros_pose(X_BG), doubled(size[0], size[1], size[2]), color});
        return;
      case mjGEOM_SPHERE:
        entity->spheres.push_back({ros_pose(X_BG), doubled(size[0], size[0], size[0]), color});
        return;
      case mjGEOM_ELLIPSOID:
        entity->spheres.push_back({ros_pose(X_BG), doubled(size[0], size[1], size[2]), color});
        return;
      case mjGEOM_CYLINDER:
        return add_cylinder(size, X_BG, color, entity);
      case mjGEOM_CAPSULE:
        add_cylinder(size, X_BG, color, entity);
        for (const double z : {-size[1], size[1]})
          entity->spheres.push_back({ros_pose(product(X_BG, {{0, 0, z}, {}})),
                                     doubled(size[0], size[0], size[0]), color});
        return;
      case mjGEOM_HFIELD:
        return add_height_field(m_.geom_dataid[geom], X_BG, color, entity);
      case mjGEOM_MESH:
        if (add_mesh(m_.geom_dataid[geom], X_BG, color, entity)) return;
        break;
      default:
        break;
    }
    const mjtNum* box = m_.geom_aabb + 6 * geom;
    entity->cubes.push_back({ros_pose(product(X_BG, {{box[0], box[1], box[2]}, {}})),
                             doubled(box[3], box[4], box[5]), color});
  }

 private:
  static geometry_msgs::Vector3 doubled(double x, double y, double z) {
    return {2 * x, 2 * y, 2 * z};
  }
  static void add_plane(const mjtNum* size, const Pose& X, const Color& color,
                        SceneEntity* entity) {
    const double x = size[0] > 0 ? 2 * size[0] : kPlaneSize;
    const double y = size[1] > 0 ? 2 * size[1] : kPlaneSize;
    const Pose X_middle = product(X, {{0, 0, -kPlaneThickness / 2}, {}});
    entity->cubes.push_back({ros_pose(X_middle), {x, y, kPlaneThickness}, color});
  }
  static void add_cylinder(const mjtNum* size, const Pose& X, const Color& color,
                           SceneEntity* entity) {
    entity->cylinders.push_back({ros_pose(X), doubled(size[0], size[0], size[1]), 1, 1, color});
  }

  // False where the message would become too large.
  bool add_mesh(int mesh, const Pose& X, const Color& color, SceneEntity* entity) {
    const auto count = static_cast<size_t>(m_.mesh_vertnum[mesh]);
    if (*points_ + count > kMostPoints) return false;
    *points_ += count;
    foxglove_msgs::TriangleListPrimitive list{ros_pose(X), {}, color, {}, {}};
    const float* vertices = m_.mesh_vert + 3 * m_.mesh_vertadr[mesh];
    for (size_t i = 0; i < count; ++i)
      list.points.push_back({vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]});
    const int* faces = m_.mesh_face + 3 * m_.mesh_faceadr[mesh];
    list.indices.assign(faces, faces + 3 * m_.mesh_facenum[mesh]);
    entity->triangles.push_back(std::move(list));
    return true;
  }

  void add_height_field(int field, const Pose& X, const Color& color, SceneEntity* entity) {
    const int rows = m_.hfield_nrow[field], columns = m_.hfield_ncol[field];
    const mjtNum* size = m_.hfield_size + 4 * field;
    const float* heights = m_.hfield_data + m_.hfield_adr[field];
    const int used_rows = std::min(rows, kMostSamples);
    const int used_columns = std::min(columns, kMostSamples);
    foxglove_msgs::TriangleListPrimitive list{ros_pose(X), {}, color, {}, {}};
    for (int i = 0; i < used_rows; ++i)
      for (int j = 0; j < used_columns; ++j) {
        const int row = i * (rows - 1) / (used_rows - 1);
        const int column = j * (columns - 1) / (used_columns - 1);
        list.points.push_back({size[0] * (2.0 * column / (columns - 1) - 1),
                               size[1] * (2.0 * row / (rows - 1) - 1),
                               size[2] * heights[row * columns + column]});
      }
    for (int i = 0; i + 1 < used_rows; ++i)
      for (int j = 0; j + 1 < used_columns; ++j) {
        const auto a = static_cast<uint32_t>(i * used_columns + j), b = a + 1;
        const uint32_t c = a + static_cast<uint32_t>(used_columns), d = c + 1;
        list.indices.insert(list.indices.end(), {a, b, d, a, d, c});
      }
    *points_ += list.points.size();
    entity->triangles.push_back(std::move(list));
  }

  const mjModel& m_;
  size_t* points_;
};

LatchedEncoder scene_update(const TopicWorld& world) {
  return [world](const TopicInfo& topic, const LatchedInputs& at, MessageBytes* out) -> Status {
    const mjModel& m = *world->model;
    foxglove_msgs::SceneUpdate message;
    // Shapes of an earlier World are taken away first.
    message.deletions.push_back({ros_time(at.time), foxglove_msgs::SceneEntityDeletion::ALL, ""});
    size_t points = 0;
    EntityMaker maker(m, &points);
    for (int body = 0; body < static_cast<int>(m.nbody); ++body) {
      SceneEntity entity;
      entity.timestamp = ros_time(at.time);
      entity.frame_id = body == 0 ? topic.frame_id : body_frame(m, body);
      entity.id = body_frame(m, body);
      entity.frame_locked = true;
      const int first = m.body_geomadr[body];
      for (int geom = first; geom < first + m.body_geomnum[body]; ++geom)
        if (draws_group(world->scene.render, m.geom_group[geom]) && geom_color(m, geom).a > 0)
          maker.add(geom, &entity);
      if (entity.cubes.empty() && entity.spheres.empty() && entity.cylinders.empty() &&
          entity.triangles.empty())
        continue;
      message.entities.push_back(std::move(entity));
    }
    encode(message, out);
    return {};
  };
}

}  // namespace

void add_object_scene_topics(const TopicWorld& world, TopicTable* table) {
  if (world->model->ngeom == 0) return;
  table->push_back({{.name = "/scene",
                     .type = type_name<foxglove_msgs::SceneUpdate>(),
                     .frame_id = kWorldFrameId,
                     .qos = kLatchedQos,
                     .is_logged = false,
                     .source = {.name = "shapes of all bodies"},
                     .is_large = true},
                    {},
                    {},
                    scene_update(world)});
}

}  // namespace gloam
