#include "scene/validate/validate_agent.h"

#include <fmt/format.h>

#include <map>
#include <string>

namespace gloam {
namespace {

Error agent_error(const AgentOptions& agent, std::string what, std::string hint) {
  return {ErrorKind::kInput, fmt::format("agent '{}' {}", agent.name, what), agent.loc,
          std::move(hint)};
}

Status check_behavior(const AgentOptions& agent) {
  const size_t least = agent.behavior == "route" ? 1 : agent.behavior == "spline" ? 2 : 0;
  if (agent.route.size() < least) {
    return agent_error(agent,
                       fmt::format("follows a {} of {} points", agent.behavior, agent.route.size()),
                       fmt::format("list at least {} in 'route'", least));
  }
  if (agent.behavior == "tree" && agent.tree.empty())
    return agent_error(agent, "has no 'tree'", "set it to a BehaviorTree.CPP XML file");
  if (agent.behavior != "tree" && !agent.tree.empty())
    return agent_error(agent, fmt::format("has a 'tree', but the behavior '{}'", agent.behavior),
                       "set behavior = \"tree\", or remove 'tree'");
  if (agent.kind != "person" && agent.height)
    return agent_error(agent, fmt::format("is a {} and cannot have a 'height'", agent.kind),
                       "only people have a height");
  return {};
}

}  // namespace

Status validate_agents(const Scene& scene) {
  std::map<std::string, std::string> taken;  // name -> kind
  for (const RobotOptions& o : scene.robots) taken.emplace(o.name, "robot");
  for (const PropOptions& o : scene.props) taken.emplace(o.name, "prop");
  for (const ObjectOptions& o : scene.objects) taken.emplace(o.name, "object");
  const auto take = [&](const std::string& name, const char* kind, const SourceLoc& loc) -> Status {
    const auto [found, is_new] = taken.emplace(name, kind);
    if (is_new) return {};
    return Error{
        ErrorKind::kInput,
        fmt::format("{} '{}' has the same name as an existing {}", kind, name, found->second), loc,
        "rename one of them"};
  };
  for (const AgentOptions& agent : scene.agents) {
    GLOAM_TRY_STATUS(take(agent.name, "agent", agent.loc));
    GLOAM_TRY_STATUS(check_behavior(agent));
  }
  for (const CrowdOptions& crowd : scene.crowds)
    for (int i = 0; i < crowd.count; ++i)
      GLOAM_TRY_STATUS(take(fmt::format("{}{}", crowd.name, i), "crowd member", crowd.loc));
  return {};
}

}  // namespace gloam
