#include "runtime/rendering/shared_renderer.h"

#include <algorithm>

#include "base/log.h"
#include "base/memory.h"

namespace gloam {
namespace {

void report_left_out(const std::vector<Error>& left_out) {
  constexpr size_t kMaxListed = 20;
  for (size_t i = 0; i < std::min(left_out.size(), kMaxListed); ++i)
    log_warning("{}", left_out[i].to_string());
  if (left_out.size() > kMaxListed)
    log_warning("{} more elements are not rendered as specified", left_out.size() - kMaxListed);
}

}  // namespace

Result<std::shared_ptr<SharedRenderer>> SharedRenderer::create(
    std::shared_ptr<const CompiledWorld> world) {
  return or_no_memory("rendering the scene", [&]() -> Result<std::shared_ptr<SharedRenderer>> {
    auto shared = std::make_shared<SharedRenderer>();
    GLOAM_TRY(shared->description, describe_for_rendering(*world));
    report_left_out(shared->description.unsupported);
    GLOAM_TRY(shared->renderer, make_renderer(shared->description, world->scene.render.device));
    shared->world = std::move(world);
    return shared;
  });
}

Result<std::shared_ptr<SharedRenderer>> SharedRenderers::of(
    const std::shared_ptr<const CompiledWorld>& world) {
  const std::lock_guard lock(mutex_);
  for (const auto& renderer : renderers_) {
    if (renderer->world == world) return renderer;
  }
  GLOAM_TRY(auto made, SharedRenderer::create(world));
  renderers_.push_back(made);
  return made;
}

bool SharedRenderers::any() const {
  const std::lock_guard lock(mutex_);
  return !renderers_.empty();
}

void SharedRenderers::keep_only(const std::shared_ptr<const CompiledWorld>& world) {
  const std::lock_guard lock(mutex_);
  std::erase_if(renderers_, [&](const auto& renderer) { return renderer->world != world; });
}

Error other_schedule(const std::string& what) {
  return {ErrorKind::kInput,
          what + " has a different sampling schedule in the recompiled World",
          {},
          "open the stream again"};
}

}  // namespace gloam
