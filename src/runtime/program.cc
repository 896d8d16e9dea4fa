#include "gloam/program.h"

#include <fmt/format.h>

#include "geometry/embree_version.h"
#include "world/version.h"

namespace gloam {

const char* version() { return GLOAM_VERSION; }

std::string configuration() {
#if defined(__clang__)
  const std::string compiler = fmt::format("clang {}.{}", __clang_major__, __clang_minor__);
#else
  const std::string compiler = fmt::format("gcc {}.{}", __GNUC__, __GNUC_MINOR__);
#endif
  return fmt::format("MuJoCo {}, Embree {}, {}, {}", mujoco_version(), embree_version(), compiler,
                     GLOAM_BUILD);
}

}  // namespace gloam
