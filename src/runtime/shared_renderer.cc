#include "runtime/shared_renderer.h"

namespace gloam {

Result<std::shared_ptr<SharedRenderer>> SharedRenderer::create(const CompiledWorld& world) {
  auto shared = std::make_shared<SharedRenderer>();
  GLOAM_TRY(shared->description, describe_for_rendering(world));
  GLOAM_TRY(shared->renderer, make_cpu_renderer(shared->description));
  return shared;
}

}  // namespace gloam
