#include "sim/commands/live_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "base/check.h"
#include "base/hash.h"
#include "base/text.h"
#include "scene/files/mujoco_guard.h"

namespace gloam {
namespace {

struct FieldRow {
  const char* name;
  const char* array;         // in MuJoCo
  double smallest, largest;  // allowed values
  const char* unit;
};

constexpr double kAny = 1e10f;  // mjMAXVAL: beyond it MuJoCo calls a number bad

// By LiveFieldId.
constexpr FieldRow kFields[kLiveFieldCount] = {
    {"gravity", "opt.gravity", -kAny, kAny, "m/s^2"},
    {"wind", "opt.wind", -kAny, kAny, "m/s"},
    {"body_mass", "body_mass", 0, kAny, "kg"},
    {"geom_friction", "geom_friction", 0, kAny, "1, m, m"},
    {"height_field", "hfield_data", 0, 1, "1"},
    {"light_diffuse", "light_diffuse", 0, kAny, "1"},
    {"light_intensity", "light_intensity", 0, kAny, "cd"},
    {"light_active", "light_active", 0, 1, "1"},
    {"geom_color", "geom_rgba", 0, 1, "1"},
    {"material_color", "mat_rgba", 0, 1, "1"},
    {"material_emission", "mat_emission", 0, kAny, "1"},
    {"material_specular", "mat_specular", 0, 1, "1"},
    {"material_shininess", "mat_shininess", 0, 1, "1"},
    {"material_reflectance", "mat_reflectance", 0, 1, "1"},
    {"material_metallic", "mat_metallic", -1, 1, "1"},
    {"material_roughness", "mat_roughness", -1, 1, "1"},
    {"actuator_gain", "actuator_gainprm", -kAny, kAny, "the actuator's own"},
    {"actuator_bias", "actuator_biasprm", -kAny, kAny, "the actuator's own"},
    {"dof_armature", "dof_armature", 0, kAny, "kg, kg m^2"},
    {"dof_damping", "dof_damping", 0, kAny, "N s/m, N m s/rad"},
    {"dof_frictionloss", "dof_frictionloss", 0, kAny, "N, N m"},
    {"joint_stiffness", "jnt_stiffness", 0, kAny, "N/m, N m/rad"},
};

const FieldRow& row(LiveFieldId field) { return kFields[static_cast<int>(field)]; }

// Calls use(first value, number of values): where the field lies in a model.
template <class Model, class Use>
auto visit_field(Model& m, LiveFieldId field, Use&& use) {
  switch (field) {
    case LiveFieldId::kGravity:
      return use(m.opt.gravity, 3);
    case LiveFieldId::kWind:
      return use(m.opt.wind, 3);
    case LiveFieldId::kBodyMass:
      return use(m.body_mass, m.nbody);
    case LiveFieldId::kGeomFriction:
      return use(m.geom_friction, 3 * m.ngeom);
    case LiveFieldId::kHeightField:
      return use(m.hfield_data, m.nhfielddata);
    case LiveFieldId::kLightDiffuse:
      return use(m.light_diffuse, 3 * m.nlight);
    case LiveFieldId::kLightIntensity:
      return use(m.light_intensity, m.nlight);
    case LiveFieldId::kLightActive:
      return use(m.light_active, m.nlight);
    case LiveFieldId::kGeomColor:
      return use(m.geom_rgba, 4 * m.ngeom);
    case LiveFieldId::kMaterialColor:
      return use(m.mat_rgba, 4 * m.nmat);
    case LiveFieldId::kMaterialEmission:
      return use(m.mat_emission, m.nmat);
    case LiveFieldId::kMaterialSpecular:
      return use(m.mat_specular, m.nmat);
    case LiveFieldId::kMaterialShininess:
      return use(m.mat_shininess, m.nmat);
    case LiveFieldId::kMaterialReflectance:
      return use(m.mat_reflectance, m.nmat);
    case LiveFieldId::kMaterialMetallic:
      return use(m.mat_metallic, m.nmat);
    case LiveFieldId::kMaterialRoughness:
      return use(m.mat_roughness, m.nmat);
    case LiveFieldId::kActuatorGain:
      return use(m.actuator_gainprm, mjNGAIN * m.nactuator);
    case LiveFieldId::kActuatorBias:
      return use(m.actuator_biasprm, mjNBIAS * m.nactuator);
    case LiveFieldId::kDofArmature:
      return use(m.dof_armature, m.nv);
    case LiveFieldId::kDofDamping:
      return use(m.dof_damping, m.nv);
    case LiveFieldId::kDofFrictionLoss:
      return use(m.dof_frictionloss, m.nv);
    case LiveFieldId::kJointStiffness:
      return use(m.jnt_stiffness, m.njnt);
  }
  return use(static_cast<float*>(nullptr), 0);
}

// The inertia scales with the mass; massless bodies keep theirs.
void write_masses(const mjModel& world_model, std::span<const double> masses, mjModel& model) {
  std::ranges::copy(masses, model.body_mass);
  for (int body = 0; body < model.nbody; ++body) {
    const double before = world_model.body_mass[body];
    const double ratio = before > 0 ? model.body_mass[body] / before : 1;
    for (int axis = 0; axis < 3; ++axis) {
      model.body_inertia[3 * body + axis] = world_model.body_inertia[3 * body + axis] * ratio;
    }
  }
}

}  // namespace

const char* live_field_name(LiveFieldId field) { return row(field).name; }

const char* live_field_array(LiveFieldId field) { return row(field).array; }

Result<LiveFieldId> find_live_field(std::string_view name) {
  const auto* found = std::ranges::find(kFields, name, &FieldRow::name);
  if (found != std::end(kFields)) return static_cast<LiveFieldId>(found - kFields);
  std::vector<std::string> names;
  for (const FieldRow& field : kFields) names.emplace_back(field.name);
  return Error{ErrorKind::kInput,
               fmt::format("there is no live field '{}'", name.substr(0, 100)),
               {},
               suggest_name(name, names)};
}

LiveFieldRange live_field_range(LiveFieldId field) {
  return {row(field).smallest, row(field).largest, row(field).unit};
}

int live_field_size(const mjModel& model, LiveFieldId field) {
  return visit_field(model, field, [](const auto*, mjtSize n) { return static_cast<int>(n); });
}

bool derives_constants(LiveFieldId field) {
  return field == LiveFieldId::kBodyMass || field == LiveFieldId::kDofArmature;
}

std::vector<double> read_live_field(const mjModel& model, LiveFieldId field) {
  std::vector<double> values;
  live_field_at(model, nullptr, field, &values);
  return values;
}

template <class T>
void live_field_at(const mjModel& model, const LiveFields* live, LiveFieldId field,
                   std::vector<T>* values) {
  const auto assign = [values](const auto* from, mjtSize n) {
    values->resize(static_cast<size_t>(n));
    std::transform(from, from + n, values->begin(), [](auto v) { return static_cast<T>(v); });
  };
  if (live == nullptr || live->values[static_cast<size_t>(field)].empty())
    return visit_field(model, field, assign);
  const std::vector<double>& changed = live->values[static_cast<size_t>(field)];
  assign(changed.data(), static_cast<mjtSize>(changed.size()));
}
template void live_field_at(const mjModel&, const LiveFields*, LiveFieldId, std::vector<float>*);
template void live_field_at(const mjModel&, const LiveFields*, LiveFieldId, std::vector<double>*);

Status check_live_field(const mjModel& model, const SetLiveField& change) {
  if (static_cast<int>(change.field) < 0 || static_cast<int>(change.field) >= kLiveFieldCount) {
    return Error{ErrorKind::kUsage,
                 fmt::format("there is no live field number {}", static_cast<int>(change.field))};
  }
  const FieldRow& limits = row(change.field);
  const int size = live_field_size(model, change.field);
  const int64_t end = int64_t{change.first} + static_cast<int64_t>(change.values.size());
  if (change.first < 0 || end > size || change.values.empty()) {
    return Error{
        ErrorKind::kUsage,
        fmt::format("live field {} has {} values in this World; elements {} to {} are out of range",
                    limits.name, size, change.first, end - 1)};
  }
  for (size_t i = 0; i < change.values.size(); ++i) {
    const double value = change.values[i];
    if (change.field == LiveFieldId::kBodyMass && value <= 0 &&
        model.body_mass[static_cast<size_t>(change.first) + i] > 0) {
      return Error{ErrorKind::kUsage, fmt::format("a mass must be positive, got {} kg", value)};
    }
    if (!(value >= limits.smallest && value <= limits.largest)) {
      return Error{ErrorKind::kUsage,
                   fmt::format("{} is out of range for live field {} ({:g} … {:g})", value,
                               limits.name, limits.smallest, limits.largest)};
    }
  }
  return {};
}

std::shared_ptr<const LiveFields> change_live_field(const mjModel& world_model,
                                                    const LiveFields* current,
                                                    const SetLiveField& change, uint64_t serial) {
  auto next =
      current != nullptr ? std::make_shared<LiveFields>(*current) : std::make_shared<LiveFields>();
  next->values.resize(kLiveFieldCount);
  std::vector<double>& values = next->values[static_cast<size_t>(change.field)];
  if (values.empty()) values = read_live_field(world_model, change.field);
  std::copy(change.values.begin(), change.values.end(), values.begin() + change.first);
  ++next->version;
  next->serial = serial;
  if (change.field == LiveFieldId::kHeightField) next->height_field_serial = serial;
  return next;
}

uint64_t live_fields_digest(const LiveFields& live) {
  uint64_t hash = hash_bytes(&live.version, sizeof(live.version));
  for (size_t field = 0; field < live.values.size(); ++field) {
    if (live.values[field].empty()) continue;
    hash = hash_bytes(&field, sizeof(field), hash);
    hash = hash_span<double>(live.values[field], hash);
  }
  return hash;
}

void own_live_field(LiveFieldId field, mjModel& model, std::vector<std::byte>* storage) {
  GLOAM_CHECK(!derives_constants(field), "masses and armatures require a private model");
  visit_field(model, field, [&](auto&& array, mjtSize n) {
    using Array = std::remove_reference_t<decltype(array)>;
    if constexpr (std::is_pointer_v<Array>) {  // the options are the model's own anyway
      storage->resize(static_cast<size_t>(n) * sizeof(*array));
      if (n > 0) std::memcpy(storage->data(), array, storage->size());
      array = reinterpret_cast<Array>(storage->data());
    }
  });
}

Status write_live_field(const mjModel& world_model, LiveFieldId field,
                        std::span<const double> values, mjModel& model, mjData* scratch) {
  GLOAM_CHECK(static_cast<int>(values.size()) == live_field_size(model, field),
              "a live field must be written as a whole");
  if (field == LiveFieldId::kBodyMass) {
    write_masses(world_model, values, model);
  } else {
    visit_field(model, field, [&]<class T>(T* target, mjtSize) {
      std::ranges::transform(values, target, [](double v) { return static_cast<T>(v); });
    });
  }
  if (!derives_constants(field)) return {};
  return guarded([&] { mj_setConst(&model, scratch); });
}

}  // namespace gloam
