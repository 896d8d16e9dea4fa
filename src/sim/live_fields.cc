#include "sim/live_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/hash.h"
#include "scene/mujoco_guard.h"

namespace gloam {
namespace {

struct FieldRow {
  const char* name;
  float smallest, largest;  // allowed values
};

constexpr float kAny = 1e10f;  // mjMAXVAL: beyond it MuJoCo calls a number bad

// By LiveFieldId.
constexpr FieldRow kFields[kLiveFieldCount] = {
    {"gravity", -kAny, kAny},       {"wind", -kAny, kAny},  {"body_mass", 0, kAny},
    {"geom_friction", 0, kAny},     {"height_field", 0, 1}, {"light_diffuse", 0, kAny},
    {"light_intensity", 0, kAny},   {"light_active", 0, 1}, {"material_color", 0, 1},
    {"material_emission", 0, kAny},
};

const FieldRow& row(LiveFieldId field) { return kFields[static_cast<int>(field)]; }

template <class T>
std::vector<float> to_floats(const T* values, mjtSize n) {
  return std::vector<float>(values, values + n);
}

// Values that are the World's own keep its full precision.
template <class T>
void from_floats(std::span<const float> values, const T* world, T* target) {
  for (size_t i = 0; i < values.size(); ++i) {
    target[i] = values[i] == static_cast<float>(world[i]) ? world[i] : static_cast<T>(values[i]);
  }
}

// The inertia scales with the mass; massless bodies keep theirs.
void write_masses(const mjModel& world_model, std::span<const float> masses, mjModel& model) {
  from_floats(masses, world_model.body_mass, model.body_mass);
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

int live_field_size(const mjModel& model, LiveFieldId field) {
  switch (field) {
    case LiveFieldId::kGravity:
    case LiveFieldId::kWind:
      return 3;
    case LiveFieldId::kBodyMass:
      return static_cast<int>(model.nbody);
    case LiveFieldId::kGeomFriction:
      return static_cast<int>(3 * model.ngeom);
    case LiveFieldId::kHeightField:
      return static_cast<int>(model.nhfielddata);
    case LiveFieldId::kLightDiffuse:
      return static_cast<int>(3 * model.nlight);
    case LiveFieldId::kLightIntensity:
    case LiveFieldId::kLightActive:
      return static_cast<int>(model.nlight);
    case LiveFieldId::kMaterialColor:
      return static_cast<int>(4 * model.nmat);
    case LiveFieldId::kMaterialEmission:
      return static_cast<int>(model.nmat);
  }
  return 0;
}

std::vector<float> read_live_field(const mjModel& model, LiveFieldId field) {
  const int n = live_field_size(model, field);
  switch (field) {
    case LiveFieldId::kGravity:
      return to_floats(model.opt.gravity, n);
    case LiveFieldId::kWind:
      return to_floats(model.opt.wind, n);
    case LiveFieldId::kBodyMass:
      return to_floats(model.body_mass, n);
    case LiveFieldId::kGeomFriction:
      return to_floats(model.geom_friction, n);
    case LiveFieldId::kHeightField:
      return to_floats(model.hfield_data, n);
    case LiveFieldId::kLightDiffuse:
      return to_floats(model.light_diffuse, n);
    case LiveFieldId::kLightIntensity:
      return to_floats(model.light_intensity, n);
    case LiveFieldId::kLightActive:
      return to_floats(model.light_active, n);
    case LiveFieldId::kMaterialColor:
      return to_floats(model.mat_rgba, n);
    case LiveFieldId::kMaterialEmission:
      return to_floats(model.mat_emission, n);
  }
  return {};
}

std::vector<float> live_field_at(const mjModel& model, const LiveFields* live, LiveFieldId field) {
  if (live != nullptr && !live->values[static_cast<size_t>(field)].empty()) {
    return live->values[static_cast<size_t>(field)];
  }
  return read_live_field(model, field);
}

Status check_live_field(const mjModel& model, const SetLiveField& change) {
  if (static_cast<int>(change.field) < 0 || static_cast<int>(change.field) >= kLiveFieldCount) {
    return Error{ErrorKind::kUsage,
                 fmt::format("there is no live field number {}", static_cast<int>(change.field))};
  }
  const FieldRow& limits = row(change.field);
  const int size = live_field_size(model, change.field);
  const int64_t end = int64_t{change.first} + static_cast<int64_t>(change.values.size());
  if (change.first < 0 || end > size || change.values.empty()) {
    return Error{ErrorKind::kUsage,
                 fmt::format("live field {} has {} values in this world; elements {} to {} are not "
                             "a part of it",
                             limits.name, size, change.first, end - 1)};
  }
  for (size_t i = 0; i < change.values.size(); ++i) {
    const float value = change.values[i];
    if (change.field == LiveFieldId::kBodyMass && value <= 0 &&
        model.body_mass[static_cast<size_t>(change.first) + i] > 0) {
      return Error{ErrorKind::kUsage, fmt::format("a mass of {} kg is not positive", value)};
    }
    if (!(value >= limits.smallest && value <= limits.largest)) {
      return Error{ErrorKind::kUsage,
                   fmt::format("{} is not a value of live field {} ({:g} … {:g})", value,
                               limits.name, limits.smallest, limits.largest)};
    }
  }
  return {};
}

std::shared_ptr<const LiveFields> change_live_field(const mjModel& world_model,
                                                    const LiveFields* current,
                                                    const SetLiveField& change) {
  auto next =
      current != nullptr ? std::make_shared<LiveFields>(*current) : std::make_shared<LiveFields>();
  next->values.resize(kLiveFieldCount);
  std::vector<float>& values = next->values[static_cast<size_t>(change.field)];
  if (values.empty()) values = read_live_field(world_model, change.field);
  std::copy(change.values.begin(), change.values.end(), values.begin() + change.first);
  ++next->version;
  if (change.field == LiveFieldId::kHeightField) ++next->height_field_version;
  return next;
}

uint64_t live_fields_digest(const LiveFields& live) {
  uint64_t hash = hash_bytes(&live.version, sizeof(live.version));
  for (size_t field = 0; field < live.values.size(); ++field) {
    if (live.values[field].empty()) continue;
    hash = hash_bytes(&field, sizeof(field), hash);
    hash = hash_span<float>(live.values[field], hash);
  }
  return hash;
}

Status write_live_field(const mjModel& world_model, LiveFieldId field,
                        std::span<const float> values, mjModel& model, mjData* scratch) {
  GLOAM_CHECK(static_cast<int>(values.size()) == live_field_size(model, field),
              "a live field is written whole");
  switch (field) {
    case LiveFieldId::kGravity:
      from_floats(values, world_model.opt.gravity, model.opt.gravity);
      break;
    case LiveFieldId::kWind:
      from_floats(values, world_model.opt.wind, model.opt.wind);
      break;
    case LiveFieldId::kBodyMass:
      write_masses(world_model, values, model);
      return guarded([&] { mj_setConst(&model, scratch); });
    case LiveFieldId::kGeomFriction:
      from_floats(values, world_model.geom_friction, model.geom_friction);
      break;
    case LiveFieldId::kHeightField:
      from_floats(values, world_model.hfield_data, model.hfield_data);
      break;
    case LiveFieldId::kLightDiffuse:
      from_floats(values, world_model.light_diffuse, model.light_diffuse);
      break;
    case LiveFieldId::kLightIntensity:
      from_floats(values, world_model.light_intensity, model.light_intensity);
      break;
    case LiveFieldId::kLightActive:
      std::transform(values.begin(), values.end(), model.light_active,
                     [](float v) { return static_cast<mjtBool>(v != 0); });
      break;
    case LiveFieldId::kMaterialColor:
      from_floats(values, world_model.mat_rgba, model.mat_rgba);
      break;
    case LiveFieldId::kMaterialEmission:
      from_floats(values, world_model.mat_emission, model.mat_emission);
      break;
  }
  return {};
}

}  // namespace gloam
