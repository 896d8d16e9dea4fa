#include "control/guess/robot_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

using Eigen::Vector3d;

constexpr double kParallel = 0.95;  // |cosine| of axes that count as parallel
constexpr size_t kLegJoints = 3;    // of a quadruped's leg
constexpr size_t kFewestArmJoints = 5, kFewestWalkerJoints = 5;

class ShapeFinder {
 public:
  ShapeFinder(const CompiledWorld& world, const RobotTree& tree, bool may_float)
      : m_(*world.model), tree_(tree), may_float_(may_float) {}

  RobotShape find() {
    const bool floats = tree_.is_floating || may_float_;
    if (tree_.is_floating && find_rotors()) return is(BodyPlan::kQuadrotor);
    if (floats && find_four_legs()) return with_arms(BodyPlan::kQuadruped);
    if (floats && find_two_legs()) return with_arms(BodyPlan::kHumanoid);
    if (floats && find_wheels()) return with_arms(BodyPlan::kDiffDrive);
    find_arms(std::array<int, 0>());
    if (!shape_.arms.empty() && !tree_.is_floating) return is(BodyPlan::kArm);
    tell_others();
    return is(BodyPlan::kOther);
  }

 private:
  RobotShape is(BodyPlan plan) {
    shape_.plan = plan;
    return shape_;
  }
  RobotShape with_arms(BodyPlan plan) {
    find_arms(shape_.legs);
    return is(plan);
  }
  template <class... Args>
  void tell(fmt::format_string<const Args&...> format, const Args&... args) {
    shape_.reasons.push_back(fmt::format(format, args...));
  }

  bool is_hinge(int joint) const { return m_.jnt_type[joint] == mjJNT_HINGE; }
  bool are_hinges(const Limb& limb) const {
    return std::ranges::all_of(limb.joints, [this](int joint) { return is_hinge(joint); });
  }

  bool find_rotors() {
    std::vector<int> rotors;
    for (int a = 0; a < static_cast<int>(m_.nactuator); ++a) {
      const mjtNum* gear = m_.actuator_gear + 6 * m_.actuator_outadr[a];
      if (m_.actuator_trntype[a] != mjTRN_SITE || gear[0] != 0 || gear[1] != 0 || gear[2] == 0)
        continue;
      rotors.push_back(a);
    }
    if (rotors.size() < 4) {
      if (!rotors.empty())
        tell("it has {} actuators that push along the z of a site, not four", rotors.size());
      return false;
    }
    shape_.rotors = rotors;
    tell("quadrotor: {} actuators push along the z of a site of the floating base", rotors.size());
    return true;
  }

  /// Four limbs of three hinges, one at each corner of the base.
  bool find_four_legs() {
    std::array<int, 4> corners = {-1, -1, -1, -1};
    size_t count = 0;
    for (size_t i = 0; i < tree_.limbs.size(); ++i) {
      const Limb& limb = tree_.limbs[i];
      if (limb.parent != -1 || limb.joints.size() != kLegJoints || !are_hinges(limb)) continue;
      ++count;
      corners[(limb.root_B.x() > 0 ? 0u : 2u) + (limb.root_B.y() > 0 ? 0u : 1u)] =
          static_cast<int>(i);
    }
    if (count != 4) {
      if (count > 0) tell("it has {} chains of three hinges on its base, not four", count);
      return false;
    }
    if (std::ranges::count(corners, -1) > 0) {
      tell("its four chains of three hinges are not at four corners around the base");
      return false;
    }
    if (!tree_.is_floating && std::ranges::count(corners, tree_.lowest_limb) == 0) return false;
    shape_.legs = corners;
    tell("quadruped: four chains of three hinges at the corners of the base; x is forward, y left");
    return true;
  }

  /// Two limbs of five or more hinges that reach down from the left and the right of the base.
  bool find_two_legs() {
    std::array<int, 2> sides = {-1, -1};
    for (size_t i = 0; i < tree_.limbs.size(); ++i) {
      const Limb& limb = tree_.limbs[i];
      if (limb.parent != -1 || limb.joints.size() < kFewestWalkerJoints || !are_hinges(limb) ||
          limb.tip_B.z() >= limb.root_B.z())
        continue;
      int& side = sides[limb.root_B.y() > 0 ? 0 : 1];
      const bool is_lower =
          side < 0 || limb.tip_B.z() < tree_.limbs[static_cast<size_t>(side)].tip_B.z();
      if (is_lower) side = static_cast<int>(i);
    }
    if (sides[0] < 0 || sides[1] < 0 || std::ranges::count(sides, tree_.lowest_limb) == 0)
      return false;
    std::ranges::copy(sides, shape_.legs.begin());
    tell("humanoid: two legs of {} and {} hinges below the base, left and right",
         tree_.limbs[static_cast<size_t>(sides[0])].joints.size(),
         tree_.limbs[static_cast<size_t>(sides[1])].joints.size());
    return true;
  }

