#pragma once
// [[visual]] tables: model files that are drawn and not simulated.

#include <functional>
#include <vector>

#include "world/lights/visual_light.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {

/// Puts an instance on a body into the description and labels it. `name` = its own; `visual` =
/// index and name of the [[visual]] that it is a part of.
using AddVisualPart = std::function<void(InstanceDescription instance, int body, std::string name,
                                         int visual, const std::string& visual_name)>;

/// The file's content F, in Gloam's axes, in the body B.
Affine3f visual_placement(const VisualOptions& visual, bool was_y_up);

/// Adds what draws `user`, "object 'crate'", unless it is there: a compiled Scene has it. Error:
/// another visual of that name.
Status add_visual_of(const std::string& user, VisualOptions visual, Scene* scene);

/// Reads the scene's visuals, by way of the cache on disk, and adds their meshes, textures,
/// materials, instances and lights. `poses` = X_WB at qpos0. Errors: no such body or node, a
/// file that cannot be read.
Status describe_visuals(const CompiledWorld& world, const std::vector<Affine3f>& poses,
                        const AddVisualPart& add, LightLevels* levels, RenderDescription* out);

/// Puts an instance of a mesh of CompiledWorld::visual_meshes on a body; `index` = its row in
/// visual_only.
using AddMeshPart = std::function<void(InstanceDescription instance, int body, int index)>;

/// A mesh of a URDF, and the material of those of its parts that have none of their own.
struct DrawnMesh {
  int index = 0;  ///< row of visual_only
  int material = 0;
};

/// Describes the meshes of URDF visuals in the same way. A file that is missing by now is reported
/// and never an error.
Status describe_model_meshes(const CompiledWorld& world, const std::vector<DrawnMesh>& meshes,
                             const std::vector<Affine3f>& poses, const AddMeshPart& add,
                             RenderDescription* out);

/// Triangles of the scene's visuals, of all instances; files that cannot be read have none.
int64_t count_visual_triangles(const CompiledWorld& world);

}  // namespace gloam
