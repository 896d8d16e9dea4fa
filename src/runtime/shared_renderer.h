#pragma once
// One World's visuals and the one renderer that all cameras of a simulation share. Made when the
// first camera is opened: physics alone needs neither.

#include <memory>
#include <mutex>

#include "gloam/result.h"
#include "render/renderer.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {

struct SharedRenderer {
  RenderDescription description;
  std::unique_ptr<Renderer> renderer;
  std::mutex mutex;  ///< held while `renderer` works

  static Result<std::shared_ptr<SharedRenderer>> create(const CompiledWorld& world);
};

}  // namespace gloam
