#pragma once
// The free camera's place where it shows a model: a three-quarter view from above that what is
// drawn fills.

#include <span>

#include "world/render_description.h"
#include "world/shapes/drawn_points.h"

namespace gloam {

/// Direction of a free camera, as MuJoCo measures it [rad]: azimuth of the axis about Z from +X,
/// elevation above the horizon.
struct ViewDirection {
  float azimuth = 0, elevation = 0;
};

/// Places `camera` so that the points of `subject` take up most of its picture. An orthographic
/// one gets the height that shows them. Without points nothing changes. What is tall and thin is
/// seen from higher up, up to `steepest` [rad], which makes it shorter and so larger; what would
/// cover more than half of the picture from further away.
void frame_subject(std::span<const DrawnPart> subject, ViewDirection direction, float steepest,
                   CameraDescription* camera);

}  // namespace gloam
