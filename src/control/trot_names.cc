#include "control/trot_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

class LegNames {
 public:
  LegNames(const mjModel& model, const RobotInstance& robot) : m_(model), robot_(robot) {}

  Result<std::array<int, 3>> leg(const char* role, const std::vector<std::string>& names) const {
    if (names.size() != 3)
      return fail(fmt::format("'{}' has {} joints, not three", role, names.size()),
                  "list the hip, thigh and calf joint of each leg");
    std::array<int, 3> joints{};
    for (size_t i = 0; i < 3; ++i) {
      joints[i] = id(mjOBJ_JOINT, names[i]);
      if (joints[i] < 0)
        return fail(fmt::format("there is no joint '{}'", names[i]),
                    suggest_name(names[i], all(mjOBJ_JOINT, m_.njnt)));
      if (m_.jnt_type[joints[i]] != mjJNT_HINGE)
        return fail(fmt::format("joint '{}' is not a hinge", names[i]));
      if (i > 0 && (joints[i] <= joints[i - 1] ||
                    !is_part_of(m_, m_.jnt_bodyid[joints[i]], m_.jnt_bodyid[joints[i - 1]])))
        return fail(fmt::format("joint '{}' is not below '{}'", names[i], names[i - 1]),
                    "list the joints of a leg from the hip to the foot");
    }
    return joints;
  }

  Result<NamedFoot> foot(const std::string& name) const {
    NamedFoot out;
    out.geom = id(mjOBJ_GEOM, name);
    if (out.geom < 0) out.site = id(mjOBJ_SITE, name);
    if (out.geom < 0 && out.site < 0) out.body = id(mjOBJ_BODY, name);
    if (out.geom < 0 && out.site < 0 && out.body < 0) {
      std::vector<std::string> known = all(mjOBJ_GEOM, m_.ngeom);
      for (const std::string& other : all(mjOBJ_SITE, m_.nsite)) known.push_back(other);
      for (const std::string& other : all(mjOBJ_BODY, m_.nbody)) known.push_back(other);
      return fail(fmt::format("there is no geom, site or body '{}' for a foot", name),
                  suggest_name(name, known));
    }
    out.carrier = out.geom >= 0   ? m_.geom_bodyid[out.geom]
                  : out.site >= 0 ? m_.site_bodyid[out.site]
                                  : out.body;
    return out;
  }

  Error fail(const std::string& what, std::string hint = {}) const {
    return {ErrorKind::kInput, fmt::format("[robot.joints] of '{}': {}", robot_.name, what),
            robot_.options.joints.loc, std::move(hint)};
  }

 private:
  int id(mjtObj type, const std::string& name) const {
    return mj_name2id(&m_, type, (robot_.prefix + name).c_str());
  }
  std::vector<std::string> all(mjtObj type, mjtSize count) const {
    std::vector<std::string> names;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const char* name = mj_id2name(&m_, type, i);
      if (name != nullptr && std::string_view(name).starts_with(robot_.prefix) &&
          name[robot_.prefix.size()] != 0)
        names.emplace_back(name + robot_.prefix.size());
    }
    return names;
  }

  const mjModel& m_;
  const RobotInstance& robot_;
};

}  // namespace

Result<NamedLegs> named_legs(const mjModel& model, const RobotInstance& robot) {
  const RobotJoints& joints = robot.options.joints;
  const LegNames names(model, robot);
  const std::array<std::pair<const char*, const std::vector<std::string>*>, 4> legs = {
      {{"FL", &joints.front_left},
       {"FR", &joints.front_right},
       {"RL", &joints.rear_left},
       {"RR", &joints.rear_right}}};
  NamedLegs out;
  const bool any = std::ranges::any_of(legs, [](const auto& leg) { return !leg.second->empty(); });
  if (any) {
    out.joints.emplace();
    for (size_t i = 0; i < 4; ++i) {
      GLOAM_TRY((*out.joints)[i], names.leg(legs[i].first, *legs[i].second));
    }
  }
  if (joints.feet.empty()) return out;
  if (joints.feet.size() != 4)
    return names.fail(fmt::format("'feet' has {} names, not four", joints.feet.size()));
  out.feet.emplace();
  for (size_t i = 0; i < 4; ++i) {
    GLOAM_TRY((*out.feet)[i], names.foot(joints.feet[i]));
  }
  return out;
}

}  // namespace gloam
