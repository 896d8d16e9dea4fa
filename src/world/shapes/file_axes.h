#pragma once
// Conversion of a model file's axes and units to Gloam's axes and metres.

#include <string>

#include "base/vec.h"
#include "gloam/types.h"

namespace gloam {

/// From the file's content F (geometry/mesh/model_file.h) to what `scale`, `up` and `unit` of a
/// scene's table make of it.
Affine3f file_axes(const Vec3& scale, double unit, const std::string& up, bool was_y_up);

}  // namespace gloam
