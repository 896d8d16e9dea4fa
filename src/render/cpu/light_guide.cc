#include "render/cpu/light_guide.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/kernel/light.h"
#include "render/kernel/sampler.h"

namespace gloam {
namespace {

constexpr int kCellsAlong = 16;  // of the longest edge
constexpr int kLightRays = 32;   // to each light from a cell
constexpr int kSkyRays = 192;    // from a cell, all around
constexpr float kFloor = 0.02f;  // share of a light that no ray has seen
constexpr float kWidest = 0.5f;  // 1 - cos: the BSDF finds wider skies itself

/// Rays of one cell, traced a packet at a time.
class Probes {
 public:
  Probes(const SceneView& scene, const EmbreeTracer& tracer) : scene_(scene), tracer_(tracer) {}

  /// Calls seen(i, ray) for each ray of make(i, &ray), i in [0, n), that nothing blocks; rays for
  /// which make returns false are left out.
  template <class Make, class Seen>
  void trace(int n, const Make& make, const Seen& seen) const {
    constexpr int kPacket = EmbreeTracer::kPacket;
    Ray rays[kPacket];
    const Ray* pointers[kPacket];
    RayHit hits[kPacket];
    bool found[kPacket];
    int which[kPacket], used = 0;
    const auto flush = [&] {
      if (used > 0) tracer_.trace_packet(pointers, used, true, false, hits, found);
      for (int j = 0; j < used; ++j) {
        if (!found[j] || (scene_.has_transparent && passes(rays[j]))) seen(which[j], rays[j]);
      }
      used = 0;
    };
    for (int i = 0; i < n; ++i) {
      rays[used] = {};
      if (!make(i, &rays[used])) continue;
      pointers[used] = &rays[used];
      which[used++] = i;
      if (used == kPacket) flush();
    }
    flush();
  }

 private:
  /// Whether all that is in the way may let light through.
  bool passes(Ray ray) const {
    constexpr int kMost = 8;
    for (int i = 0; i < kMost; ++i) {
      RayHit hit;
      if (!tracer_.trace(ray, false, &hit)) return true;
      if (!scene_.materials[scene_.instances[hit.instance].material].transparent) return false;
      const float step = hit.t + surface_step(ray.o, hit.t);
      ray.o = ray.o + ray.d * step;
      ray.tmax -= step;
      if (ray.tmax <= 0) return true;
    }
    return false;
  }

