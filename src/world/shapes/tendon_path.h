#pragma once
// The path of a spatial tendon as it is drawn: straight between its points, around the geoms that
// it wraps, hanging where it is slack.

#include <mujoco/mujoco.h>

namespace gloam {

/// Most capsules that tendon `i` is drawn with; 0 for a fixed tendon, which has no path.
int tendon_segments(const mjModel& model, int i);

/// Writes tendon_segments() capsules (world/shapes/capsule_mesh.h), unused ones as points. `data`
/// is that of the model after mj_tendon.
///
/// A tendon hangs as a catenary along `gravity` while it is shorter than its slack length X: two
/// sites, either range = 0 … X or springlength = 0 … X with a stiffness, neither damping nor
/// friction (MuJoCo's manual, "spatial tendon").
void place_tendon(const mjModel& model, const mjData& data, const double* gravity, int i,
                  float* vertices);

}  // namespace gloam
