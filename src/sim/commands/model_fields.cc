#include "sim/commands/model_fields.h"

#include <fmt/format.h>
#include <mujoco/mjxmacro.h>

#include <cstring>

#include "base/text.h"
#include "sim/state/state_layout.h"
#include "world/compile/level.h"

namespace gloam {
namespace {

// Calls use(name, first value, whose the rows are, rows, columns) for every array of numbers.
// mjData's come first: of the few names that both have, the state's counts.
template <class Use>
void for_each_field(const mjModel* m, const mjData* d, Use&& use) {
#undef MJ_M
#undef MJ_D
#define MJ_M(n) m->n
#define MJ_D(n) d->n
#define X(type, name, rows, columns) use(#name, d->name, #rows, m->rows, columns);
  MJDATA_POINTERS
#undef X
#define X(type, name, rows, columns) use(#name, d->name, "", rows, columns);
  MJDATA_ARENA_POINTERS_SOLVER
  MJDATA_ARENA_POINTERS_DUAL
  MJDATA_ARENA_POINTERS_ISLAND
  MJDATA_ARENA_POINTERS_EFM
#undef X
#define X(type, name, rows, columns) use(#name, m->name, #rows, m->rows, columns);
  MJMODEL_POINTERS
#undef X
#define X(type, name) use(#name, &d->name, "", 1, 1);
  MJDATA_SCALAR
#undef X
#define X(type, name, size) use("opt." #name, &m->opt.name, "", 1, 1);
#define XVEC(type, name, size) use("opt." #name, m->opt.name, "", 1, size);
  MJOPTION_FIELDS
#undef X
#undef XVEC
#define X(name, size) use("stat." #name, &m->stat.name, "", 1, 1);
#define XVEC(name, size) use("stat." #name, m->stat.name, "", 1, size);
  MJSTATISTIC_FIELDS
#undef X
#undef XVEC
  use("energy", d->energy, "", 1, 2);
}

struct Range {
  int64_t first = 0, count = 0;
};

struct RowKind {
  const char* rows;
  mjtObj type;
  /// The rows of element `id`; null = row `id`.
  Range (*range)(const mjModel&, int id);
};

Range qpos_range(const mjModel& m, int id) {
  return {m.jnt_qposadr[id], joint_width(m.jnt_type[id]).qpos};
}
Range dof_range(const mjModel& m, int id) {
  return {m.jnt_dofadr[id], joint_width(m.jnt_type[id]).qvel};
}
Range act_range(const mjModel& m, int id) { return {m.actuator_actadr[id], m.actuator_actnum[id]}; }
Range ctrl_range(const mjModel& m, int id) {
  return {m.actuator_ctrladr[id], m.actuator_ctrlnum[id]};
}
Range output_range(const mjModel& m, int id) {
  const int64_t end = id + 1 < m.nactuator ? m.actuator_outadr[id + 1] : m.nout;
  return {m.actuator_outadr[id], end - m.actuator_outadr[id]};
}
Range sensor_range(const mjModel& m, int id) { return {m.sensor_adr[id], m.sensor_dim[id]}; }
Range mocap_range(const mjModel& m, int id) {
  return {m.body_mocapid[id], m.body_mocapid[id] < 0 ? 0 : 1};
}
Range plugin_state_range(const mjModel& m, int id) {
  return {m.plugin_stateadr[id], m.plugin_statenum[id]};
}
Range numeric_range(const mjModel& m, int id) { return {m.numeric_adr[id], m.numeric_size[id]}; }

constexpr RowKind kRowKinds[] = {
    {"nbody", mjOBJ_BODY, nullptr},         {"njnt", mjOBJ_JOINT, nullptr},
    {"nq", mjOBJ_JOINT, qpos_range},        {"nv", mjOBJ_JOINT, dof_range},
    {"ngeom", mjOBJ_GEOM, nullptr},         {"nsite", mjOBJ_SITE, nullptr},
    {"ncam", mjOBJ_CAMERA, nullptr},        {"nlight", mjOBJ_LIGHT, nullptr},
    {"nflex", mjOBJ_FLEX, nullptr},         {"nmesh", mjOBJ_MESH, nullptr},
    {"nskin", mjOBJ_SKIN, nullptr},         {"nhfield", mjOBJ_HFIELD, nullptr},
    {"ntex", mjOBJ_TEXTURE, nullptr},       {"nmat", mjOBJ_MATERIAL, nullptr},
    {"npair", mjOBJ_PAIR, nullptr},         {"nexclude", mjOBJ_EXCLUDE, nullptr},
    {"neq", mjOBJ_EQUALITY, nullptr},       {"ntendon", mjOBJ_TENDON, nullptr},
    {"nactuator", mjOBJ_ACTUATOR, nullptr}, {"nout", mjOBJ_ACTUATOR, output_range},
    {"nu", mjOBJ_ACTUATOR, ctrl_range},     {"na", mjOBJ_ACTUATOR, act_range},
    {"nsensor", mjOBJ_SENSOR, nullptr},     {"nsensordata", mjOBJ_SENSOR, sensor_range},
    {"nmocap", mjOBJ_BODY, mocap_range},    {"nkey", mjOBJ_KEY, nullptr},
    {"nnumeric", mjOBJ_NUMERIC, nullptr},   {"nnumericdata", mjOBJ_NUMERIC, numeric_range},
    {"ntext", mjOBJ_TEXT, nullptr},         {"ntuple", mjOBJ_TUPLE, nullptr},
    {"nplugin", mjOBJ_PLUGIN, nullptr},     {"npluginstate", mjOBJ_PLUGIN, plugin_state_range},
};

Result<Range> rows_of(const mjModel& m, const std::string& field, const char* row_kind,
                      const std::string& element) {
  for (const RowKind& kind : kRowKinds) {
    if (std::strcmp(kind.rows, row_kind) != 0) continue;
    const int id = mj_name2id(&m, kind.type, element.c_str());
    if (id < 0) {
      return Error{ErrorKind::kInput,
                   fmt::format("there is no {} '{}'", mju_type2Str(kind.type), element),
                   {},
                   suggest_name(element, object_names(&m, kind.type))};
    }
    const Range range = kind.range != nullptr ? kind.range(m, id) : Range{id, 1};
    return range.count > 0 ? range : Range{};
  }
  return Error{ErrorKind::kUsage,
               fmt::format("the rows of field '{}' have no names", field),
               {},
               "omit the element to get all rows"};
}

}  // namespace

std::vector<std::string> field_names() {
  std::vector<std::string> names;
  static const mjModel model{};
  static const mjData data{};
  for_each_field(&model, &data, [&](const char* name, const auto*, const char*, int64_t, int64_t) {
    names.emplace_back(name);
  });
  return names;
}

Result<std::vector<double>> read_field(const mjModel& model, const mjData& data,
                                       const std::string& field, const std::string& element) {
  bool found = false;
  Status status;
  std::vector<double> values;
  for_each_field(&model, &data,
                 [&](const char* name, const auto* first, const char* row_kind, int64_t rows,
                     int64_t columns) {
                   if (found || field != name) return;
                   found = true;
                   Range range{0, rows};
                   if (!element.empty()) {
                     const Result<Range> of_element = rows_of(model, field, row_kind, element);
                     if (of_element.ok()) {
                       range = *of_element;
                     } else {
                       status = of_element.error();
                     }
                   }
                   if (!status.ok() || first == nullptr)
                     return;  // of what is not made in this instant
                   first += range.first * columns;
                   for (int64_t i = 0; i < range.count * columns; ++i)
                     values.push_back(static_cast<double>(first[i]));
                 });
  if (!found) {
    return Error{ErrorKind::kInput,
                 fmt::format("MuJoCo has no field '{}'", field),
                 {},
                 suggest_name(field, field_names())};
  }
  if (!status.ok()) return status.error();
  return values;
}

}  // namespace gloam
