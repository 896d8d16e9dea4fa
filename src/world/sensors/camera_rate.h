#pragma once
// Rate of cameras' pictures.

#include <string>

#include "gloam/scene.h"

namespace gloam {

inline constexpr Rational kDefaultCameraRate{20, 1};  ///< rate of cameras that give none [Hz]

/// The rate that the scene gives a camera, else the usual one.
Rational own_camera_rate(const Scene& scene, const std::string& camera);

}  // namespace gloam
