#include "scene/options/controller_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <mutex>

namespace gloam {
namespace {

struct TypeNames {
  std::mutex mutex;
  std::deque<std::string> names = {"none", "torque", "joint_position", "trot"};
};

TypeNames& type_names() {
  static TypeNames instance;
  return instance;
}

bool is_identifier(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

}  // namespace

std::vector<std::string_view> controller_type_names() {
  TypeNames& types = type_names();
  const std::lock_guard lock(types.mutex);
  return {types.names.begin(), types.names.end()};
}

Status add_controller_type(const std::string& name) {
  if (!is_identifier(name))
    return Error{ErrorKind::kUsage, fmt::format("'{:.80}' is no name of a controller", name)};
  TypeNames& types = type_names();
  const std::lock_guard lock(types.mutex);
  if (std::find(types.names.begin(), types.names.end(), name) != types.names.end())
    return Error{ErrorKind::kUsage, fmt::format("there is a controller '{}' already", name)};
  types.names.push_back(name);
  return {};
}

}  // namespace gloam
