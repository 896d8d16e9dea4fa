#pragma once
// When a step of MuJoCo may be taken in two halves, between which forces are added.

#include <mujoco/mujoco.h>

namespace gloam {

/// Whether mj_step1 and mj_step2 are mj_step, also when inertia grows in between: no solver has
/// made a matrix of it yet, and nobody sleeps whom a force has to wake.
inline bool has_halves(const mjModel& m) {
  return m.opt.integrator != mjINT_RK4 && m.opt.solver != mjSOL_PGS &&
         m.opt.noslip_iterations == 0 && m.nflex == 0 && (m.opt.enableflags & mjENBL_SLEEP) == 0;
}

}  // namespace gloam
