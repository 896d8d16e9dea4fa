#pragma once
// [[randomize]]: options that sim.seed draws.

#include <string>
#include <vector>

#include "gloam/scene.h"

namespace gloam {

/// Checks that each [[randomize]] has one distribution, and that every draw is a value that the
/// option can have, as far as is known before generators have added theirs; that none brings in a
/// second environment.
Status validate_randomize(const Scene& scene);

/// Stages of drawing: options that decide what is generated come first, so that the others can
/// refer to the result of a generator, its lamps and materials.
enum class DrawStage { kPlace, kRest };

/// Draws the options of a stage, in the order of the file, and appends what came of them. A draw
/// depends on its seed, else sim.seed, and the option's path alone: others do not disturb it.
/// Errors: an unknown option; a distribution that it cannot have; a value out of its range; what
/// validate_scene finds wrong afterwards.
Status draw_options(DrawStage stage, Scene* scene, std::vector<DrawnOption>* drawn);

}  // namespace gloam
