#include "world/world_robots.h"

#include <string_view>

namespace gloam {
namespace {

class RootMarks {
 public:
  explicit RootMarks(const mjModel& model)
      : model_(model), marked_(static_cast<size_t>(model.nbody)) {}

  void mark_body(int body) {
    if (body > 0) marked_[static_cast<size_t>(model_.body_rootid[body])] = true;
  }
  void mark_joint(int joint) {
    if (joint >= 0) mark_body(model_.jnt_bodyid[joint]);
  }
  void mark_site(int site) {
    if (site >= 0) mark_body(model_.site_bodyid[site]);
  }
  void mark_tendon(int tendon) {
    for (int i = 0; tendon >= 0 && i < model_.tendon_num[tendon]; ++i) {
      const int wrap = model_.tendon_adr[tendon] + i, object = model_.wrap_objid[wrap];
      if (model_.wrap_type[wrap] == mjWRAP_JOINT) mark_joint(object);
      if (model_.wrap_type[wrap] == mjWRAP_SITE) mark_site(object);
    }
  }
  void mark_actuator(int actuator) {
    const int target = model_.actuator_trnid[2 * actuator];
    switch (model_.actuator_trntype[actuator]) {
      case mjTRN_JOINT:
      case mjTRN_JOINTINPARENT:
        return mark_joint(target);
      case mjTRN_SITE:
      case mjTRN_SLIDERCRANK:
        return mark_site(target);
      case mjTRN_TENDON:
        return mark_tendon(target);
      case mjTRN_BODY:
        return mark_body(target);
      default:
        return;
    }
  }
  std::vector<int> bodies() const {
    std::vector<int> out;
    for (size_t body = 1; body < marked_.size(); ++body)
      if (marked_[body]) out.push_back(static_cast<int>(body));
    return out;
  }

 private:
  const mjModel& model_;
  std::vector<bool> marked_;
};

}  // namespace

std::vector<int> robot_roots(const mjModel& model) {
  RootMarks marks(model);
  for (int i = 0; i < static_cast<int>(model.nactuator); ++i) marks.mark_actuator(i);
  for (int joint = 0; model.nactuator == 0 && joint < static_cast<int>(model.njnt); ++joint)
    if (model.jnt_type[joint] != mjJNT_FREE) marks.mark_joint(joint);
  return marks.bodies();
}

bool is_part_of(const mjModel& model, int body, int root) {
  while (body > root && body > 0) body = model.body_parentid[body];
  return body == root;
}

std::vector<int> robot_joints(const mjModel& model, const RobotInstance& robot) {
  std::vector<int> joints;
  for (int joint = 0; joint < static_cast<int>(model.njnt); ++joint)
    if (is_part_of(model, model.jnt_bodyid[joint], robot.root_body)) joints.push_back(joint);
  return joints;
}

int floating_joint(const mjModel& model, int body) {
  const int root = model.body_rootid[body];
  for (int i = 0; i < model.body_jntnum[root]; ++i) {
    const int joint = model.body_jntadr[root] + i;
    if (model.jnt_type[joint] == mjJNT_FREE) return joint;
  }
  return -1;
}

std::vector<int> robot_actuators(const mjModel& model, const RobotInstance& robot) {
  std::vector<int> actuators;
  for (int actuator = 0; actuator < static_cast<int>(model.nactuator); ++actuator) {
    const char* name = mj_id2name(&model, mjOBJ_ACTUATOR, actuator);
    const bool has_name = !robot.prefix.empty() && name != nullptr &&
                          std::string_view(name).starts_with(robot.prefix);
    RootMarks marks(model);
    marks.mark_actuator(actuator);
    const std::vector<int> roots = marks.bodies();
    const bool drives = !roots.empty() && robot.root_body > 0 &&
                        roots.front() == model.body_rootid[robot.root_body];
    if (has_name || (robot.prefix.empty() && drives)) actuators.push_back(actuator);
  }
  return actuators;
}

}  // namespace gloam
