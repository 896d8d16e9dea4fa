#include "render/scene/patterns/pattern_surface.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "render/scene/patterns/shape_mesh.h"
#include "render/scene/pose.h"

namespace gloam {
namespace {

/// Equal for surfaces whose tiles are equal.
using SurfaceKey = std::tuple<int, ShapeType, int, float, float, float, int>;

class Collector {
 public:
  Collector(const RenderDescription& description, const PoseFrame& frame)
      : description_(description), frame_(frame), is_sheet_(description.meshes.size()) {
    for (const HeightFieldDescription& field : description.height_fields)
      is_sheet_[static_cast<size_t>(field.mesh)] = true;
  }

  int add(size_t instance, int pattern) {
    if (pattern < 0) return -1;
    const InstanceDescription& in = description_.instances[instance];
    const auto& d = description_.procedurals[static_cast<size_t>(pattern)];
    const bool has_place = in.is_static && d.kind == ProceduralKind::kDirt;
    const bool is_mesh = in.shape == ShapeType::kMesh || in.shape == ShapeType::kDeformable;
    const Vec3f size = is_mesh ? Vec3f{} : in.size;
    const SurfaceKey key{pattern,
                         in.shape,
                         is_mesh ? in.mesh : -1,
                         size.x,
                         size.y,
                         size.z,
                         has_place ? static_cast<int>(instance) : -1};
    const auto [at, is_new] = rows_.try_emplace(key, static_cast<int>(out.surfaces.size()));
    if (!is_new) return at->second;
    PatternSurface surface;
    surface.pattern = &d;
    surface.shape = in.shape;
    surface.size = size;
    surface.has_place = has_place;
    if (has_place) surface.X_WG = pose_in_world(description_, frame_, in);
    surface.mesh = mesh_of(in);
    surface.is_sheet = in.shape == ShapeType::kMesh && is_sheet_[static_cast<size_t>(in.mesh)];
    measure(&surface);
    out.surfaces.push_back(surface);
    return at->second;
  }

  PatternSurfaces out;

 private:
  const TriangleMesh* mesh_of(const InstanceDescription& in) {
    const auto row = static_cast<size_t>(in.mesh);
    if (in.shape == ShapeType::kMesh) return &description_.meshes[row];
    if (in.shape == ShapeType::kDeformable) return &description_.deformables[row].rest;
    // Beyond the horizon of an infinite plane the mean of its pattern is left.
    const float horizon = std::max(4 * description_.extent, 50.0f);
    out.shapes.push_back(shape_mesh(in.shape, in.size, horizon));
    return &out.shapes.back();
  }

  static void measure(PatternSurface* surface) {
    const TriangleMesh& mesh = *surface->mesh;
    surface->low = surface->high = mesh.positions.empty() ? Vec3f{} : mesh.positions[0];
    const auto extend = [](Vec3f a, Vec3f b, auto f) {
      return Vec3f{f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
    };
    for (const Vec3f& p : mesh.positions) {
      surface->low = extend(surface->low, p, [](float a, float b) { return min(a, b); });
      surface->high = extend(surface->high, p, [](float a, float b) { return max(a, b); });
    }
    double twice = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const Vec3f a = mesh.positions[mesh.indices[i]];
      twice += length(
          cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a));
    }
    surface->area = static_cast<float>(0.5 * twice);
  }

  const RenderDescription& description_;
  const PoseFrame& frame_;
  std::vector<bool> is_sheet_;  ///< by mesh
  std::map<SurfaceKey, int> rows_;
};

}  // namespace

PatternSurfaces collect_pattern_surfaces(const RenderDescription& description,
                                         const PoseFrame& frame) {
  Collector collector(description, frame);
  for (size_t i = 0; i < description.instances.size(); ++i) {
    const InstanceDescription& in = description.instances[i];
    const MaterialDescription& m = description.materials[static_cast<size_t>(in.material)];
    InstancePatterns rows;
    if (in.shown) rows = {collector.add(i, m.pattern), collector.add(i, m.wear)};
    collector.out.instances.push_back(rows);
  }
  return std::move(collector.out);
}

}  // namespace gloam
