#include "world/view/render_origin.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/mesh/single.h"
#include "scene/files/mujoco_guard.h"
#include "world/model_memory.h"

namespace gloam {
namespace {

constexpr double kGrid = 1024;  // [m] that origins are multiples of: floats hold them exactly

bool is_far(const mjtNum* p) {
  return std::any_of(p, p + 3, [](mjtNum x) { return std::abs(x) > kFarFromOrigin; });
}

/// True if a body of the model starts far out.
bool starts_far(const mjModel& m, int key) {
  for (int b = 1; b < static_cast<int>(m.nbody); ++b)
    if (m.body_parentid[b] == 0 && is_far(m.body_pos + 3 * b)) return true;
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g)
    if (m.geom_bodyid[g] == 0 && is_far(m.geom_pos + 3 * g)) return true;
  if (key < 0) return false;
  for (int j = 0; j < static_cast<int>(m.njnt); ++j)
    if (m.jnt_type[j] == mjJNT_FREE && is_far(m.key_qpos + m.nq * key + m.jnt_qposadr[j]))
      return true;
  return false;
}

double rounded_median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return std::round(*middle / kGrid) * kGrid;
}

bool has_effects(const CompiledWorld& world) {
  const Scene& scene = world.scene;
  return !scene.volumes.empty() || !world.gases.gases.empty() || !world.waters.empty() ||
         !world.soils.empty() || !world.agents.empty() || scene.weather.has_value();
}

template <class T>
void move(const std::array<double, 3>& by, T* p) {
  for (size_t i = 0; i < 3; ++i) p[i] -= static_cast<T>(by[i]);
}

ModelPtr copy_of(const mjModel* model) {
  return model != nullptr ? copy_model(*model) : ModelPtr();
}

}  // namespace

Vec3 choose_render_origin(const CompiledWorld& world, std::vector<Error>* notes) {
  const mjModel& m = *world.model;
  if (m.ngeom == 0 || !starts_far(m, world.initial_key)) return {};
  const DataPtr data = make_data(m);
  if (world.initial_key >= 0) mj_resetDataKeyframe(&m, data.get(), world.initial_key);
  mj_kinematics(&m, data.get());
  double origin[3];
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (int g = 0; g < static_cast<int>(m.ngeom); ++g)
      places.push_back(data->geom_xpos[3 * g + axis]);
    origin[axis] = rounded_median(places);
  }
  const Vec3 found{origin[0], origin[1], origin[2]};
  if (is_far(origin) && has_effects(world)) {
    notes->push_back({ErrorKind::kInput,
                      "the scene is far from the origin and has weather, media, water, soil or "
                      "agents: images and scans are limited to single precision there",
                      {world.scene.file.string(), 0, 0},
                      "move it closer to the origin"});
    return {};
  }
  return is_far(origin) ? found : Vec3{};
}

void move_model(const Vec3& origin, mjModel* model) {
  mjModel& m = *model;
  const std::array<double, 3> by{origin.x, origin.y, origin.z};
  for (int b = 1; b < static_cast<int>(m.nbody); ++b)
    if (m.body_parentid[b] == 0) move(by, m.body_pos + 3 * b);
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g)
    if (m.geom_bodyid[g] == 0) move(by, m.geom_pos + 3 * g);
  for (int s = 0; s < static_cast<int>(m.nsite); ++s)
    if (m.site_bodyid[s] == 0) move(by, m.site_pos + 3 * s);
  for (int c = 0; c < static_cast<int>(m.ncam); ++c) {
    if (m.cam_bodyid[c] != 0) continue;
    move(by, m.cam_pos + 3 * c);
    move(by, m.cam_pos0 + 3 * c);
  }
  for (int l = 0; l < static_cast<int>(m.nlight); ++l) {
    if (m.light_bodyid[l] != 0) continue;
    move(by, m.light_pos + 3 * l);
    move(by, m.light_pos0 + 3 * l);
  }
  for (int v = 0; v < static_cast<int>(m.nflexvert); ++v)
    if (m.flex_vertbodyid[v] == 0) move(by, m.flex_vert + 3 * v);
  for (int j = 0; j < static_cast<int>(m.njnt); ++j) {
    if (m.jnt_type[j] != mjJNT_FREE) continue;
    move(by, m.qpos0 + m.jnt_qposadr[j]);
    for (int k = 0; k < static_cast<int>(m.nkey); ++k)
      move(by, m.key_qpos + m.nq * k + m.jnt_qposadr[j]);
  }
  for (int k = 0; k < static_cast<int>(m.nkey * m.nmocap); ++k) move(by, m.key_mpos + 3 * k);
  move(by, m.stat.center);
}

void move_state(const mjModel& model, const Vec3& origin, mjData* data) {
  const std::array<double, 3> by{origin.x, origin.y, origin.z};
  for (int j = 0; j < static_cast<int>(model.njnt); ++j)
    if (model.jnt_type[j] == mjJNT_FREE) move(by, data->qpos + model.jnt_qposadr[j]);
  for (int i = 0; i < static_cast<int>(model.nmocap); ++i) move(by, data->mocap_pos + 3 * i);
}

Result<std::unique_ptr<CompiledWorld>> moved_world(const CompiledWorld& world) {
  auto out = std::make_unique<CompiledWorld>();
  const Vec3& origin = out->render_origin = world.render_origin;
  out->serial = world.serial;
  out->scene = world.scene;
  GLOAM_TRY_STATUS(guarded([&] {
    out->model = copy_of(world.model.get());
    out->visual_model = copy_of(world.visual_model.get());
  }));
  move_model(origin, out->model.get());
  for (LightOptions& light : out->scene.lights) {
    if (!light.body.empty()) continue;
    light.position = from_origin(light.position, origin);
    if (light.look_at) light.look_at = from_origin(*light.look_at, origin);
  }
  for (VisualOptions& visual : out->scene.visuals)
    if (visual.body.empty()) visual.X_BV.p = from_origin(visual.X_BV.p, origin);
  out->visual_only = world.visual_only;
  for (VisualOnlyGeom& geom : out->visual_only)
    if (geom.body == 0) geom.X_BG.p = from_origin(geom.X_BG.p, origin);
  out->visual_meshes = world.visual_meshes;
  out->initial_key = world.initial_key;
  out->ev100 = world.ev100;
  out->regions = world.regions;
  out->drawn = world.drawn;
  out->robots = world.robots;
  out->wind = world.wind;
  out->lines = world.lines;
  return out;
}

}  // namespace gloam