  const SceneView& scene_;
  const EmbreeTracer& tracer_;
};

Sampler sampler_of(int cell, int ray) {
  return Sampler::make(0, 0, static_cast<uint32_t>(cell) & 0xFFFFu,
                       static_cast<uint32_t>(cell) >> 16, static_cast<uint32_t>(ray), 9);
}

Vec3f next_3d(Sampler* sampler) {
  const Vec2f a = sampler->next_2d();
  return {a.x, a.y, sampler->next_1d()};
}

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

/// A box that holds most of the geoms: a lawn around a house must not make its cells coarse.
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

Vec3f LightGuideStore::point_in(int cell, Vec3f u) const {
  const int x = cell % grid_.nx, y = cell / grid_.nx % grid_.ny, z = cell / (grid_.nx * grid_.ny);
  const Vec3f q{static_cast<float>(x) + u.x, static_cast<float>(y) + u.y,
                static_cast<float>(z) + u.z};
  return grid_.low + q * (1.0f / grid_.per_metre);
}

void LightGuideStore::look_for_lights(const SceneView& scene, const EmbreeTracer& statics,
                                      int cell) {
  for (uint32_t light = 0; light < grid_.rows; ++light) {
    int seen = 0;
    Probes(scene, statics)
        .trace(
            kLightRays,
            [&](int i, Ray* ray) {
              Sampler sampler = sampler_of(cell, i);
              ray->o = point_in(cell, next_3d(&sampler));
              const float pick = sampler.next_1d();
              const LightSample sample =
                  sample_one_light(scene, light, ray->o, pick, sampler.next_2d(), 0.0f);
              if (!(sample.pdf > 0)) return false;
              const Vec3f to = sample.wi * sample.distance + sample.lift;
              ray->d = normalize(to);
              ray->tmax = length(to) * 0.9999f;
              return true;
            },
            [&seen](int, const Ray&) { ++seen; });
    seen_[static_cast<size_t>(cell) * grid_.rows + light] = static_cast<float>(seen) / kLightRays;
  }
}

void LightGuideStore::look_for_sky(const SceneView& scene, const EmbreeTracer& statics, int cell) {
  Probes(scene, statics)
      .trace(
          kSkyRays,
          [&](int i, Ray* ray) {
            Sampler sampler = sampler_of(cell, i);
            ray->o = point_in(cell, next_3d(&sampler));
            ray->d = sample_sphere(sampler.next_2d());
            return true;
          },
          [&](int, const Ray& ray) {
            const float light = luminance(sky_radiance(scene, ray.d, 0.1f) + scene.sky_ambient);
            if (light > 0) sky_rays_[static_cast<size_t>(cell)].push_back({ray.d, light});
          });
}

int LightGuideStore::neighborhood(int cell, int* cells) const {
  const int n[3] = {grid_.nx, grid_.ny, grid_.nz}, stride[3] = {1, n[0], n[0] * n[1]};
  int count = 0;
  cells[count++] = cell;
  for (int k = 0; k < 3; ++k) {
    const int at = cell / stride[k] % n[k];
    if (at > 0) cells[count++] = cell - stride[k];
    if (at + 1 < n[k]) cells[count++] = cell + stride[k];
  }
  return count;
}

void LightGuideStore::conclude(int cell) {
  int cells[7];
  const int count = neighborhood(cell, cells);
  for (uint32_t light = 0; light < grid_.rows; ++light) {
    const auto seen = [&](int c) { return seen_[static_cast<size_t>(c) * grid_.rows + light]; };
    float around = 0;
    for (int i = 1; i < count; ++i) around += seen(cells[i]) / static_cast<float>(count - 1);
    const float share = count > 1 ? 0.5f * (seen(cell) + around) : seen(cell);
    visible_[static_cast<size_t>(cell) * grid_.rows + light] = kFloor + (1.0f - kFloor) * share;
  }
  Vec3f sum;
  float light = 0;
  size_t rays = 0;
  for (int i = 0; i < count; ++i) {
    for (const SkyRay& ray : sky_rays_[static_cast<size_t>(cells[i])]) {
      sum += ray.d;
      light += ray.luminance;
      ++rays;
    }
  }
  constexpr size_t kFewest = 3;
  if (rays < kFewest || !(length_squared(sum) > 0)) return;
  SkyCone cone;
  cone.axis = normalize(sum);
  for (int i = 0; i < count; ++i) {
    for (const SkyRay& ray : sky_rays_[static_cast<size_t>(cells[i])]) {
      cone.one_minus_cos = max(cone.one_minus_cos, 1.0f - dot(cone.axis, ray.d));
    }
  }
  // The outermost of a few directions lies well inside the opening.
  cone.one_minus_cos = cone.one_minus_cos * (1.0f + 1.0f / static_cast<float>(rays)) + 1e-3f;
  if (cone.one_minus_cos > kWidest) return;
  cone.strength = light * (4 * kPi / static_cast<float>(kSkyRays * count));
  sky_[static_cast<size_t>(cell)] = cone;
}

void LightGuideStore::build(SceneView scene, const EmbreeTracer& statics,
                            const std::vector<LightView>& lights) {
  grid_ = {};
  const bool has_sky = scene.sky_texture >= 0 || luminance(scene.sky_ambient) > 0;
  if (statics.fixed == nullptr || lights.size() > kMaxWeighedLights ||
      lights.size() + (has_sky ? 1 : 0) < 2) {
    return;
  }
  Vec3f low, size;
  find_crowd(scene,
             {statics.rows.data + statics.first_fixed, statics.rows.size - statics.first_fixed},
             &low, &size);
  const float longest = max_component(size);
  if (!(longest > 0 && longest < 1e6f)) return;
  grid_.low = low;
  grid_.per_metre = kCellsAlong / (longest * 1.0001f);
  const auto cells = [this](float edge) {
    return std::max(1, static_cast<int>(std::ceil(edge * grid_.per_metre)));
  };
  grid_.nx = cells(size.x);
  grid_.ny = cells(size.y);
  grid_.nz = cells(size.z);
  grid_.rows = static_cast<uint32_t>(lights.size());
  const int count = grid_.nx * grid_.ny * grid_.nz;
  visible_.resize(static_cast<size_t>(count) * grid_.rows);
  seen_.resize(visible_.size());
  sky_rays_.resize(static_cast<size_t>(count));
  sky_.assign(static_cast<size_t>(count), {});
  scene.lights = {lights.data(), grid_.rows};
  parallel_for("light guide", count, [&](int64_t cell) {
    look_for_lights(scene, statics, static_cast<int>(cell));
    if (has_sky) look_for_sky(scene, statics, static_cast<int>(cell));
  });
  parallel_for("light guide cells", count, [&](int64_t cell) { conclude(static_cast<int>(cell)); });
  seen_ = {};
  sky_rays_ = {};
}

LightGuide LightGuideStore::view() const {
  LightGuide guide = grid_;
  guide.visible = {visible_.data(), static_cast<uint32_t>(visible_.size())};
  guide.sky = {sky_.data(), static_cast<uint32_t>(sky_.size())};
  return guide;
}

}  // namespace gloam
