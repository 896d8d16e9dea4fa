#pragma once
// Checks that options of [[light]], [sky], [blackout] and [[volume]] go together; ranges are
// checked elsewhere.

#include "gloam/scene.h"

namespace gloam {

Status validate_light(const LightOptions& light);
Status validate_sky(const SkyOptions& sky);
Status validate_blackout(const BlackoutOptions& blackout);
Status validate_volume(const VolumeOptions& volume);

}  // namespace gloam
