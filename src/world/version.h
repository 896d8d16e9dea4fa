#pragma once
// For modules that do not see MuJoCo.

#include <string>

namespace gloam {

/// Version of the MuJoCo library that runs: "4.0.1".
std::string mujoco_version();

}  // namespace gloam
