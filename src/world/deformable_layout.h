#pragma once
// The order of deformable vertices in PoseFrame::vertices: those of all skins, then those of all
// flexes, each in the model's own order. PoseSolver fills them, the render description refers to
// them.

#include <mujoco/mujoco.h>

#include <vector>

namespace gloam {

struct DeformableLayout {
  std::vector<int> skin_first;  ///< first vertex of each skin, (nskin)
  std::vector<int> flex_first;  ///< first vertex of each flex, (nflex)
  int nvertex = 0;              ///< of all skins and flexes
};

DeformableLayout deformable_layout(const mjModel& model);

}  // namespace gloam
