#pragma once
// What a camera does not see of what its own rays meet: nearer than its near plane, of bodies that
// it hides, back faces. Light that has left a surface meets all of it.

#include <vector>

#include "render/kernel/camera.h"

namespace gloam {

struct ViewClip {
  SceneView scene;
  CameraView32 camera;
  float near = 0;                    ///< of its plane; of wide lenses along rays [m]
  bool culls_backs = false;          ///< surfaces seen from behind are passed
  DeviceSpan<const uint8_t> hidden;  ///< by instance; empty = none

  bool is_idle() const { return !(near > 0) && !culls_backs && hidden.empty(); }
  /// The rays that begin at the camera. Others do so by no chance: they begin on surfaces and in
  /// the air.
  MaskLanes from_camera(const RayOf<FloatLanes>& ray, MaskLanes active) const;
  /// Where a ray of the camera begins to see [m].
  float start(const Ray& ray) const;
  /// The `found` lanes whose hit is passed.
  MaskLanes passes(const RayOf<FloatLanes>& ray, const RayHitOf<FloatLanes>& hit,
                   MaskLanes found) const;
};

}  // namespace gloam
