#pragma once
// Cameras of a model, in pixels.

#include <mujoco/mujoco.h>

#include "gloam/scene.h"
#include "world/render_description.h"
#include "world/view/free_view.h"

namespace gloam {

/// Region that the free camera looks at.
struct Framing {
  Vec3 center;        ///< [m]
  double extent = 1;  ///< about the diameter [m]
};

/// A name for camera `id`: its own, or "camera_ID" when the model gives none.
std::string camera_name(const mjModel& model, int id);

/// Lenses and shutters that the scene gives to cameras. Errors: a lens that cannot be right.
Status set_optics(const Scene& scene, std::vector<CameraDescription>* cameras);

/// Near planes, back faces and hidden bodies. Those of bare models see as MuJoCo's renderer shows
/// them. Instances and cameras are all there. Errors: no such body.
Status set_clips(const CompiledWorld& world, RenderDescription* out);
/// The direction in which the free camera shows a model: a three-quarter view from above, or the
/// azimuth and elevation that the model gives in <visual><global>.
ViewDirection free_direction(const mjModel& model);

/// Elevation to which a view may be steepened [rad]: its own where the model gives one.
float steepest_elevation(const mjModel& model);

/// All cameras of the model, then the free camera "free" as MuJoCo's viewer first shows it.
void describe_cameras(const mjModel& model, const Framing& framing, RenderDescription* out);

}  // namespace gloam
