#pragma once
// What goes together in [[light]], [sky], [blackout] and [[volume]]; ranges are checked elsewhere.

#include "gloam/scene.h"

namespace gloam {

Status validate_light(const LightOptions& light);
Status validate_sky(const SkyOptions& sky);
Status validate_blackout(const BlackoutOptions& blackout);
Status validate_volume(const VolumeOptions& volume);

}  // namespace gloam
