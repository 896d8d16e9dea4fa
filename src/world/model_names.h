#pragma once

#include <mujoco/mujoco.h>

#include <string>

namespace gloam {

/// Empty for what has no name, and for no object (id < 0).
inline std::string name_of(const mjModel& m, mjtObj type, int id) {
  const char* name = id >= 0 ? mj_id2name(&m, type, id) : nullptr;
  return name != nullptr ? name : "";
}

}  // namespace gloam
