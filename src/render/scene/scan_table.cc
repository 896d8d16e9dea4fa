#include "render/scene/scan_table.h"

#include <algorithm>

#include "render/kernel/surface/shapes.h"
#include "render/scene/span_of.h"

namespace gloam {
namespace {

bool lies_along_axes(const Affine3f& X) {
  const auto is_axis = [](Vec3f v) {
    return max_component(Vec3f{fabsf(v.x), fabsf(v.y), fabsf(v.z)}) > 1 - 1e-6f &&
           fabsf(v.x) + fabsf(v.y) + fabsf(v.z) < 1 + 1e-6f;
  };
  return is_axis(X.x) && is_axis(X.y) && is_axis(X.z);
}

/// Solids that are scanned together.
struct Cluster {
  BvhBox box;
  std::vector<ScannedSolid> solids;
};

/// Boxes that a packet of rays is tested against for `count` solids in `box`, on average, in a
/// scene with a surface of `scene` times two: the box, and all solids where any ray meets it. Rays
/// of a packet go different ways, but not quite: they count as eight.
float tests(const BvhBox& box, size_t count, float scene) {
  if (count == 1) return 1;
  const float missed = max(1 - box.area() / scene, 0.0f);  // by one ray
  return 1 + static_cast<float>(count) * (1 - sqr(sqr(sqr(missed))));
}

/// Unites the two clusters that save the most tests as long as any do. There are few solids.
void unite(std::vector<Cluster>* clusters) {
  BvhBox scene;
  for (const Cluster& cluster : *clusters) scene.add(cluster.box);
  const float area = max(scene.area(), 1e-30f);
  const auto tests_of = [&](const Cluster& c) { return tests(c.box, c.solids.size(), area); };
  for (;;) {
    float most = 0;
    Cluster *into = nullptr, *from = nullptr;
    for (Cluster& a : *clusters) {
      for (Cluster* b = &a + 1; b != clusters->data() + clusters->size(); ++b) {
        BvhBox both = a.box;
        both.add(b->box);
        const float saved =
            tests_of(a) + tests_of(*b) - tests(both, a.solids.size() + b->solids.size(), area);
        if (saved > most) most = saved, into = &a, from = b;
      }
    }
    if (into == nullptr) return;
    into->box.add(from->box);
    into->solids.insert(into->solids.end(), from->solids.begin(), from->solids.end());
    clusters->erase(clusters->begin() + (from - clusters->data()));
  }
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
  const Vec3f margin = (b.high - b.low) * 1e-5f + Vec3f{1e-6f, 1e-6f, 1e-6f};
  return {b.low - margin, b.high + margin};
}

ScanTable ScanTable::choose(const RenderScene& scene, size_t most, float least_fraction) {
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
  std::vector<Cluster> clusters;
  for (const auto& [area, row] : by_area) {
    if (area > least_fraction * by_area.front().first) break;  // they are negative
    const InstanceView& in = instances[row];
    const Bounds bounds = shape_bounds(in.shape, in.size, in.X_WG);
    const bool is_bounds = in.shape == ShapeType::kBox && lies_along_axes(in.X_WG);
    const ScannedSolid solid{is_bounds ? bounds : wider(bounds), is_bounds, row};
    clusters.push_back({as_box(solid.bounds), {solid}});
  }
  unite(&clusters);
  for (const Cluster& cluster : clusters) {
    table.groups.push_back({{cluster.box.low, cluster.box.high},
                            static_cast<uint32_t>(table.solids.size()),
                            static_cast<uint32_t>(cluster.solids.size())});
    table.solids.insert(table.solids.end(), cluster.solids.begin(), cluster.solids.end());
  }
  return table;
}

bool ScanTable::holds(size_t instance) const {
  return std::any_of(solids.begin(), solids.end(),
                     [&](const ScannedSolid& solid) { return solid.row == instance; });
}

ScanList ScanTable::list(const RenderScene& scene) const {
  return {span_of(planes), span_of(solids), span_of(groups), span_of(scene.instances())};
}

}  // namespace gloam
