#include "world/visual_label.h"

#include <fmt/format.h>

#include <algorithm>

#include "world/model_names.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

constexpr int kRobotKind = -1, kBodyKind = -2;

template <class Key>
uint32_t id_of(std::map<Key, uint32_t>* ids, const Key& key) {
  return ids->try_emplace(key, static_cast<uint32_t>(ids->size() + 1)).first->second;
}

const char* shape_name(int type) {
  constexpr const char* kShapes[] = {"plane",    "height field", "sphere", "capsule", "ellipsoid",
                                     "cylinder", "box",          "mesh",   "SDF"};
  const auto i = static_cast<size_t>(type);
  return i < std::size(kShapes) ? kShapes[i] : "other";
}

}  // namespace

std::string semantic_class(std::string_view name) {
  if (const size_t slash = name.rfind('/'); slash != std::string_view::npos)
    name.remove_prefix(slash + 1);
  const size_t last = name.find_last_not_of("0123456789_.- ");
  return last == std::string_view::npos ? "object" : std::string(name.substr(0, last + 1));
}

std::string body_label(const mjModel& model, int body) {
  std::string name = name_of(model, mjOBJ_BODY, body);
  if (!name.empty()) return name;
  name = fmt::format("body {}", body);
  while (mj_name2id(&model, mjOBJ_BODY, name.c_str()) >= 0) name += "_";
  return name;
}

std::string geom_label(const mjModel& model, int geom) {
  std::string name = name_of(model, mjOBJ_GEOM, geom);
  if (!name.empty()) return name;
  name = fmt::format("body {} geom {} ({})", model.geom_bodyid[geom], geom,
                     shape_name(model.geom_type[geom]));
  while (mj_name2id(&model, mjOBJ_GEOM, name.c_str()) >= 0) name += "_";
  return name;
}

LabelTable::LabelTable(const CompiledWorld& world) : world_(world) {
  if (!world.scene.bare_model.empty()) bare_roots_ = robot_roots(*world.model);
}

// A model that is nothing but one robot is called by the model's name.
std::string LabelTable::robot_name(int robot) const {
  if (world_.scene.bare_model.empty()) return world_.robots[static_cast<size_t>(robot)].name;
  const mjModel& model = *world_.model;
  const int root = bare_roots_[static_cast<size_t>(robot)];
  for (int body = 1; body < static_cast<int>(model.nbody); ++body)
    if (model.body_rootid[body] != root) return body_label(model, root);
  return world_.scene.name;
}

int LabelTable::robot_of(int body) const {
  const mjModel& model = *world_.model;
  if (!world_.scene.bare_model.empty()) {
    const auto found = std::find(bare_roots_.begin(), bare_roots_.end(), model.body_rootid[body]);
    return found == bare_roots_.end() ? -1 : static_cast<int>(found - bare_roots_.begin());
  }
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
  row.body = body_label(model, body);
  std::pair<int, int> key{kind, id};
  if (const int robot = robot_of(body); robot >= 0) {
    key = {kRobotKind, robot};
    row.instance_name = robot_name(robot);
    row.semantic_name = "robot";
  } else {
    std::string name = own_name;
    row.instance_name = own_name;
    if (body > 0) {
      const int root = model.body_rootid[body];
      key = {kBodyKind, root};
      name = name_of(model, mjOBJ_BODY, root);
      row.instance_name = body_label(model, root);
    } else if (name.empty() && kind == mjOBJ_GEOM) {
      row.instance_name = geom_label(model, id);
    }
    row.semantic_name = semantic_class(name);
  }
  row.instance = id_of(&instances_, key);
  row.semantic = id_of(&classes_, row.semantic_name);
  return row;
}

}  // namespace gloam
