#pragma once
// Settings of a run that are not in its scene file.

#include "record/recorder.h"
#include "world/world.h"

namespace gloam {

/// Options of the World's Scene, as it was given, that its file does not have so, as
/// {"sim.duration", "2"}: changes by --set, by options such as --look, by overlays or by a program.
/// Whole [[tables]] that were added are left out, and so are what is recorded, the seed and the
/// settings of the renderer, which the summary tells by themselves. Empty where the file cannot be
/// read again.
std::vector<NamedText> changed_settings(const CompiledWorld& world);

}  // namespace gloam
