#include "gloam/world.h"

#include <fmt/format.h>

#include <atomic>

#include "base/text.h"
#include "world/compile/initial_overlaps.h"
#include "world/compile/level.h"
#include "world/sensors/visual_camera.h"
#include "world/shapes/visual_file.h"
#include "world/world.h"

namespace gloam {
namespace {

template <class H>
Result<H> find(const CompiledWorld& world, mjtObj type, const char* kind, const std::string& name) {
  const mjModel* m = world.model.get();
  const int id = mj_name2id(m, type, name.c_str());
  if (id >= 0) return H{id, world.serial};
  return Error{ErrorKind::kInput,
               fmt::format("there is no {} '{}'", kind, name),
               {},
               suggest_name(name, object_names(m, type))};
}

const char* shape_name(int type) {
  static constexpr const char* kTypes[] = {
      "plane", "height field", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"};
  return type >= 0 && type < 9 ? kTypes[type] : "other";
}

std::string numbers(const mjtNum* values, int n) {
  std::string text;
  for (int i = 0; i < n; ++i) text += fmt::format("{}{:.4g}", i == 0 ? "" : " ", values[i]);
  return text;
}

std::string joint_detail(const mjModel* m, int joint) {
  static constexpr const char* kTypes[] = {"free", "ball", "slide", "hinge"};
  std::string text = kTypes[m->jnt_type[joint]];
  if (m->jnt_limited[joint]) {
    const char* unit = m->jnt_type[joint] == mjJNT_SLIDE ? "m" : "rad";
    text += fmt::format(", range {} {}", numbers(m->jnt_range + 2 * joint, 2), unit);
  }
  return text;
}

std::string actuator_detail(const mjModel* m, int actuator) {
  const int target = m->actuator_trnid[2 * actuator];
  mjtObj type = mjOBJ_UNKNOWN;
  switch (m->actuator_trntype[actuator]) {
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      type = mjOBJ_JOINT;
      break;
    case mjTRN_TENDON:
      type = mjOBJ_TENDON;
      break;
    case mjTRN_SITE:
    case mjTRN_SLIDERCRANK:
      type = mjOBJ_SITE;
      break;
    case mjTRN_BODY:
      type = mjOBJ_BODY;
      break;
    default:
      break;
  }
  const char* name = type == mjOBJ_UNKNOWN ? nullptr : mj_id2name(m, type, target);
  std::string text = name == nullptr ? "" : fmt::format("{} '{}'", mju_type2Str(type), name);
  const int ctrl = m->actuator_ctrladr[actuator];
  if (ctrl >= 0 && m->actuator_ctrlnum[actuator] > 0 && m->actuator_ctrllimited[ctrl])
    text += fmt::format("{}control {}", text.empty() ? "" : ", ",
                        numbers(m->actuator_ctrlrange + 2 * ctrl, 2));
  return text;
}

// As MJCF spells it, where the camera has a resolution of its own: MuJoCo's default is 1x1.
std::string camera_detail(const mjModel* m, int i) {
  const char* body = mj_id2name(m, mjOBJ_BODY, m->cam_bodyid[i]);
  const int* size = m->cam_resolution + 2 * i;
  std::string text = size[0] > 1 || size[1] > 1 ? fmt::format("{}x{}, ", size[0], size[1]) : "";
  text += m->cam_projection[i] == mjPROJ_ORTHOGRAPHIC
              ? fmt::format("orthographic, {:.4g} m high", m->cam_fovy[i])
              : fmt::format("{:.4g} deg", m->cam_fovy[i]);
  return text + fmt::format(", on '{}'", body == nullptr ? "" : body);
}

std::string site_detail(const mjModel* m, int i) {
  const char* body = mj_id2name(m, mjOBJ_BODY, m->site_bodyid[i]);
  return fmt::format("{}, group {}, on '{}'", shape_name(m->site_type[i]), m->site_group[i],
                     body == nullptr ? "" : body);
}

std::string tendon_detail(const mjModel* m, int i) {
  const int first = m->tendon_adr[i];
  const bool is_fixed = m->tendon_num[i] > 0 && m->wrap_type[first] == mjWRAP_JOINT;
  std::string text = is_fixed ? fmt::format("fixed, of {} joint{}", m->tendon_num[i],
                                            m->tendon_num[i] == 1 ? "" : "s")
                              : fmt::format("spatial, {:.4g} m wide", 2 * m->tendon_width[i]);
  if (m->tendon_limited[i])
    text += fmt::format(", range {}{}", numbers(m->tendon_range + 2 * i, 2), is_fixed ? "" : " m");
  return text + fmt::format(", group {}", m->tendon_group[i]);
}

std::string equality_detail(const mjModel* m, int i) {
  static constexpr const char* kTypes[] = {"connect", "weld", "joint", "tendon", "flex"};
  const int type = m->eq_type[i];
  std::string text =
      type >= 0 && type < static_cast<int>(std::size(kTypes)) ? kTypes[type] : "other";
  const auto kind = static_cast<mjtObj>(m->eq_objtype[i]);
  const mjtObj of = type == mjEQ_JOINT ? mjOBJ_JOINT : type == mjEQ_TENDON ? mjOBJ_TENDON : kind;
  for (const int id : {m->eq_obj1id[i], m->eq_obj2id[i]}) {
    const char* name = id >= 0 ? mj_id2name(m, of, id) : nullptr;
    if (name != nullptr) text += fmt::format(" '{}'", name);
  }
  return text + (m->eq_active0[i] ? "" : ", off at the start");
}

std::string texture_detail(const mjModel* m, int i) {
  static constexpr const char* kTypes[] = {"2d", "cube", "skybox"};
  const int type = m->tex_type[i];
  return fmt::format("{}, {}x{}", type >= 0 && type < 3 ? kTypes[type] : "other", m->tex_width[i],
                     m->tex_height[i]);
}

std::string geom_detail(const mjModel* m, int geom) {
  const int type = m->geom_type[geom];
  std::string text = shape_name(type);
  if (type == mjGEOM_MESH && m->geom_dataid[geom] >= 0) {
    if (const char* mesh = mj_id2name(m, mjOBJ_MESH, m->geom_dataid[geom]))
      text += fmt::format(" '{}'", mesh);
  }
  if (const int field = m->geom_dataid[geom]; type == mjGEOM_HFIELD && field >= 0)
    text += fmt::format(" of {} x {}", m->hfield_ncol[field], m->hfield_nrow[field]);
  return text + fmt::format(", group {}", m->geom_group[geom]);
}

template <class Detail>
std::vector<NamedElement> list(const mjModel* m, mjtObj type, Detail&& detail) {
  std::vector<NamedElement> elements;
  const std::vector<std::string> names = object_names(m, type);
  for (size_t i = 0; i < names.size(); ++i)
    elements.push_back({names[i], detail(m, static_cast<int>(i))});
  return elements;
}

int64_t count_triangles(const mjModel* m, bool hidden_groups) {
  int64_t triangles = 0;
  for (int geom = 0; geom < m->ngeom; ++geom) {
    const int mesh = m->geom_dataid[geom];
    if (mesh < 0 || (!hidden_groups && m->geom_group[geom] > 2)) continue;
    if (m->geom_type[geom] == mjGEOM_MESH || m->geom_type[geom] == mjGEOM_SDF)
      triangles += m->mesh_facenum[mesh];
    if (m->geom_type[geom] == mjGEOM_HFIELD)
      triangles += int64_t{2} * (m->hfield_nrow[mesh] - 1) * (m->hfield_ncol[mesh] - 1);
  }
  return triangles;
}

}  // namespace

uint64_t next_world_serial() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

Result<Joint> World::find_joint(const std::string& name) const {
  return find<Joint>(*compiled_, mjOBJ_JOINT, "joint", name);
}
Result<Body> World::find_body(const std::string& name) const {
  return find<Body>(*compiled_, mjOBJ_BODY, "body", name);
}
Result<Actuator> World::find_actuator(const std::string& name) const {
  return find<Actuator>(*compiled_, mjOBJ_ACTUATOR, "actuator", name);
}
Result<SensorHandle> World::find_sensor(const std::string& name) const {
  return find<SensorHandle>(*compiled_, mjOBJ_SENSOR, "sensor", name);
}
Result<Camera> World::find_camera(const std::string& name) const {
  const mjModel* m = compiled_->model.get();
  for (int i = 0; i < static_cast<int>(m->ncam); ++i) {
    if (camera_name(*m, i) == name) return Camera{i, compiled_->serial};
  }
  return find<Camera>(*compiled_, mjOBJ_CAMERA, "camera", name);
}
Result<Geom> World::find_geom(const std::string& name) const {
  return find<Geom>(*compiled_, mjOBJ_GEOM, "geom", name);
}
Result<Tendon> World::find_tendon(const std::string& name) const {
  return find<Tendon>(*compiled_, mjOBJ_TENDON, "tendon", name);
}
Result<Equality> World::find_equality(const std::string& name) const {
  return find<Equality>(*compiled_, mjOBJ_EQUALITY, "equality constraint", name);
}

uint64_t World::serial() const { return compiled_->serial; }

Result<std::vector<std::string>> World::names(const std::string& type) const {
  const auto kind = static_cast<mjtObj>(mju_str2Type(type.c_str()));
  if (object_count(*compiled_->model, kind) >= 0) return object_names(compiled_->model.get(), kind);
  return Error{ErrorKind::kUsage, fmt::format("MuJoCo has no elements of type '{}'", type)};
}

WorldInfo World::info() const {
  const mjModel* m = compiled_->model.get();
  WorldInfo info;
  info.bodies = list(m, mjOBJ_BODY, [](const mjModel* m, int i) {
    return fmt::format("{:.4g} kg", m->body_mass[i]);
  });
  info.joints = list(m, mjOBJ_JOINT, joint_detail);
  info.actuators = list(m, mjOBJ_ACTUATOR, actuator_detail);
  info.sensors = list(m, mjOBJ_SENSOR, [](const mjModel* m, int i) {
    const int dim = m->sensor_dim[i];
    return fmt::format("{} number{}", dim, dim == 1 ? "" : "s");
  });
  for (const ProbeDescription& probe : compiled_->probes)
    info.sensors.push_back({probe.options.name, "probe of " + probe.options.quantity});
  info.cameras = list(m, mjOBJ_CAMERA, camera_detail);
  for (size_t i = 0; i < info.cameras.size(); ++i)
    info.cameras[i].name = camera_name(*m, static_cast<int>(i));
  info.geoms = list(m, mjOBJ_GEOM, geom_detail);
  info.lights = list(m, mjOBJ_LIGHT, [](const mjModel* m, int i) {
    static constexpr const char* kTypes[] = {"spot", "directional", "point", "image"};
    const int type = m->light_type[i];
    return std::string(type >= 0 && type < 4 ? kTypes[type] : "other");
  });
  info.materials = list(m, mjOBJ_MATERIAL, [](const mjModel* m, int i) {
    const float* c = m->mat_rgba + 4 * i;
    return fmt::format("rgba {:.3g} {:.3g} {:.3g} {:.3g}", c[0], c[1], c[2], c[3]);
  });
  info.sites = list(m, mjOBJ_SITE, site_detail);
  info.tendons = list(m, mjOBJ_TENDON, tendon_detail);
  info.equalities = list(m, mjOBJ_EQUALITY, equality_detail);
  info.keyframes = list(m, mjOBJ_KEY, [](const mjModel* m, int i) {
    return fmt::format("at {:.4g} s", m->key_time[i]);
  });
  info.textures = list(m, mjOBJ_TEXTURE, texture_detail);
  info.nq = static_cast<int>(m->nq);
  info.nv = static_cast<int>(m->nv);
  info.nu = static_cast<int>(m->nu);
  info.timestep = m->opt.timestep;
  info.mass = mj_getTotalmass(m);
  info.model_bytes = static_cast<int64_t>(mj_sizeModel(m));
  info.triangles = count_triangles(m, false);
  if (compiled_->visual_model != nullptr)
    info.triangles += count_triangles(compiled_->visual_model.get(), true);
  info.triangles += count_visual_triangles(*compiled_);
  info.regions = compiled_->regions;
  info.drawn = compiled_->drawn;
  info.notes = notes();
  info.unsupported = unsupported();
  return info;
}

std::vector<Error> World::notes() const {
  std::vector<Error> notes = compiled_->notes;
  notes.insert(notes.end(), compiled_->place_notes.begin(), compiled_->place_notes.end());
  const std::vector<Error> starts = find_initial_overlaps(*compiled_);
  notes.insert(notes.end(), starts.begin(), starts.end());
  return notes;
}
const std::vector<Error>& World::unsupported() const { return compiled_->unsupported; }

}  // namespace gloam
