#pragma once
// Densities made by formula, so that a scene can have smoke before anything solves for it.

#include "base/vec.h"
#include "geometry/volume_file.h"
#include "gloam/scene.h"

namespace gloam {

/// Values 0..1 at the centres of voxels, which are near to cubes, of a box with edges of `size`
/// [m]. Plume: rises from the middle of the floor, widens and breaks up. Cloud: lumps that fade
/// towards the walls. A pure function of the options and the shape of the box.
VolumeFile make_pattern(const VolumePatternOptions& options, Vec3f size);

}  // namespace gloam
