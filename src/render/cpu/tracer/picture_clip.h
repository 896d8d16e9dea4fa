#pragma once
// The clip of a picture that the CPU traces, and which of its rays it is for.

#include "render/kernel/camera/view_clip.h"

namespace gloam {

struct PictureClip {
  SceneView scene;
  CameraView32 camera;
  ViewClip view;

  /// The rays that begin at the camera. Others do so by no chance: they begin on surfaces and in
  /// the air.
  MaskLanes from_camera(const RayOf<FloatLanes>& ray, MaskLanes active) const;
};

}  // namespace gloam
