#pragma once
// What the fields of a camera's imager and of rigs must agree on.

#include "gloam/scene.h"

namespace gloam {

Status validate_sensing(const std::string& camera, const CameraSensing& sensing);
Status validate_rigs(const Scene& scene);

}  // namespace gloam
