#pragma once
// Checks of --output: known words, and whether the scene delivers them.

#include <string>
#include <vector>

#include "gloam/scene.h"
#include "gloam/world.h"

namespace gloam::cli {

/// Error: a word that is none of kOutputNames, with the nearest one.
Status check_outputs(const std::vector<std::string>& outputs);

/// Error: also for outputs of whole recordings, which stills do not have.
Status check_still_outputs(const std::vector<std::string>& outputs);

/// Prints on stderr which of them the scene cannot produce.
void tell_void_outputs(const std::vector<std::string>& outputs, const Scene& scene,
                       const World& world);

}  // namespace gloam::cli
