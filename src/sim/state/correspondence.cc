#include "sim/state/correspondence.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <unordered_map>

#include "sim/commands/live_fields.h"
#include "sim/state/state_layout.h"

namespace gloam {
namespace {

using Keys = std::vector<std::string>;

const std::string& at(const Keys& keys, int id) { return keys[static_cast<size_t>(id)]; }

// Gives what has no name a number among its like. A name of MuJoCo's cannot hold the separator.
class KeyMaker {
 public:
  KeyMaker(const mjModel& model, mjtObj type) : model_(model), type_(type) {}
  std::string operator()(int id, const std::string& owner) {
    const char* name = mj_id2name(&model_, type_, id);
    if (name != nullptr && *name != 0) return name;
    return fmt::format("{}\n{}", owner, count_[owner]++);
  }

 private:
  const mjModel& model_;
  mjtObj type_;
  std::map<std::string, int> count_;
};

template <class Owner>
Keys keys_of(const mjModel& m, mjtObj type, mjtSize count, Owner&& owner) {
  KeyMaker make(m, type);
  Keys keys;
  for (int id = 0; id < count; ++id) keys.push_back(make(id, owner(id)));
  return keys;
}

// Bodies come after their parents.
Keys body_keys(const mjModel& m) {
  KeyMaker make(m, mjOBJ_BODY);
  Keys keys;
  for (int id = 0; id < m.nbody; ++id)
    keys.push_back(make(id, id == 0 ? "" : at(keys, m.body_parentid[id])));
  return keys;
}

std::string name_of(const mjModel& m, int type, int id) {
  const char* name = mj_id2name(&m, type, id);
  return name != nullptr ? name : "";
}

std::vector<int> match(const Keys& before, const Keys& after) {
  std::unordered_map<std::string, int> ids;
  for (size_t i = 0; i < before.size(); ++i) ids.emplace(before[i], static_cast<int>(i));
  std::vector<int> matched;
  for (const std::string& key : after) {
    const auto found = ids.find(key);
    matched.push_back(found != ids.end() ? found->second : -1);
  }
  return matched;
}

Keys robot_names(const CompiledWorld& world) {
  Keys names;
  for (const RobotInstance& robot : world.robots) names.push_back(robot.name);
  // A bare model is called after its file; whatever it is called now, it is the one robot.
  if (!world.scene.bare_model.empty()) names = {""};
  return names;
}

// The id in `after` of element `id` of `before`, or -1.
int after_id(const std::vector<int>& matched, int id) {
  const auto found = std::find(matched.begin(), matched.end(), id);
  return found != matched.end() ? static_cast<int>(found - matched.begin()) : -1;
}

// Each element's values, one after the other.
std::vector<int> spread(const std::vector<int>& matched, int width) {
  std::vector<int> places;
  for (const int id : matched) {
    for (int i = 0; i < width; ++i) places.push_back(id < 0 ? -1 : id * width + i);
  }
  return places;
}

}  // namespace

Correspondence::Correspondence(const CompiledWorld& world_before, const CompiledWorld& world_after)
    : before(world_before), after(world_after) {
  const mjModel &b = *before.model, &a = *after.model;
  const Keys bodies_b = body_keys(b), bodies_a = body_keys(a);
  body = match(bodies_b, bodies_a);
  // Matches what `keys` makes of either model, given the keys of its bodies.
  const auto both = [&](auto&& keys) { return match(keys(b, bodies_b), keys(a, bodies_a)); };
  joint = both([](const mjModel& m, const Keys& bodies) {
    return keys_of(m, mjOBJ_JOINT, m.njnt, [&](int id) { return at(bodies, m.jnt_bodyid[id]); });
  });
  geom = both([](const mjModel& m, const Keys& bodies) {
    return keys_of(m, mjOBJ_GEOM, m.ngeom, [&](int id) { return at(bodies, m.geom_bodyid[id]); });
  });
  light = both([](const mjModel& m, const Keys& bodies) {
    return keys_of(m, mjOBJ_LIGHT, m.nlight,
                   [&](int id) { return at(bodies, m.light_bodyid[id]); });
  });
  const auto without_owner = [&](mjtObj type, mjtSize mjModel::* count) {
    return both([&](const mjModel& m, const Keys&) {
      return keys_of(m, type, m.*count, [](int) { return std::string(); });
    });
  };
  material = without_owner(mjOBJ_MATERIAL, &mjModel::nmat);
  height_field = without_owner(mjOBJ_HFIELD, &mjModel::nhfield);
  flex = without_owner(mjOBJ_FLEX, &mjModel::nflex);
  tendon = without_owner(mjOBJ_TENDON, &mjModel::ntendon);
  plugin = without_owner(mjOBJ_PLUGIN, &mjModel::nplugin);
  // What an unnamed one of these acts on or measures tells it from others.
  actuator = both([](const mjModel& m, const Keys&) {
    return keys_of(m, mjOBJ_ACTUATOR, m.nactuator, [&](int id) {
      const int type = m.actuator_trntype[id];
      const int target = m.actuator_trnid[2 * id];
      const bool of_joint = type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT;
      const int object = of_joint               ? mjOBJ_JOINT
                         : type == mjTRN_TENDON ? mjOBJ_TENDON
                         : type == mjTRN_BODY   ? mjOBJ_BODY
                                                : mjOBJ_SITE;
      return fmt::format("{} {}", type, name_of(m, object, target));
    });
  });
  sensor = both([](const mjModel& m, const Keys&) {
    return keys_of(m, mjOBJ_SENSOR, m.nsensor, [&](int id) {
      return fmt::format("{} {}", m.sensor_type[id],
                         name_of(m, m.sensor_objtype[id], m.sensor_objid[id]));
    });
  });
  equality = both([](const mjModel& m, const Keys&) {
    return keys_of(m, mjOBJ_EQUALITY, m.neq, [&](int id) {
      return fmt::format("{} {} {}", m.eq_type[id], name_of(m, m.eq_objtype[id], m.eq_obj1id[id]),
                         name_of(m, m.eq_objtype[id], m.eq_obj2id[id]));
    });
  });
  robot = match(robot_names(before), robot_names(after));
}

std::vector<int> Correspondence::live_values(LiveFieldId field) const {
  switch (field) {
    case LiveFieldId::kGravity:
    case LiveFieldId::kWind:
      return {0, 1, 2};
    case LiveFieldId::kBodyMass:
      return body;
    case LiveFieldId::kGeomFriction:
      return spread(geom, 3);
    case LiveFieldId::kGeomColor:
      return spread(geom, 4);
    case LiveFieldId::kLightDiffuse:
      return spread(light, 3);
    case LiveFieldId::kLightIntensity:
    case LiveFieldId::kLightActive:
      return light;
    case LiveFieldId::kMaterialColor:
      return spread(material, 4);
    case LiveFieldId::kActuatorGain:
      return spread(actuator, mjNGAIN);
    case LiveFieldId::kActuatorBias:
      return spread(actuator, mjNBIAS);
    case LiveFieldId::kJointStiffness:
      return joint;
    case LiveFieldId::kDofArmature:
    case LiveFieldId::kDofDamping:
    case LiveFieldId::kDofFrictionLoss:
      return dof_places();
    case LiveFieldId::kHeightField:
      return height_places();
    default:
      return material;  // one number of each
  }
}

std::vector<int> Correspondence::dof_places() const {
  const mjModel &b = *before.model, &a = *after.model;
  std::vector<int> places(static_cast<size_t>(a.nv), -1);
  for (int id = 0; id < a.njnt; ++id) {
    const int old = joint[static_cast<size_t>(id)];
    if (old < 0 || b.jnt_type[old] != a.jnt_type[id]) continue;
    const auto first = places.begin() + a.jnt_dofadr[id];
    std::iota(first, first + joint_width(a.jnt_type[id]).qvel, b.jnt_dofadr[old]);
  }
  return places;
}

std::vector<int> Correspondence::height_places() const {
  const mjModel &b = *before.model, &a = *after.model;
  std::vector<int> places(static_cast<size_t>(a.nhfielddata), -1);
  for (int id = 0; id < a.nhfield; ++id) {
    const int old = height_field[static_cast<size_t>(id)];
    if (old < 0 || b.hfield_nrow[old] != a.hfield_nrow[id] ||
        b.hfield_ncol[old] != a.hfield_ncol[id])
      continue;
    const auto first = places.begin() + a.hfield_adr[id];
    std::iota(first, first + a.hfield_nrow[id] * a.hfield_ncol[id], b.hfield_adr[old]);
  }
  return places;
}

std::optional<Command> Correspondence::translate(const Command& command) const {
  Command next = command;
  const auto follow = [&](auto& handle, const std::vector<int>& matched) {
    handle.id = after_id(matched, handle.id);
    handle.world = after.serial;
    return handle.id >= 0;
  };
  const bool remains = std::visit(
      [&](auto& what) {
        using T = std::decay_t<decltype(what)>;
        if constexpr (std::is_same_v<T, SetControl>) {
          return follow(what.actuator, actuator);
        } else if constexpr (std::is_same_v<T, SetJointState> || std::is_same_v<T, SetJointGoal>) {
          return follow(what.joint, joint);
        } else if constexpr (requires { what.robot; }) {
          bool all = follow(what.robot, robot);
          if constexpr (requires { what.joints; })
            for (Joint& one : what.joints) all = follow(one, joint) && all;
          return all;
        } else if constexpr (std::is_same_v<T, SetLiveField>) {
          // Values that lay side by side may lie apart now.
          const std::vector<int> places = live_values(what.field);
          std::vector<int> wanted(what.values.size());
          std::iota(wanted.begin(), wanted.end(), what.first);
          const auto found =
              std::search(places.begin(), places.end(), wanted.begin(), wanted.end());
          what.first = static_cast<int>(found - places.begin());
          return found != places.end();
        } else if constexpr (std::is_same_v<T, SetEquality>) {
          return follow(what.equality, equality);
        } else if constexpr (std::is_same_v<T, ResetSim>) {
          return true;
        } else {
          return follow(what.body, body);
        }
      },
      next.what);
  if (!remains) return std::nullopt;
  return next;
}

}  // namespace gloam
