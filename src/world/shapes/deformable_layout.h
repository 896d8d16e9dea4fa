#pragma once
// The order of deformable vertices in PoseFrame::vertices: those of all skins, then those of all
// flexes, then the capsules of one-dimensional flexes (one per element) and of spatial tendons,
// each in the model's own order. PoseSolver fills them, the render description refers to them.

#include <mujoco/mujoco.h>

#include <vector>

namespace gloam {

struct DeformableLayout {
  std::vector<int> skin_first;  ///< first vertex of each skin, (nskin)
  std::vector<int> flex_first;  ///< first vertex of each flex, (nflex)
  /// First vertex of each flex's capsules, -1 = dimension 2 or 3, (nflex)
  std::vector<int> cable_first;
  /// First vertex of each tendon's capsules, -1 = no path, (ntendon)
  std::vector<int> tendon_first;
  bool has_tendons = false;  ///< some tendon has a path
  int nvertex = 0;           ///< number of all vertices
};

DeformableLayout deformable_layout(const mjModel& model);

/// Writes the vertices of all cables and tendons to where they stand in `vertices`, (nvertex x 3).
/// `data` is that of the model after mj_flex and mj_tendon, `gravity` [m/s²] makes slack tendons
/// hang.
void place_capsules(const mjModel& model, const mjData& data, const double* gravity,
                    const DeformableLayout& layout, float* vertices);

}  // namespace gloam
