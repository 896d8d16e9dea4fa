#include "places/generators.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "base/srgb.h"

namespace gloam {
namespace {

PropRequest request_of(const PropOptions& options) {
  PropRequest request{options.kind, options.seed, options.size, options.color};
  if (request.color) {
    Vec3& c = *request.color;
    c = {srgb_encode(c.x), srgb_encode(c.y), srgb_encode(c.z)};
  }
  return request;
}

// Calls f(options, generator) for each: one line for a new one.
template <class F>
void visit_generators(const EnvironmentOptions& e, F&& f) {
  f(e.house, make_house);
  f(e.warehouse, make_warehouse);
  f(e.office, make_office);
  f(e.hallway, make_hallway);
  f(e.bedroom, make_bedroom);
  f(e.tunnel, make_tunnel);
  f(e.mine, make_mine);
  f(e.terrain, make_terrain);
}

int count_generators(const EnvironmentOptions& e) {
  int count = 0;
  visit_generators(e, [&](const auto& options, auto) { count += options.has_value(); });
  return count;
}

Error located(Error error, const SourceLoc& loc) {
  if (error.loc.file.empty()) error.loc = loc;
  return error;
}

}  // namespace

bool is_vehicle(const AgentOptions& agent) { return agent.kind != "person"; }

bool has_generator(const EnvironmentOptions& e) { return count_generators(e) > 0; }

bool has_rooms(const EnvironmentOptions& e) { return has_generator(e) && !e.terrain; }

Status validate_environment(const Scene& scene) {
  const EnvironmentOptions& e = scene.environment;
  if (!e.file.empty() + count_generators(e) > 1)
    return Error{ErrorKind::kInput, "[environment] must have either a file or one generator", e.loc,
                 "keep only one, and add objects with [[prop]]"};
  for (const PropOptions& prop : scene.props)
    if (const Status status = check_request(request_of(prop)); !status.ok())
      return located(status.error(), prop.loc);
  return {};
}

Result<std::optional<Place>> make_place(const Scene& scene) {
  if (!has_generator(scene.environment) && scene.props.empty() &&
      std::none_of(scene.agents.begin(), scene.agents.end(), is_vehicle))
    return std::optional<Place>();
  Place place("props");
  Status status;
  visit_generators(scene.environment, [&](const auto& options, auto generate) {
    if (!options) return;
    Result<Place> made = generate(*options);
    if (made.ok())
      place = std::move(made).value();
    else
      status = located(made.error(), options->loc);
  });
  GLOAM_TRY_STATUS(std::move(status));
  place.openable = true;
  for (const PropOptions& prop : scene.props) {
    const Result<int> made = place.make(request_of(prop));
    if (!made.ok()) return located(made.error(), prop.loc);
    place.put_named({*made,
                     prop.name,
                     {prop.position, prop.orientation.value_or(Quat{})},
                     prop.loose.value_or(place.prop(*made).loose),
                     false,
                     prop.loc});
  }
  for (const AgentOptions& agent : scene.agents) {
    if (!is_vehicle(agent)) continue;
    PropRequest request{agent.kind, hash_bytes(agent.name.data(), agent.name.size(), agent.seed)};
    const Result<int> made = place.make(request);
    if (!made.ok()) return located(made.error(), agent.loc);
    place.put_named({*made, agent.name, {agent.position, {}}, false, true, agent.loc});
  }
  return std::optional<Place>(std::move(place));
}

}  // namespace gloam
