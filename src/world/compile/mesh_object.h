#pragma once
// [[object]]s, and places that come from a mesh file: a static object for each node.

#include <string>
#include <vector>

#include "geometry/convert/convert.h"
#include "gloam/model_tools.h"
#include "world/compile/level.h"

namespace gloam {

/// In messages.
inline std::string title(const ObjectOptions& o) { return "object '" + o.name + "'"; }

/// An object that is to be a body. Its frame is the file's, in Gloam's axes and metres.
struct MeshObject {
  ObjectOptions options;  ///< its name is no other's
  TriangleMesh mesh;      ///< mesh of its node or of the whole file, in the body's frame
  bool is_place = false;  ///< a node of [environment], which may be a room
};

struct MeshObjects {
  std::vector<MeshObject> objects;
  std::vector<Error> notes;  ///< names that were changed, sizes that are odd
  uint64_t hash = 0;         ///< hash of all that physics uses of them; 0 = there are none
};

/// Reads their files, by way of the cache on disk. Errors: a file that cannot be read, no such
/// node, nothing in it, names that clash where they must not; it was cancelled.
Result<MeshObjects> load_mesh_objects(const Scene& scene, CompileProgress* progress = nullptr);

/// Adds a [[visual]] for each. Errors: the scene has a visual of that name.
Status add_object_visuals(const MeshObjects& objects, Scene* scene);

/// Converts them (geometry/convert), several at a time. Their meshes are not kept. Errors:
/// convert_mesh's, of the first that fails.
Result<std::vector<Converted>> convert_objects(const MeshObjects& objects,
                                               CompileProgress* progress = nullptr);

/// Adds a body for each, with its colliders in group 3. Oddities of the meshes are reported in
/// `notes`. Errors: names that the spec has, what is too light to move.
Status add_objects(const MeshObjects& objects, const std::vector<Converted>& converted,
                   mjSpec* spec, std::vector<Error>* notes);

}  // namespace gloam
