#include "runtime/shared_renderer.h"

#include <algorithm>

#include "base/log.h"

namespace gloam {
namespace {

void report_left_out(const std::vector<Error>& left_out) {
  constexpr size_t kMost = 20;
  for (size_t i = 0; i < std::min(left_out.size(), kMost); ++i)
    log_warning("{}", left_out[i].to_string());
  if (left_out.size() > kMost)
    log_warning("{} more are not drawn as told", left_out.size() - kMost);
}

}  // namespace

Result<std::shared_ptr<SharedRenderer>> SharedRenderer::create(const CompiledWorld& world) {
  auto shared = std::make_shared<SharedRenderer>();
  GLOAM_TRY(shared->description, describe_for_rendering(world));
  report_left_out(shared->description.unsupported);
  GLOAM_TRY(shared->renderer, make_renderer(shared->description, world.scene.render.device));
  return shared;
}

}  // namespace gloam
