#pragma once
// State that all cameras of one World share: its visuals, a renderer, events. Made when the first
// camera is opened: physics alone needs neither.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "render/renderer.h"
#include "render/turns.h"
#include "sensors/event/event_track.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {

struct SharedRenderer {
  std::shared_ptr<const CompiledWorld> world;
  RenderDescription description;
  std::unique_ptr<Renderer> renderer;
  RenderTurns turns;  ///< of the sensors that `renderer` works for
  EventTracks events;

  static Result<std::shared_ptr<SharedRenderer>> create(std::shared_ptr<const CompiledWorld> world);
};

/// The renderers of a simulation, by World: one, and during a recompile two. Any thread.
class SharedRenderers {
 public:
  /// Makes it when it is first asked for; others wait.
  Result<std::shared_ptr<SharedRenderer>> of(const std::shared_ptr<const CompiledWorld>& world);
  /// True if one was asked for.
  bool any() const;
  /// Forgets those of other Worlds; who has one keeps it.
  void keep_only(const std::shared_ptr<const CompiledWorld>& world);

 private:
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<SharedRenderer>> renderers_;
};

/// Error that ends a stream whose camera, LiDAR or sensor a recompile has changed.
Error other_schedule(const std::string& what);

}  // namespace gloam
