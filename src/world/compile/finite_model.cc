#include "world/compile/finite_model.h"

#include <fmt/format.h>
#include <mujoco/mjxmacro.h>

#include <cmath>
#include <string_view>

#include "world/model_names.h"

namespace gloam {
namespace {

int body_of(const mjModel& m, mjtObj type, int id) {
  switch (type) {
    case mjOBJ_JOINT:
      return m.jnt_bodyid[id];
    case mjOBJ_GEOM:
      return m.geom_bodyid[id];
    case mjOBJ_SITE:
      return m.site_bodyid[id];
    case mjOBJ_CAMERA:
      return m.cam_bodyid[id];
    case mjOBJ_LIGHT:
      return m.light_bodyid[id];
    default:
      return 0;
  }
}

// `field` of `rows` x `columns`, named as in mjModel: "cam_fovy".
template <class T>
std::optional<NotFinite> look_at(const mjModel& m, mjtObj type, std::string_view field,
                                 const T* values, mjtSize rows, mjtSize columns) {
  if constexpr (std::is_floating_point_v<T>) {
    field.remove_prefix(field.find('_') + 1);
    if (field == "user") return {};
    if (field.ends_with('0')) return {};  // computed from others, in the first configuration
    const bool may_be_endless =
        field.ends_with("range") || field == "margin" || field == "gap" || field == "springyield";
    for (mjtSize i = 0; i < rows * columns; ++i) {
      if (may_be_endless ? !std::isnan(values[i]) : std::isfinite(values[i])) continue;
      int id = static_cast<int>(i / columns);
      if (type == mjOBJ_DOF) {
        id = m.dof_jntid[id];
        type = mjOBJ_JOINT;
      }
      NotFinite found{type, id, name_of(m, type, id), {}};
      const char* owner = "";
      if (found.name.empty()) {
        found.name = name_of(m, mjOBJ_BODY, body_of(m, type, id));
        owner = " without a name in";
      }
      found.fault = fmt::format("{}{} '{}': {} is {}", mju_type2Str(type), owner, found.name, field,
                                std::isnan(values[i]) ? "not a number" : "infinite");
      return found;
    }
  }
  return {};
}

}  // namespace

std::optional<NotFinite> find_not_finite(const mjModel& model) {
  const mjModel* m = &model;
#undef MJ_M
#define MJ_M(n) m->n
#define X(type, field, rows, columns) \
  if (auto found = look_at(model, kind, #field, m->field, m->rows, columns)) return found;
  // The order is that of dependence: bodies have the inertia of their geoms.
  mjtObj kind = mjOBJ_MATERIAL;
  MJMODEL_POINTERS_MATERIAL
  kind = mjOBJ_GEOM;
  MJMODEL_POINTERS_GEOM
  kind = mjOBJ_SITE;
  MJMODEL_POINTERS_SITE
  kind = mjOBJ_CAMERA;
  MJMODEL_POINTERS_CAMERA
  kind = mjOBJ_LIGHT;
  MJMODEL_POINTERS_LIGHT
  kind = mjOBJ_JOINT;
  MJMODEL_POINTERS_JOINT
  kind = mjOBJ_BODY;
  MJMODEL_POINTERS_BODY
  kind = mjOBJ_DOF;
  MJMODEL_POINTERS_DOF
#undef X
  return {};
}

}  // namespace gloam
