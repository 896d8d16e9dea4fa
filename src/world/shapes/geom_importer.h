#pragma once
// Geoms of an mjModel as instances of a RenderDescription.

#include <mujoco/mujoco.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "world/materials/visual_material.h"
#include "world/render_description.h"

namespace gloam {

/// Importer of the geoms of one model. Meshes get their rows first and are converted together at
/// the end, in parallel.
class GeomImporter {
 public:
  GeomImporter(const mjModel& model, bool live, RenderDescription* out)
      : model_(model), live_(live), materials_(model, live, out), out_(out) {}

  /// The geom's shape, material and flags; nothing when it cannot be seen.
  std::optional<InstanceDescription> instance(int geom);
  /// Row of the material that a mesh in the geom's place has.
  int mesh_material(int geom) {
    return materials_.row(model_.geom_matid[geom], model_.geom_rgba + 4 * geom, ShapeType::kMesh);
  }
  void convert_meshes();
  MaterialTable& materials() { return materials_; }

 private:
  int mesh_row(int asset, bool is_height_field);

  struct PendingMesh {
    int asset = 0, row = 0, height_field = -1;
  };
  const mjModel& model_;
  const bool live_;
  MaterialTable materials_;
  RenderDescription* out_;
  std::map<std::pair<int, bool>, int> mesh_rows_;
  std::vector<PendingMesh> pending_;
};

}  // namespace gloam
