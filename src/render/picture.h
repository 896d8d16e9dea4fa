#pragma once
// A picture in the making: its inputs as the stages take them.

#include <vector>

#include "render/cpu/path/tile.h"
#include "render/cpu/tracer/picture_clip.h"

namespace gloam {

/// The inputs that refer to the scene are read again after another sensor has used the renderer.
struct Picture {
  const CameraView& view;
  Job job = {};
  std::vector<CameraKey> camera_keys = {};
  PictureClip clip = {};
  DeviceSpan<const float> levels = {};  ///< of the scene's lights, at the times of the exposure
  AmbientCube ambient = {};             ///< direct tier
  bool flickers = false;
  bool is_guided = false;
};

/// `keys`: scratch for what it refers to.
CameraView32 make_camera(const CameraView& view, std::vector<CameraKey>* keys);
void resize_film(const CameraView& view, const RenderSettings& settings, Film* film);
PictureClip clip_of(const CameraView& view, const SceneView& scene, const CameraView32& camera);

}  // namespace gloam
