#include "runtime/log/void_options.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>

#include "gloam/options.h"

namespace gloam {
namespace {

struct VoidOption {
  std::string_view table;
  std::string_view name;  ///< "" = all of the table
  std::string_view hint;
};
constexpr std::string_view kRestep =
    "--restep starts a new run of the changed scene, with its own physics";
constexpr VoidOption kVoidOptions[] = {
    {"sim", "duration", "--duration replays a part of the run"},
    {"sim", "seed", "--seed seeds the [[randomize]] tables of overlays; --restep starts a new run"},
    {"sim", "timestep", kRestep},
    {"robot", "controller", kRestep},
    {"robot", "keyframe", kRestep},
    {"push", "", kRestep},
    {"navigation", "", kRestep},
    {"agent", "position", kRestep},
    {"agent", "heading", kRestep},
    {"agent", "speed", kRestep},
    {"agent", "behavior", kRestep},
    {"agent", "route", kRestep},
    {"agent", "loop", kRestep},
    {"agent", "tree", kRestep},
    {"agent", "start", kRestep},
    {"agent", "yields", kRestep},
    {"crowd", "speed", kRestep},
    {"crowd", "yields", kRestep},
    {"adversity", "people_speed", kRestep},
    {"bridge", "", "use --ros2, --zmq or --foxglove for a live replay"},
};

/// "controller" of "robot.go1.controller.kp", "seed" of "sim.seed".
std::string_view option_of(std::string_view path, std::string_view table) {
  const bool is_list = table == "robot" || table == "agent" || table == "crowd";
  for (int parts = is_list ? 2 : 1; parts > 0; --parts) {
    const size_t dot = path.find('.');
    if (dot == std::string_view::npos) return {};
    path.remove_prefix(dot + 1);
  }
  return path.substr(0, path.find('.'));
}

const VoidOption* find_void(std::string_view path) {
  const std::string_view table = path.substr(0, path.find('.'));
  for (const VoidOption& option : kVoidOptions)
    if (option.table == table && (option.name.empty() || option.name == option_of(path, table)))
      return &option;
  return nullptr;
}

bool is_of_agents(std::string_view table) {
  return table == "agent" || table == "crowd" || table == "adversity" || table == "navigation";
}

bool has_agents(const Scene& scene) {
  return !scene.agents.empty() || !scene.crowds.empty() || scene.adversity;
}

std::map<std::string, std::string> values_of(const Scene& scene, bool with_agents) {
  std::map<std::string, std::string> values;
  for (OptionInfo& option : list_options(scene)) {
    const VoidOption* found = find_void(option.path);
    if (found != nullptr && (with_agents || !is_of_agents(found->table)))
      values[option.path] = std::move(option.value);
  }
  return values;
}

}  // namespace

Status check_options_act(const Scene& logged, const Scene& changed) {
  // Agents of a run without any are new, and walk by themselves.
  const bool with_agents = has_agents(logged) || !has_agents(changed);
  std::map<std::string, std::string> before = values_of(logged, with_agents);
  std::string other;
  for (const auto& [path, value] : values_of(changed, with_agents)) {
    const auto same = before.extract(path);
    if (same.empty() ? !value.empty() : same.mapped() != value) {
      other = path;
      break;
    }
  }
  if (other.empty() && !before.empty()) other = before.begin()->first;  // an overlay took it away
  if (other.empty()) return {};
  return Error{ErrorKind::kUsage,
               fmt::format("'{}' has no effect in a replay: bodies move as logged", other),
               {},
               std::string(find_void(other)->hint)};
}

}  // namespace gloam
