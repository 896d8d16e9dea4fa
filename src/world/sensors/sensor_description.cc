#include "world/sensors/sensor_description.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "scene/options/probe_quantities.h"
#include "world/world.h"

namespace gloam {
namespace {

std::string sensor_name(const mjModel& m, int i) {
  const char* name = mj_id2name(&m, mjOBJ_SENSOR, i);
  return name != nullptr && *name != 0 ? name : fmt::format("sensor_{}", i);
}

SensorKind kind_of(int type) {
  switch (type) {
    case mjSENS_BALLQUAT:
    case mjSENS_FRAMEQUAT:
      return SensorKind::kRotation;
    case mjSENS_FRAMEXAXIS:
    case mjSENS_FRAMEYAXIS:
    case mjSENS_FRAMEZAXIS:
    case mjSENS_GEOMNORMAL:
      return SensorKind::kDirection;
    case mjSENS_RANGEFINDER:
      return SensorKind::kDistance;
    default:
      return SensorKind::kNumbers;
  }
}

const SensorOptions* options_of(const Scene& scene, const std::string& sensor) {
  const SensorOptions* found = nullptr;
  for (const SensorOptions& options : scene.sensors)
    if (fits_pattern(options.match, sensor)) found = &options;
  return found;
}

}  // namespace

std::vector<SensorDescription> describe_sensors(const CompiledWorld& world) {
  const mjModel& m = *world.model;
  std::vector<SensorDescription> sensors;
  for (int i = 0; i < static_cast<int>(m.nsensor); ++i) {
    SensorDescription sensor{sensor_name(m, i), m.sensor_adr[i], m.sensor_dim[i],
                             kind_of(m.sensor_type[i])};
    sensor.options = options_of(world.scene, sensor.name);
    if (sensor.options != nullptr) {
      sensor.rate = sensor.options->rate;
      sensor.loc = sensor.options->loc;
    }
    sensors.push_back(std::move(sensor));
  }
  for (size_t i = 0; i < world.probes.size(); ++i) {
    const ProbeDescription& probe = world.probes[i];
    sensors.push_back({.name = probe.options.name,
                       .count = probe.quantity->count(),
                       .options = options_of(world.scene, probe.options.name),
                       .probe = static_cast<int>(i),
                       .rate = probe.options.rate,
                       .loc = probe.options.loc});
  }
  return sensors;
}

Status check_sensors(const CompiledWorld& world) {
  std::vector<std::string> names;
  for (int i = 0; i < static_cast<int>(world.model->nsensor); ++i)
    names.push_back(sensor_name(*world.model, i));
  for (const ProbeOptions& probe : world.scene.probes) names.push_back(probe.name);
  for (const SensorOptions& options : world.scene.sensors) {
    if (std::any_of(names.begin(), names.end(),
                    [&](const std::string& name) { return fits_pattern(options.match, name); }))
      continue;
    return Error{ErrorKind::kInput, fmt::format("there is no sensor '{}'", options.match),
                 options.loc,
                 names.empty() ? "the scene has no sensors" : suggest_name(options.match, names)};
  }
  return {};
}

}  // namespace gloam
