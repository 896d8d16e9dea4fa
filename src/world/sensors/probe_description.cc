#include "world/sensors/probe_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/text.h"
#include "scene/options/probe_quantities.h"
#include "world/compile/level.h"
#include "world/model_names.h"
#include "world/sensors/visual_camera.h"
#include "world/world.h"

namespace gloam {
namespace {

Error probe_error(const ProbeOptions& probe, const std::string& what, std::string hint) {
  return {ErrorKind::kInput, fmt::format("probe '{}': {}", probe.name, what), probe.loc,
          std::move(hint)};
}

Result<std::vector<int>> bodies_of(const CompiledWorld& world, const ProbeOptions& probe) {
  if (!probe.agent.empty()) {
    std::vector<std::string> names;
    for (const AgentDescription& agent : world.agents) {
      if (agent.name == probe.agent) {
        std::vector<int> bodies(agent.body.begin(), agent.body.begin() + agent.parts());
        std::ranges::sort(bodies);
        return bodies;
      }
      names.push_back(agent.name);
    }
    return probe_error(
        probe, fmt::format("there is no agent '{}'", probe.agent),
        names.empty() ? "the scene has no agents" : suggest_name(probe.agent, names));
  }
  const auto names = object_names(world.model.get(), mjOBJ_BODY);
  std::vector<int> bodies;
  for (size_t body = 1; body < names.size(); ++body)
    if (names[body] == probe.body || fits_pattern(probe.body, names[body]))
      bodies.push_back(static_cast<int>(body));
  if (bodies.empty())
    return probe_error(probe, fmt::format("there is no body '{}'", probe.body),
                       suggest_name(probe.body, names));
  return bodies;
}

Status check_camera(const CompiledWorld& world, const ProbeOptions& probe) {
  std::vector<std::string> names;
  for (int i = 0; i < static_cast<int>(world.model->ncam); ++i)
    names.push_back(camera_name(*world.model, i));
  if (std::ranges::find(names, probe.camera) != names.end()) return {};
  return probe_error(
      probe, fmt::format("there is no camera '{}'", probe.camera),
      names.empty() ? "the scene has no cameras" : suggest_name(probe.camera, names));
}

/// A table of a scene whose boxes hold a quantity.
struct Holder {
  const char* table;  ///< "[[gas]]"
  bool any, holds;    ///< whether there are any, and whether one holds the place
};

Status check_holder(const ProbeDescription& probe, const Holder& holder) {
  const std::string_view word = probe.quantity->word;
  if (!holder.any)
    return probe_error(probe.options,
                       fmt::format("the scene has no {} for '{}'", holder.table, word),
                       fmt::format("add a {}", holder.table));
  if (!probe.is_fixed() || holder.holds) return {};
  return probe_error(
      probe.options,
      fmt::format("no {} is at [{}, {}, {}]", holder.table, probe.p_B.x, probe.p_B.y, probe.p_B.z),
      fmt::format("move it into the {} whose '{}' it should measure", holder.table, word));
}

/// True if a level rectangle around (x, y) holds the place.
template <class Area>
bool is_over(const Area& area, const Vec3& p) {
  return std::abs(p.x - area.x) <= area.size_x / 2 && std::abs(p.y - area.y) <= area.size_y / 2;
}

Status check_scene_has(const CompiledWorld& world, const ProbeDescription& probe) {
  const std::string_view word = probe.quantity->word;
  const Vec3& p = probe.p_B;
  if (word.starts_with("gas_"))
    return check_holder(
        probe,
        {"[[gas]]", !world.gases.gases.empty(),
         std::ranges::any_of(world.gases.gases, [&](const auto& gas) { return gas.holds(p); })});
  if (word == "water_height")
    return check_holder(
        probe,
        {"[[water]]", !world.waters.empty(),
         std::ranges::any_of(world.waters, [&](const auto& water) { return is_over(water, p); })});
  if (word == "sinkage" || word == "soil_work")
    return check_holder(
        probe,
        {"[[soil]]", !world.soils.empty(),
         std::ranges::any_of(world.soils, [&](const auto& soil) { return is_over(soil, p); })});
  const auto& sky = world.scene.sky;
  if (word == "sun_disc" && !(sky && (sky->sun_elevation || sky->date)))
    return probe_error(probe.options, "the scene's sky has no sun",
                       "set 'sun_elevation' of [sky], or a date, time and place");
  return {};
}

Result<ProbeDescription> describe_probe(const CompiledWorld& world, const ProbeOptions& options) {
  ProbeDescription probe{options, find_probe_quantity(options.quantity)};
  if (mj_name2id(world.model.get(), mjOBJ_SENSOR, options.name.c_str()) >= 0)
    return probe_error(options, "a sensor of the model has the same name", "rename it");
  if (probe.quantity->place == ProbePlace::kCamera) {
    GLOAM_TRY_STATUS(check_camera(world, options));
  } else if (probe.quantity->place == ProbePlace::kBodies ||
             (probe.quantity->place == ProbePlace::kBodiesOrPoint && !options.position)) {
    GLOAM_TRY(probe.bodies, bodies_of(world, options));
    for (int geom = 0; geom < static_cast<int>(world.model->ngeom); ++geom)
      if (std::ranges::binary_search(probe.bodies, world.model->geom_bodyid[geom]))
        probe.geoms.push_back(geom);
  } else if (!options.body.empty()) {
    GLOAM_TRY(const std::vector<int> bodies, bodies_of(world, options));
    if (bodies.size() > 1)
      return probe_error(options,
                         fmt::format("'{}' matches {} bodies", options.body, bodies.size()),
                         "specify the body in whose frame the position is given");
    probe.body = bodies[0];
  }
  if (options.position) probe.p_B = *options.position;
  if (const auto& n = options.normal) {
    const double length = std::sqrt(n->x * n->x + n->y * n->y + n->z * n->z);
    probe.n_B = {n->x / length, n->y / length, n->z / length};
  }
  GLOAM_TRY_STATUS(check_scene_has(world, probe));
  return probe;
}

}  // namespace

Result<std::vector<ProbeDescription>> describe_probes(const CompiledWorld& world) {
  std::vector<ProbeDescription> probes;
  for (const ProbeOptions& options : world.scene.probes) {
    GLOAM_TRY(ProbeDescription probe, describe_probe(world, options));
    probes.push_back(std::move(probe));
  }
  return probes;
}

bool has_probe(const CompiledWorld& world, std::string_view quantity) {
  return std::ranges::any_of(
      world.probes, [quantity](const auto& probe) { return probe.quantity->word == quantity; });
}

}  // namespace gloam
