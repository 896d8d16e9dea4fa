#include "world/sensors/camera_rate.h"

#include <algorithm>

namespace gloam {

Rational own_camera_rate(const Scene& scene, const std::string& camera) {
  const auto found = std::ranges::find(scene.cameras, camera, &CameraOptions::name);
  return found != scene.cameras.end() ? found->rate : kDefaultCameraRate;
}

}  // namespace gloam