  /// Joints that an actuator drives; all in a model without actuators, as a URDF is.
  std::vector<bool> driven() const {
    std::vector<bool> driven(static_cast<size_t>(m_.njnt), m_.nactuator == 0);
    for (int a = 0; a < static_cast<int>(m_.nactuator); ++a)
      if (m_.actuator_trntype[a] == mjTRN_JOINT)
        driven[static_cast<size_t>(m_.actuator_trnid[2 * a])] = true;
    return driven;
  }

  /// Single hinges with axes along y on both sides, which are driven if anything is.
  bool find_wheels() {
    int along_x = 0;
    const std::vector<bool> is_driven = driven();
    for (const Limb& limb : tree_.limbs) {
      const int joint = limb.joints.front();
      const bool is_wheel = limb.parent == -1 && limb.joints.size() == 1 && is_hinge(joint) &&
                            m_.jnt_limited[joint] == 0 &&
                            (m_.nactuator == 0 || is_driven[static_cast<size_t>(joint)]);
      if (!is_wheel) continue;
      const Vector3d axis = axis_in_base(tree_, joint);
      if (std::abs(axis.y()) >= kParallel)
        (limb.root_B.y() > 0 ? shape_.left_wheels : shape_.right_wheels).push_back(joint);
      along_x += std::abs(axis.x()) >= kParallel ? 1 : 0;
    }
    const size_t left = shape_.left_wheels.size(), right = shape_.right_wheels.size();
    if (left == 0 || left != right || (!tree_.is_floating && tree_.lowest_limb < 0)) {
      if (along_x > 1)
        tell("{} wheels have axes along x, but forward is x and wheels turn about y", along_x);
      shape_.left_wheels.clear();
      shape_.right_wheels.clear();
      return false;
    }
    tell("diff_drive: {} wheels on the left and {} on the right, with axes along y", left, right);
    return true;
  }

  template <class Legs>
  void find_arms(const Legs& legs) {
    for (size_t i = 0; i < tree_.limbs.size(); ++i) {
      const Limb& limb = tree_.limbs[i];
      if (limb.joints.size() < kFewestArmJoints || !are_hinges(limb) ||
          std::ranges::find(legs, static_cast<int>(i)) != std::end(legs))
        continue;
      shape_.arms.push_back(static_cast<int>(i));
      tell("arm: {} hinges in series", limb.joints.size());
      find_gripper(static_cast<int>(i));
    }
  }

  /// Fingers: short limbs at the end of the arm, two of which move along or about parallel axes.
  void find_gripper(int arm) {
    constexpr size_t kMostFingers = 16;
    std::vector<int> fingers;
    // A limb follows its parent.
    for (size_t i = static_cast<size_t>(arm) + 1;
         i < tree_.limbs.size() && fingers.size() < kMostFingers; ++i)
      if (tree_.limbs[i].parent == arm && tree_.limbs[i].joints.size() <= 2)
        fingers.push_back(tree_.limbs[i].joints.front());
    bool any = false;
    for (size_t a = 0; a < fingers.size(); ++a)
      for (size_t b = a + 1; b < fingers.size(); ++b)
        any = any || are_parallel(fingers[a], fingers[b]);
    if (!any) return;
    shape_.gripper.insert(shape_.gripper.end(), fingers.begin(), fingers.end());
    tell("gripper of {} fingers at its end", fingers.size());
  }

  bool are_parallel(int a, int b) const {
    return m_.jnt_type[a] == m_.jnt_type[b] &&
           std::abs(axis_in_base(tree_, a).dot(axis_in_base(tree_, b))) >= kParallel;
  }

  void tell_others() {
    if (tree_.limbs.empty()) return tell("it has no joints");
    for (const Limb& limb : tree_.limbs)
      tell("a chain of {} joints{}", limb.joints.size(),
           limb.parent >= 0    ? " on another chain"
           : tree_.is_floating ? " on the floating base"
                               : "");
    tell(
        "none of: four legs of three hinges, two legs of five hinges or more, driven wheels on "
        "both "
        "sides, an arm of five hinges or more, four thrusts at sites");
  }

  const mjModel& m_;
  const RobotTree& tree_;
  const bool may_float_;
  RobotShape shape_;
};

}  // namespace

const char* name_of(BodyPlan plan) {
  switch (plan) {
    case BodyPlan::kQuadruped:
      return "quadruped";
    case BodyPlan::kHumanoid:
      return "humanoid";
    case BodyPlan::kQuadrotor:
      return "quadrotor";
    case BodyPlan::kDiffDrive:
      return "diff_drive";
    case BodyPlan::kArm:
      return "arm";
    case BodyPlan::kOther:
      break;
  }
  return "other";
}

RobotShape find_shape(const CompiledWorld& world, const RobotTree& tree, bool may_float) {
  return ShapeFinder(world, tree, may_float).find();
}

}  // namespace gloam
