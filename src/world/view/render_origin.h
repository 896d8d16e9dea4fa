#pragma once
// The render scene's origin. Renderers count in floats, whose step is 6 cm at 10^6 m (map
// coordinates): far from the world's origin pictures and scans are made about a point near what is
// drawn, and told in world coordinates.

#include <memory>

#include "world/world.h"

namespace gloam {

/// Origin of the render scene of a World, in world axes [m]: zero where the bodies are within
/// kFarFromOrigin of the world's, else the median place of the geoms at the start, rounded. Scenes
/// with media, weather, water, soil or agents keep the world's origin, and a note says so.
Vec3 choose_render_origin(const CompiledWorld& world, std::vector<Error>* notes);

inline constexpr double kFarFromOrigin = 4096;  ///< [m] floats step by 0.5 mm there

inline bool is_zero(const Vec3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

/// Moves what is fixed to the world, and the start of what floats, by -origin.
void move_model(const Vec3& origin, mjModel* model);

/// Moves what floats and mocap bodies by -origin, in a state of the model that was moved.
void move_state(const mjModel& model, const Vec3& origin, mjData* data);

/// The World as it is described for rendering about its render origin: model and authored places.
Result<std::unique_ptr<CompiledWorld>> moved_world(const CompiledWorld& world);

}  // namespace gloam
