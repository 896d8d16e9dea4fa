#pragma once
// In which order a multigrid cycle works on its levels, whatever works. Device-safe.

namespace gloam::gas {

/// Pairs of smoothing steps on the coarsest level.
inline constexpr int kCoarsestSteps = 8;

/// Makes x of `level` from its b. `from_zero`: x is taken to be 0. `work` has
///   begin(level): scratch = the step with kSmooth[0] from x = 0
///   forth(level, n), back(level, n): scratch from x, x from scratch: a step with kSmooth[n]
///   restrict_residual(level), prolong(level): to the next one's b, from the next one's x
template <class Work>
void run_cycle(Work& work, int level, int levels, bool from_zero) {
  if (from_zero) {
    work.begin(level);
  } else {
    work.forth(level, 0);
  }
  work.back(level, 1);
  if (level + 1 == levels) {
    for (int n = 1; n < kCoarsestSteps; ++n) {
      work.forth(level, 0);
      work.back(level, 1);
    }
    return;
  }
  work.restrict_residual(level);
  run_cycle(work, level + 1, levels, true);
  // Once more where it is cheap: joining without interpolation needs the better solution there.
  if (level + 2 < levels) run_cycle(work, level + 1, levels, false);
  work.prolong(level);
  work.forth(level, 1);
  work.back(level, 0);
}

}  // namespace gloam::gas
