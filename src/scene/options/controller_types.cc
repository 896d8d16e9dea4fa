#include "scene/options/controller_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <mutex>

namespace gloam {
namespace {

using Keys = std::vector<std::string_view>;

struct ControllerType {
  std::string name;
  Keys options;
};

struct ControllerTypes {
  std::mutex mutex;
  // Gloam's own; their factories are in control/controllers.cc.
  std::deque<ControllerType> rows = {
      {"none", {}},
      {"torque", {"target"}},
      {"joint_position", {"kp", "kd", "target"}},
      {"trot", {"goals"}},
      {"quadrotor", {"goals", "flight"}},
      {"diff_drive", {"goals", "drive"}},
      {"gripper", {"grip"}},
      {"joint_velocity", {"kp", "kd"}},
      {"joint_effort", {"kp", "kd"}},
      {"ik",
       {"frame", "position_cost", "orientation_cost", "posture_cost", "time_constant",
        "velocity_limit", "collision_distance", "kp", "kd"}},
      {"osc",
       {"frame", "position_stiffness", "orientation_stiffness", "posture_stiffness",
        "damping_ratio"}},
      {"policy", {"goals", "network", "settings", "params"}},
  };
};

ControllerTypes& controller_types_table() {
  static ControllerTypes instance;
  return instance;
}

bool is_identifier(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

}  // namespace

std::vector<std::string_view> controller_type_names() {
  ControllerTypes& types = controller_types_table();
  const std::lock_guard lock(types.mutex);
  std::vector<std::string_view> names;
  for (const ControllerType& row : types.rows) names.emplace_back(row.name);
  return names;
}

bool has_controller_option(std::string_view type, std::string_view key) {
  ControllerTypes& types = controller_types_table();
  const std::lock_guard lock(types.mutex);
  const auto row = std::ranges::find(types.rows, type, &ControllerType::name);
  return row == types.rows.end() || std::ranges::find(row->options, key) != row->options.end();
}

Status add_controller_type(const std::string& name) {
  if (!is_identifier(name))
    return Error{ErrorKind::kUsage, fmt::format("'{:.80}' is not a valid controller name", name)};
  ControllerTypes& types = controller_types_table();
  const std::lock_guard lock(types.mutex);
  if (std::ranges::find(types.rows, name, &ControllerType::name) != types.rows.end())
    return Error{ErrorKind::kUsage, fmt::format("there is already a controller '{}'", name)};
  types.rows.push_back({name, {"goals", "params"}});
  return {};
}

}  // namespace gloam
