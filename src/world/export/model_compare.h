#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

namespace gloam {

/// Names of the fields in which two models differ by any bit: sizes, options, visual settings,
/// statistics, flags and every array. Left out, because they say where a model came from and not
/// what it is: `paths`, the indices into it, the sizes they change, and the compiler's signature.
/// `compared` (may be null): how many fields were looked at; models of different sizes have no
/// arrays to compare.
std::vector<std::string> compare_models(const mjModel* a, const mjModel* b,
                                        int* compared = nullptr);

}  // namespace gloam
