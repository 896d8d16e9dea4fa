#pragma once
// The kind of a robot by the shape of its tree.

#include <array>
#include <string>
#include <vector>

#include "control/guess/robot_tree.h"

namespace gloam {

enum class BodyPlan { kQuadruped, kHumanoid, kQuadrotor, kDiffDrive, kArm, kOther };
/// "quadruped", "diff_drive" …
const char* name_of(BodyPlan plan);

/// Parts are joints, or limbs of the tree, by their indices.
struct RobotShape {
  BodyPlan plan = BodyPlan::kOther;
  std::array<int, 4> legs = {-1, -1, -1, -1};  ///< limbs; quadruped: FL, FR, RL, RR; humanoid: 2
  std::vector<int> left_wheels, right_wheels;  ///< joints
  std::vector<int> arms;                       ///< limbs
  std::vector<int> gripper;                    ///< joints
  std::vector<int> rotors;                     ///< actuators
  /// Why, and why not another kind: sentences without a full stop.
  std::vector<std::string> reasons;
};

/// `may_float`: a tree that is fixed to the world may be put on a free joint.
RobotShape find_shape(const CompiledWorld& world, const RobotTree& tree, bool may_float);

}  // namespace gloam
