#include "world/materials/visual_surface.h"

#include <utility>

namespace gloam {

void add_grid_triangles(int columns, TriangleMesh* mesh) {
  const auto row = static_cast<uint32_t>(columns);
  const auto rows = static_cast<uint32_t>(mesh->positions.size()) / row;
  for (uint32_t j = 0; j + 1 < rows; ++j) {
    for (uint32_t i = 0; i + 1 < row; ++i) {
      const uint32_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
      mesh->indices.insert(mesh->indices.end(), {a, b, d, a, d, c});
    }
  }
}

void author_surface(const SurfaceName& of, MaterialDescription material, TriangleMesh mesh,
                    int first_vertex, LabelTable* labels, RenderDescription* out) {
  InstanceDescription instance;
  instance.shape = ShapeType::kDeformable;
  instance.mesh = static_cast<int>(out->deformables.size());
  instance.size = {1, 1, 1};
  instance.material = static_cast<int>(out->materials.size());
  instance.label = labels->label(0, of.name, of.kind, of.index);
  instance.label.geom = of.name;
  instance.label.material = of.name;
  instance.label.part = static_cast<uint32_t>(out->instances.size()) + 1;
  out->materials.push_back(std::move(material));
  out->deformables.push_back({std::move(mesh), first_vertex});
  out->instances.push_back(std::move(instance));
}

}  // namespace gloam
