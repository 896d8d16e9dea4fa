#include "world/version.h"

#include <mujoco/mujoco.h>

namespace gloam {

std::string mujoco_version() { return mj_versionString(); }

}  // namespace gloam
