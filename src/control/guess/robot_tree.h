#pragma once
// The kinematic tree of a robot as limbs: chains of joints without branches.

#include <Eigen/Dense>
#include <vector>

#include "world/world.h"

namespace gloam {

/// Joints one below the other, up to the next branch of jointed bodies or the end of the tree.
struct Limb {
  int parent = -1;          ///< limb that it branches off; -1 = the base
  std::vector<int> joints;  ///< outwards; hinges, slides and balls
  int last_body = -1;       ///< body of the last joint
  Eigen::Vector3d root_B;   ///< anchor of the first joint [m], in the base frame B
  Eigen::Vector3d tip_B;    ///< centre of mass of the last body and all below it [m]
};

struct RobotTree {
  int base = 0;              ///< body of the free joint; 0 = the world, to which the robot is fixed
  bool is_floating = false;  ///< `base` has a free joint
  std::vector<Limb> limbs;   ///< a limb after its parent
  int lowest_limb = -1;      ///< limb with the lowest collision geom; -1 = the base has it
  DataPtr data;              ///< at the robot's initial keyframe, kinematics computed
};

/// Requires a World with one robot and nothing else. If several trees float, returns the one with
/// the most joints.
RobotTree robot_tree(const CompiledWorld& world);

/// Axis of a hinge or slide in the base frame.
Eigen::Vector3d axis_in_base(const RobotTree& tree, int joint);

}  // namespace gloam
