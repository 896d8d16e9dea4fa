#pragma once
// [[camera]].lens: from what is written to intrinsics.

#include "gloam/camera.h"
#include "gloam/scene.h"

namespace gloam {

/// Checks that options of a lens go together; ranges are checked elsewhere.
Status validate_lens(const CameraOptions& camera);

/// Puts the camera's lens, if it has one, over intrinsics of its picture's size. Errors: a
/// distortion that folds within the picture.
Status apply_lens(const CameraOptions& camera, Intrinsics* intrinsics);

}  // namespace gloam
