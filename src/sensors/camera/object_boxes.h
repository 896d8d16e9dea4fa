#pragma once
// Boxes around objects: in the picture and in space.

#include <map>
#include <vector>

#include "gloam/camera.h"
#include "instant/pose_frame.h"
#include "render/film/film.h"
#include "world/render_description.h"

namespace gloam {

/// The objects of which `cover` has a pixel, in the order of their ids. An object's frame O is that
/// of its first body that is drawn: the root of a robot, the world for what is fixed to it.
std::vector<ObjectView> view_objects(const RenderDescription& description, const PoseFrame& frame,
                                     const std::map<uint32_t, ObjectCover>& cover);

}  // namespace gloam
