#include "control/guess/robot_tree.h"

#include <cmath>
#include <limits>
#include <utility>

#include "world/model_memory.h"

namespace gloam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d vector_of(const mjtNum* p) { return {p[0], p[1], p[2]}; }
Matrix3d rotation_of(const mjtNum* p) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(p);
}

class TreeReader {
 public:
  TreeReader(const mjModel& model, RobotTree* tree) : m_(model), tree_(tree) {
    joints_below_.assign(static_cast<size_t>(m_.nbody), 0);
    for (int body = static_cast<int>(m_.nbody) - 1; body > 0; --body) {
      joints_below_[static_cast<size_t>(body)] += own_joints(body);
      joints_below_[static_cast<size_t>(m_.body_parentid[body])] +=
          joints_below_[static_cast<size_t>(body)];
    }
    children_.resize(static_cast<size_t>(m_.nbody));
    for (int body = 1; body < static_cast<int>(m_.nbody); ++body)
      children_[static_cast<size_t>(m_.body_parentid[body])].push_back(body);
  }

  void read() {
    find_base();
    for (const int child : jointed_children(tree_->base)) grow(child, {});
    const Vector3d p_WB = vector_of(tree_->data->xpos + 3 * tree_->base);
    const Matrix3d R_WB = rotation_of(tree_->data->xmat + 9 * tree_->base);
    for (Limb& limb : tree_->limbs) {
      const int first = limb.joints.front();
      limb.root_B = R_WB.transpose() * (vector_of(tree_->data->xanchor + 3 * first) - p_WB);
      limb.tip_B =
          R_WB.transpose() * (vector_of(tree_->data->subtree_com + 3 * limb.last_body) - p_WB);
    }
    find_lowest();
  }

 private:
  int own_joints(int body) const {
    int count = 0;
    for (int k = 0; k < m_.body_jntnum[body]; ++k)
      count += m_.jnt_type[m_.body_jntadr[body] + k] != mjJNT_FREE ? 1 : 0;
    return count;
  }

  void find_base() {
    int most = -1;
    for (int joint = 0; joint < static_cast<int>(m_.njnt); ++joint) {
      const int body = m_.jnt_bodyid[joint];
      if (m_.jnt_type[joint] != mjJNT_FREE || joints_below_[static_cast<size_t>(body)] <= most)
        continue;
      most = joints_below_[static_cast<size_t>(body)];
      tree_->base = body;
    }
    // A loose object beside a robot that is fixed is not its base.
    if (tree_->base > 0 && most < joints_below_[0] - most) tree_->base = 0;
    tree_->is_floating = tree_->base > 0;
  }

  std::vector<int> jointed_children(int body) const {
    std::vector<int> jointed;
    for (const int child : children_[static_cast<size_t>(body)])
      if (joints_below_[static_cast<size_t>(child)] > 0) jointed.push_back(child);
    return jointed;
  }

  void grow(int body, Limb limb) {
    for (std::vector<int> children; body >= 0; body = children.size() == 1 ? children[0] : -1) {
      for (int k = 0; k < m_.body_jntnum[body]; ++k) {
        const int joint = m_.body_jntadr[body] + k;
        if (m_.jnt_type[joint] == mjJNT_FREE) continue;
        limb.joints.push_back(joint);
        limb.last_body = body;
      }
      children = jointed_children(body);
      if (children.size() == 1) continue;
      const int parent = limb.joints.empty() ? limb.parent : static_cast<int>(tree_->limbs.size());
      if (!limb.joints.empty()) tree_->limbs.push_back(limb);
      // Trees are as deep as their XML, which is bounded (base/nesting.h).
      for (const int child : children) grow(child, Limb{.parent = parent});
    }
  }

  // Limb of each body; -1 = the base.
  std::vector<int> limb_of_bodies() const {
    std::vector<int> limbs(static_cast<size_t>(m_.nbody), -1);
    std::vector<int> of_joint(static_cast<size_t>(m_.njnt), -1);
    for (size_t i = 0; i < tree_->limbs.size(); ++i)
      for (const int joint : tree_->limbs[i].joints)
        of_joint[static_cast<size_t>(joint)] = static_cast<int>(i);
    for (int body = 1; body < static_cast<int>(m_.nbody); ++body) {
      int& limb = limbs[static_cast<size_t>(body)];
      limb = limbs[static_cast<size_t>(m_.body_parentid[body])];
      for (int k = 0; k < m_.body_jntnum[body]; ++k)
        limb = of_joint[static_cast<size_t>(m_.body_jntadr[body] + k)];
    }
    return limbs;
  }

  void find_lowest() {
    const std::vector<int> limbs = limb_of_bodies();
    double lowest = std::numeric_limits<double>::infinity();
    for (int geom = 0; geom < static_cast<int>(m_.ngeom); ++geom) {
      if (m_.geom_type[geom] == mjGEOM_PLANE ||
          (m_.geom_contype[geom] == 0 && m_.geom_conaffinity[geom] == 0))
        continue;
      const double z = lowest_point(geom);
      if (z >= lowest) continue;
      lowest = z;
      tree_->lowest_limb = limbs[static_cast<size_t>(m_.geom_bodyid[geom])];
    }
  }

  // Height of the lowest corner of the geom's bounding box [m].
  double lowest_point(int geom) const {
    const mjtNum *box = m_.geom_aabb + 6 * geom, *up = tree_->data->geom_xmat + 9 * geom + 6;
    double z = tree_->data->geom_xpos[3 * geom + 2];
    for (int i = 0; i < 3; ++i) z += up[i] * box[i] - std::abs(up[i]) * box[3 + i];
    return z;
  }

  const mjModel& m_;
  RobotTree* tree_;
  std::vector<int> joints_below_;  // of each body and all below it
  std::vector<std::vector<int>> children_;
};

}  // namespace

RobotTree robot_tree(const CompiledWorld& world) {
  const mjModel& model = *world.model;
  RobotTree tree;
  tree.data = make_data(model);
  if (world.initial_key >= 0) mj_resetDataKeyframe(&model, tree.data.get(), world.initial_key);
  mj_kinematics(&model, tree.data.get());
  mj_comPos(&model, tree.data.get());
  TreeReader(model, &tree).read();
  return tree;
}

Eigen::Vector3d axis_in_base(const RobotTree& tree, int joint) {
  return rotation_of(tree.data->xmat + 9 * tree.base).transpose() *
         vector_of(tree.data->xaxis + 3 * joint);
}

}  // namespace gloam
