#include "world/world_robots.h"

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

}  // namespace gloam
