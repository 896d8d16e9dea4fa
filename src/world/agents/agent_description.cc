#include "world/agents/agent_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/hash.h"
#include "base/rng.h"
#include "scene/options/agent_fields.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr double kFastestWalk = 2.5;  // people change to a run at 2.0 to 2.2 m/s [m/s]

constexpr std::array<std::string_view, kPersonParts> kPersonPartNames = {
    "pelvis",       "chest",           "head",         "left_thigh", "left_shank",
    "left_foot",    "right_thigh",     "right_shank",  "right_foot", "left_upper_arm",
    "left_forearm", "right_upper_arm", "right_forearm"};
template <size_t N>
size_t row_of_word(const std::array<std::string_view, N>& words, const std::string& word) {
  return static_cast<size_t>(std::find(words.begin(), words.end(), word) - words.begin());
}

// Box-Muller; within two and a half deviations.
double normal(const RandomStream& stream, uint32_t index) {
  const double u = 1 - stream.uniform(0, 2 * index), v = stream.uniform(0, 2 * index + 1);
  return std::clamp(std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v), -2.5, 2.5);
}

// Free walking speed of adults: 1.34 m/s, deviation 0.26 (Buchmueller and Weidmann 2006).
double draw_speed(uint64_t seed) {
  return std::clamp(1.34 + 0.2 * normal({seed, stream_id("agent.speed")}, 0), 0.8, 1.9);
}

double usual_speed(AgentKind kind) {
  switch (kind) {
    case AgentKind::kCart:
      return 1.2;
    case AgentKind::kForklift:
      return 2.0;
    default:
      return 4.0;
  }
}

uint64_t own_seed(uint64_t seed, const std::string& name) {
  return hash_bytes(name.data(), name.size(), seed);
}

Status finish(const Scene& scene, std::optional<double> speed, AgentDescription* agent) {
  agent->seed = own_seed(agent->seed, agent->name);
  if (agent->kind == AgentKind::kPerson) {
    agent->radius = scene.navigation.radius;
    agent->height = std::max(scene.navigation.headroom, agent->person.height + 0.05);
    agent->speed = speed.value_or(draw_speed(agent->seed));
    if (agent->speed > kFastestWalk) {
      return Error{ErrorKind::kInput,
                   fmt::format("'{}' has a speed of {:g} m/s, but people walk at {:g} m/s at most",
                               agent->name, agent->speed, kFastestWalk),
                   agent->loc, "reduce 'speed', or omit it for a typical value"};
    }
    return {};
  }
  agent->vehicle = vehicle_size(agent->kind);
  agent->radius = static_cast<double>(agent->vehicle.width) / 2 + 0.1;
  agent->height = static_cast<double>(agent->vehicle.height) + 0.1;
  agent->speed = speed.value_or(usual_speed(agent->kind));
  return {};
}

}  // namespace

std::string_view part_name(AgentKind kind, int part) {
  const auto row = static_cast<size_t>(part);
  if (kind == AgentKind::kPerson) return kPersonPartNames[row];
  return part == kChassis ? "chassis" : part == kFork ? "fork" : kWheelNames[row - kWheelFL];
}

int part_count(AgentKind kind) {
  if (kind == AgentKind::kPerson) return kPersonParts;
  return kind == AgentKind::kForklift ? kVehicleParts : kVehicleParts - 1;
}

PersonShape draw_person(uint64_t seed, std::optional<double> height) {
  const RandomStream stream{seed, stream_id("agent.body")};
  PersonShape p;
  p.height = height.value_or(std::clamp(1.69 + 0.09 * normal(stream, 0), 1.45, 1.98));
  p.girth = std::clamp(1 + 0.1 * normal(stream, 1), 0.82, 1.3);
  const double legs = 1 + 0.012 * normal(stream, 2);
  const double h = p.height;
  p.ankle = 0.039 * h;
  p.shank = 0.246 * h * legs;
  p.thigh = 0.245 * h * legs;
  p.hip_height = p.ankle + p.shank + p.thigh;
  p.hip = 0.05 * h;
  p.foot = 0.152 * h;
  p.waist = 0.1 * h;
  p.trunk = 0.795 * h - p.hip_height - p.waist;
  p.shoulder = 0.106 * h * (0.94 + 0.06 * p.girth);
  p.upper_arm = 0.172 * h;
  p.forearm = 0.25 * h;
  p.neck = 0.058 * h;
  p.mass = 24 * h * h * p.girth;  // a body mass index of 24 kg/m²
  return p;
}

const VehicleSize& vehicle_size(AgentKind kind) {
  return kind == AgentKind::kCar        ? kCarSize
         : kind == AgentKind::kForklift ? kForkliftSize
                                        : kCartSize;
}

std::string AgentDescription::body_name(int part) const {
  return part == 0 ? name : fmt::format("{}/{}", name, part_name(kind, part));
}

Result<std::vector<AgentDescription>> list_agents(const Scene& scene) {
  std::vector<AgentDescription> agents;
  for (const AgentOptions& o : scene.agents) {
    AgentDescription agent;
    agent.name = o.name;
    agent.kind = static_cast<AgentKind>(row_of_word(kAgentKinds, o.kind));
    agent.behavior = static_cast<AgentBehavior>(row_of_word(kAgentBehaviors, o.behavior));
    agent.seed = o.seed;
    agent.is_placed = true;
    agent.position = o.position;
    agent.heading = o.heading * M_PI / 180;
    agent.route = o.route;
    agent.loop = o.loop;
    agent.tree = o.tree;
    agent.start = o.start;
    agent.yields = o.yields;
    agent.loc = o.loc;
    agent.person = draw_person(own_seed(o.seed, o.name), o.height);
    GLOAM_TRY_STATUS(finish(scene, o.speed, &agent));
    agents.push_back(std::move(agent));
  }
  for (const CrowdOptions& o : scene.crowds) {
    for (int i = 0; i < o.count; ++i) {
      AgentDescription agent;
      agent.name = fmt::format("{}{}", o.name, i);
      agent.seed = o.seed;
      agent.yields = o.yields;
      agent.loc = o.loc;
      agent.person = draw_person(own_seed(o.seed, agent.name), {});
      GLOAM_TRY_STATUS(finish(scene, o.speed, &agent));
      agents.push_back(std::move(agent));
    }
  }
  return agents;
}

Result<std::vector<AgentDescription>> describe_agents(const CompiledWorld& world) {
  GLOAM_TRY(std::vector<AgentDescription> agents, list_agents(world.scene));
  const mjModel* m = world.model.get();
  for (AgentDescription& agent : agents) {
    for (int part = 0; part < agent.parts(); ++part) {
      const int body = mj_name2id(m, mjOBJ_BODY, agent.body_name(part).c_str());
      GLOAM_CHECK(body > 0 && m->body_mocapid[body] >= 0,
                  "each part of an agent must have a mocap body");
      agent.body[static_cast<size_t>(part)] = body;
      agent.mocap[static_cast<size_t>(part)] = m->body_mocapid[body];
    }
  }
  return agents;
}

}  // namespace gloam
