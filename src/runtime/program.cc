#include "gloam/program.h"

#include <fmt/format.h>

#include "render/renderer.h"
#include "world/version.h"

namespace gloam {

const char* version() { return GLOAM_VERSION; }

std::string configuration() {
#if defined(__clang__)
  const std::string compiler = fmt::format("clang {}.{}", __clang_major__, __clang_minor__);
#else
  const std::string compiler = fmt::format("gcc {}.{}", __GNUC__, __GNUC_MINOR__);
#endif
  return fmt::format("MuJoCo {}, {}, {}, {}", mujoco_version(), ray_tracer_version(), compiler,
                     GLOAM_BUILD);
}

}  // namespace gloam
