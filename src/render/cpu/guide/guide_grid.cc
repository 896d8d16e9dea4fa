#include "render/cpu/guide/guide_grid.h"

#include <algorithm>

namespace gloam {
namespace {

/// Box around an instance in the world.
void add_bounds(const SceneView& scene, const InstanceView& instance, Vec3f* low, Vec3f* high) {
  const auto add = [&](Vec3f p_G) {
    const Vec3f p = transform_point(instance.X_WG, p_G);
    *low = {min(low->x, p.x), min(low->y, p.y), min(low->z, p.z)};
    *high = {max(high->x, p.x), max(high->y, p.y), max(high->z, p.z)};
  };
  if (instance.shape == ShapeType::kMesh) {
    const MeshView& mesh = scene.meshes[instance.mesh];
    for (uint32_t i = 0; i < mesh.positions.size; ++i) add(mesh.positions[i]);
    return;
  }
  Vec3f h = shape_half_size(instance.shape, instance.size);
  if (instance.shape == ShapeType::kCapsule) h.z += instance.size.x;
  for (int i = 0; i < 8; ++i) {
    add({(i & 1) != 0 ? h.x : -h.x, (i & 2) != 0 ? h.y : -h.y, (i & 4) != 0 ? h.z : -h.z});
  }
}

/// A box that holds most of the geoms, with a margin.
void find_crowd(const SceneView& scene, DeviceSpan<const uint32_t> rows, Vec3f* low, Vec3f* size) {
  constexpr double kOutside = 0.05;
  constexpr float kMargin = 0.15f;  // of the size, on each side
  std::vector<float> lows[3], highs[3];
  for (uint32_t i = 0; i < rows.size; ++i) {
    Vec3f a{1e30f, 1e30f, 1e30f}, b = a * -1.0f;
    add_bounds(scene, scene.instances[rows[i]], &a, &b);
    for (int k = 0; k < 3; ++k) {
      lows[k].push_back(a[k]);
      highs[k].push_back(b[k]);
    }
  }
  const auto outside = static_cast<std::ptrdiff_t>(kOutside * static_cast<double>(rows.size));
  float from[3], length[3];
  for (int k = 0; k < 3; ++k) {
    std::nth_element(lows[k].begin(), lows[k].begin() + outside, lows[k].end());
    std::nth_element(highs[k].begin(), highs[k].end() - 1 - outside, highs[k].end());
    const float inner = lows[k][outside], edge = *(highs[k].end() - 1 - outside) - inner;
    from[k] = inner - kMargin * edge;
    length[k] = (1 + 2 * kMargin) * edge;
  }
  *low = {from[0], from[1], from[2]};
  *size = {length[0], length[1], length[2]};
}

}  // namespace

LightGuide place_guide_grid(const SceneView& scene, DeviceSpan<const uint32_t> rows, int along) {
  LightGuide grid;
  Vec3f size;
  find_crowd(scene, rows, &grid.low, &size);
  const float longest = max_component(size);
  if (!(longest > 0 && longest < 1e6f)) return grid;
  grid.per_metre = static_cast<float>(along) / (longest * 1.0001f);
  const auto cells = [&grid](float edge) {
    return std::max(1, static_cast<int>(std::ceil(edge * grid.per_metre)));
  };
  grid.nx = cells(size.x);
  grid.ny = cells(size.y);
  grid.nz = cells(size.z);
  return grid;
}

Vec3f point_in_cell(const LightGuide& grid, int cell, Vec3f u) {
  const int x = cell % grid.nx, y = cell / grid.nx % grid.ny, z = cell / (grid.nx * grid.ny);
  const Vec3f q{static_cast<float>(x) + u.x, static_cast<float>(y) + u.y,
                static_cast<float>(z) + u.z};
  return grid.low + q * (1.0f / grid.per_metre);
}

SurfacePoint start_of(const LightGuide& grid, const GuideRow& row, int ray, Sampler* sampler) {
  const Vec3f u = next_3d(sampler);
  if (row.facing < 0) return {point_in_cell(grid, row.cell, u), {0, 0, 0}};
  return row.points[static_cast<size_t>(ray) % row.points.size()];
}

std::vector<SurfacePoint> find_surface(const SceneView& scene, const CpuTracer& statics,
                                       const LightGuide& grid, int cell, int facing) {
  constexpr int kRays = 16, kLayers = 4;
  const int axis = facing / 2;
  const bool up = facing % 2 == 0;
  const Vec3f along{axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f};
  std::vector<SurfacePoint> points;
  for (int i = 0; i < kRays; ++i) {
    Sampler sampler = guide_sampler(cell, i, 1);
    const Vec3f u = next_3d(&sampler), face = u * (Vec3f{1, 1, 1} - along);
    Ray ray;
    ray.o = point_in_cell(grid, cell, up ? face + along : face);
    ray.d = up ? -along : along;
    ray.tmax = 1.0f / grid.per_metre;
    for (int layer = 0; layer < kLayers && ray.tmax > 0; ++layer) {
      RayHit hit;
      if (!statics.trace(ray, false, &hit)) break;
      const Surface s = make_surface(scene, ray, hit, {});
      if (s.outside && LightGuide::facing_of(s.geometric) == static_cast<uint32_t>(facing)) {
        points.push_back({leave_surface(s.p, s.geometric, s.geometric, s.t), s.geometric});
      }
      ray.o = leave_surface(s.p, s.geometric, ray.d, hit.t);
      ray.tmax -= hit.t;
    }
  }
  return points;
}

int neighborhood(const LightGuide& grid, const std::vector<GuideRow>& rows, int row, int* out) {
  const int cell = rows[static_cast<size_t>(row)].cell;
  const int facing = rows[static_cast<size_t>(row)].facing;
  const int n[3] = {grid.nx, grid.ny, grid.nz}, stride[3] = {1, n[0], n[0] * n[1]};
  int count = 0;
  out[count++] = row;
  const auto add = [&](int other) {
    const int found =
        facing < 0
            ? other
            : static_cast<int>(
                  grid.surface_row[static_cast<uint32_t>(LightGuide::kFacings * other + facing)]);
    if (found >= 0) out[count++] = found;
  };
  for (int k = 0; k < 3; ++k) {
    const int at = cell / stride[k] % n[k];
    if (at > 0) add(cell - stride[k]);
    if (at + 1 < n[k]) add(cell + stride[k]);
  }
  return count;
}

Sampler guide_sampler(int row, int ray, uint32_t purpose) {
  return Sampler::make(0, purpose, static_cast<uint32_t>(row) & 0xFFFFu,
                       static_cast<uint32_t>(row) >> 16, static_cast<uint32_t>(ray), 9);
}

}  // namespace gloam
