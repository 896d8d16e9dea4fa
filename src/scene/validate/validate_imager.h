#pragma once
// Checks that the fields of a camera's imager and of rigs agree.

#include "gloam/scene.h"

namespace gloam {

Status validate_sensing(const std::string& camera, const CameraSensing& sensing);
Status validate_rigs(const Scene& scene);

}  // namespace gloam
