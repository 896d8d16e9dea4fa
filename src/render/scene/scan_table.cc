#include "render/scene/scan_table.h"

#include <algorithm>

#include "render/kernel/shapes.h"

namespace gloam {
namespace {

bool lies_along_axes(const Affine3f& X) {
  const auto is_axis = [](Vec3f v) {
    return max_component(Vec3f{fabsf(v.x), fabsf(v.y), fabsf(v.z)}) > 1 - 1e-6f &&
           fabsf(v.x) + fabsf(v.y) + fabsf(v.z) < 1 + 1e-6f;
  };
  return is_axis(X.x) && is_axis(X.y) && is_axis(X.z);
}

template <class T>
DeviceSpan<const T> span_of(const std::vector<T>& v) {
  return {v.data(), static_cast<uint32_t>(v.size())};
}

}  // namespace

bool is_infinite_plane(const InstanceView& instance) {
  return instance.shape == ShapeType::kPlane && (instance.size.x <= 0 || instance.size.y <= 0);
}

bool stands_still(const RenderScene& scene, size_t instance) {
  const InstanceView& in = scene.instances()[instance];
  return scene.is_fixed(instance) && scene.is_drawn(instance) &&
         in.shape != ShapeType::kDeformable && !is_infinite_plane(in);
}

Bounds shape_bounds(ShapeType shape, Vec3f size, const Affine3f& X) {
  Vec3f h = shape_half_size(shape, size);
  if (shape == ShapeType::kCapsule) h.z += size.x;
  if (shape == ShapeType::kPlane) h.z = 0;
  const auto reach = [&](float x, float y, float z) {
    return fabsf(x) * h.x + fabsf(y) * h.y + fabsf(z) * h.z;
  };
  const Vec3f r{reach(X.x.x, X.y.x, X.z.x), reach(X.x.y, X.y.y, X.z.y), reach(X.x.z, X.y.z, X.z.z)};
  return {X.p - r, X.p + r};
}

Bounds wider(const Bounds& b) {
  const Vec3f room = (b.high - b.low) * 1e-5f + Vec3f{1e-6f, 1e-6f, 1e-6f};
  return {b.low - room, b.high + room};
}

ScanTable ScanTable::choose(const RenderScene& scene, size_t most, float least_share) {
  ScanTable table;
  const std::vector<InstanceView>& instances = scene.instances();
  std::vector<std::pair<float, uint32_t>> by_area;
  for (size_t i = 0; i < instances.size(); ++i) {
    const InstanceView& in = instances[i];
    if (is_infinite_plane(in) && scene.is_drawn(i)) {
      table.planes.push_back(static_cast<uint32_t>(i));
    }
    if (!stands_still(scene, i) || is_mesh(in.shape)) continue;
    by_area.push_back({-shape_area(in.shape, in.size), static_cast<uint32_t>(i)});
  }
  std::sort(by_area.begin(), by_area.end());
  by_area.resize(std::min(by_area.size(), most));
  for (const auto& [area, row] : by_area) {
    if (area > least_share * by_area.front().first) break;  // they are negative
    const InstanceView& in = instances[row];
    const Bounds bounds = shape_bounds(in.shape, in.size, in.X_WG);
    const bool is_bounds = in.shape == ShapeType::kBox && lies_along_axes(in.X_WG);
    table.solids.push_back({is_bounds ? bounds : wider(bounds), is_bounds, row});
  }
  return table;
}

bool ScanTable::holds(size_t instance) const {
  return std::any_of(solids.begin(), solids.end(),
                     [&](const ScannedSolid& solid) { return solid.row == instance; });
}

ScanList ScanTable::list(const RenderScene& scene) const {
  return {span_of(planes), span_of(solids), span_of(scene.instances())};
}

}  // namespace gloam
