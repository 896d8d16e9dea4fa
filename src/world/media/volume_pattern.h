#pragma once
// Densities made by formula, so that a scene can have smoke before anything solves for it.

#include <vector>

#include "base/vec.h"
#include "geometry/volume_file.h"
#include "gloam/scene.h"

namespace gloam {

/// Values 0..1 at the centres of voxels, which are near to cubes, of a box with edges of `size`
/// [m]. Plume: rises from the middle of the floor, widens and breaks up. Cloud: lumps that fade
/// towards the walls. A pure function of the options and the shape of the box.
VolumeFile make_pattern(const VolumePatternOptions& options, Vec3f size);

/// Voxels along x, y and z.
struct GridShape {
  int nx = 1, ny = 1, nz = 1;
};

/// Densities of air that hangs over the ground: `density` there, 1/e of it with each
/// `scale_height` [m] (0 = even), in billows of some ten metres whose standard deviation is
/// `turbulence` of their mean, one. `low`: of the box's floor over the ground [m].
std::vector<float> haze_layer(const GridShape& shape, Vec3f size, float low, double scale_height,
                              double turbulence, float density, uint64_t seed);

}  // namespace gloam
