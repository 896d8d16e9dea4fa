#include "world/visual_label.h"

namespace gloam {
namespace {

constexpr int kRobotKind = -1, kBodyKind = -2;

template <class Key>
uint32_t id_of(std::map<Key, uint32_t>* ids, const Key& key) {
  return ids->try_emplace(key, static_cast<uint32_t>(ids->size() + 1)).first->second;
}

}  // namespace

std::string semantic_class(std::string_view name) {
  if (const size_t slash = name.rfind('/'); slash != std::string_view::npos)
    name.remove_prefix(slash + 1);
  const size_t last = name.find_last_not_of("0123456789_.- ");
  return last == std::string_view::npos ? "object" : std::string(name.substr(0, last + 1));
}

int LabelTable::robot_of(int body) const {
  const mjModel& model = *world_.model;
  for (int ancestor = body; ancestor > 0; ancestor = model.body_parentid[ancestor])
    for (size_t i = 0; i < world_.robots.size(); ++i)
      if (world_.robots[i].root_body == ancestor) return static_cast<int>(i);
  // A robot's file may hold several bodies side by side.
  const char* name = mj_id2name(&model, mjOBJ_BODY, model.body_rootid[body]);
  for (size_t i = 0; name != nullptr && i < world_.robots.size(); ++i) {
    const std::string& prefix = world_.robots[i].prefix;
    if (!prefix.empty() && std::string_view(name).starts_with(prefix)) return static_cast<int>(i);
  }
  return -1;
}

LabelRow LabelTable::label(int body, const std::string& own_name, int kind, int id) {
  const mjModel& model = *world_.model;
  LabelRow row;
  if (const char* name = mj_id2name(&model, mjOBJ_BODY, body)) row.body = name;
  std::pair<int, int> key{kind, id};
  if (const int robot = robot_of(body); robot >= 0) {
    key = {kRobotKind, robot};
    row.instance_name = world_.robots[static_cast<size_t>(robot)].name;
    row.semantic_name = "robot";
  } else {
    row.instance_name = own_name;
    if (body > 0) {
      key = {kBodyKind, model.body_rootid[body]};
      const char* name = mj_id2name(&model, mjOBJ_BODY, model.body_rootid[body]);
      row.instance_name = name != nullptr ? name : "";
    }
    row.semantic_name = semantic_class(row.instance_name);
  }
  row.instance = id_of(&instances_, key);
  row.semantic = id_of(&classes_, row.semantic_name);
  return row;
}

}  // namespace gloam
