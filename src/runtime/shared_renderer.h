#pragma once
// What all cameras of a simulation share: one World's visuals, one renderer, events. Made when the
// first camera is opened: physics alone needs neither.

#include <memory>
#include <mutex>

#include "gloam/result.h"
#include "render/renderer.h"
#include "sensors/event_track.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {

struct SharedRenderer {
  RenderDescription description;
  std::unique_ptr<Renderer> renderer;
  std::mutex mutex;  ///< held while `renderer` works
  EventTracks events;

  static Result<std::shared_ptr<SharedRenderer>> create(const CompiledWorld& world);
};

}  // namespace gloam
