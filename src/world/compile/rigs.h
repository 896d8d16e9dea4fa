#pragma once
// [[stereo]] and [[rgbd]]: rigs become the cameras that they are made of.

#include "gloam/scene.h"

namespace gloam {

/// `scene` with a CameraOptions for every camera of its rigs, and no rigs. Error: a name is taken.
Result<Scene> with_rig_cameras(const Scene& scene);

}  // namespace gloam
