#pragma once
// Options of a scene that can change nothing in a replay: physics, controllers and the agents of
// the log do not run in one, bodies move as they are logged.

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

/// Error: `changed` differs from the `logged` scene in such an option; names it and says what to do
/// instead.
Status check_options_act(const Scene& logged, const Scene& changed);

}  // namespace gloam
