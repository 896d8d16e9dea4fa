// Facts about a run that its recorder writes at the start.

#include <fmt/format.h>

#include "base/files.h"
#include "base/hash.h"
#include "gloam/program.h"
#include "metrics/builtin/robot_metric.h"
#include "runtime/recording/changed_settings.h"
#include "runtime/recording/run_plan.h"
#include "runtime/rendering/label_table.h"
#include "scene/options/probe_quantities.h"
#include "world/sensors/sensor_description.h"
#include "world/version.h"

namespace gloam {
namespace {

// Columns of a sensor's file. The values of MuJoCo's sensors have no names.
std::vector<std::string> columns_of(const SensorDescription& sensor, const CompiledWorld& world) {
  std::vector<std::string> columns;
  for (int i = 0; i < sensor.count; ++i) {
    if (sensor.probe < 0) {
      columns.push_back(fmt::format("value_{}", i));
      continue;
    }
    const ProbeDescription& probe = world.probes[static_cast<size_t>(sensor.probe)];
    const ProbeNumber& number = probe.quantity->numbers[static_cast<size_t>(i)];
    columns.push_back(with_unit(std::string(number.name), number.unit));
  }
  return columns;
}

std::string hash_of_file(const std::filesystem::path& path) {
  if (path.empty()) return {};
  const auto text = read_file(path);
  return text.ok() ? hash_to_hex(hash_bytes(text->data(), text->size())) : std::string();
}

std::vector<NamedText> settings_of(const RunPlan& plan, const RenderDescription* description) {
  const Scene& scene = plan.scene();
  const RenderOptions& render = scene.render;
  const bool has_media = description != nullptr ? !description->volumes.empty()
                                                : !scene.volumes.empty() || !scene.gases.empty();
  std::vector<NamedText> settings = {
      {"tier", to_string(render.tier_or_default(plan.request.simulation.pace == Pace::kRealTime))},
      {"spp", std::to_string(render.samples())},
      {"max_depth", std::to_string(path_depth(render, has_media))},
      {"denoise", render.denoise ? "true" : "false"}};
  if (render.error) settings.push_back({"error", fmt::format("{}", *render.error)});
  for (NamedText& setting : changed_settings(*plan.world.compiled()))
    settings.push_back(std::move(setting));
  return settings;
}

}  // namespace

RunInfo run_info(const RunPlan& plan, const RenderDescription* description, Rational step_rate) {
  const CompiledWorld& world = *plan.world.compiled();
  const Scene& scene = world.scene;
  const auto& file = scene.bare_model.empty() ? scene.file : scene.bare_model;
  RunInfo info;
  info.title = scene.name;
  info.versions = {
      {"gloam", version()}, {"mujoco", mujoco_version()}, {"configuration", configuration()}};
  info.scene_file = file.filename().string();
  info.scene_hash = hash_of_file(file);
  info.seed = plan.request.simulation.seed;
  info.timestep = 1 / step_rate.value();
  info.duration = plan.duration;
  info.settings = settings_of(plan, description);
  for (const DrawnOption& d : world.drawn) info.drawn.push_back({d.option, d.value});
  if (plan.log.file == plan.request.out / kRunLogName) info.beside = {kRunLogName};
  if (description != nullptr) {
    LabelTableRows labels = label_rows(*description);
    info.labels = std::move(labels.rows);
    info.label_ids = std::move(labels.ids);
  }
  if (plan.records_sensors)
    for (const SensorDescription& sensor : describe_sensors(world))
      info.sensors.push_back({sensor.name, columns_of(sensor, world)});
  return info;
}

}  // namespace gloam
