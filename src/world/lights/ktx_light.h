#pragma once
// Image lights out of KTX files, as MuJoCo's Filament renderer takes them (made by cmgen).

#include "geometry/image/image_file.h"
#include "world/render_description.h"

namespace gloam {

/// The six float faces of a cube as a map of the same resolution, turned as MuJoCo turns its sky.
/// Values that are not finite or negative count as 0.
EnvironmentDescription environment_of(const KtxImage& cube, std::string name);

}  // namespace gloam
