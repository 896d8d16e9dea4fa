#include "render/cpu/light_guide.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/kernel/light_picker.h"

namespace gloam {
namespace {

constexpr int kCellsAlong = 16;   // of the longest edge
constexpr int kLightRays = 32;    // to each light from a cell
constexpr int kSkyRays = 192;     // from a cell, all around
constexpr float kFloor = 0.002f;  // share of a light that no ray has seen
constexpr int kFacings = LightGuide::kFacings;
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

}  // namespace

SurfacePoint LightGuideStore::start_of(const Row& row, int ray, Sampler* sampler) const {
  const Vec3f u = next_3d(sampler);
  if (row.facing < 0) return {point_in_cell(grid_, row.cell, u), {0, 0, 0}};
  return row.points[static_cast<size_t>(ray) % row.points.size()];
}

void LightGuideStore::find_rows(const SceneView& scene, const EmbreeTracer& statics) {
  const int cells = grid_.nx * grid_.ny * grid_.nz;
  std::vector<Row> surfaces(static_cast<size_t>(cells) * kFacings);
  parallel_for("light guide surfaces", cells, [&](int64_t cell) {
    for (int facing = 0; facing < kFacings; ++facing) {
      const int c = static_cast<int>(cell);
      surfaces[static_cast<size_t>(cell * kFacings + facing)] = {
          c, facing, find_surface(scene, statics, grid_, c, facing)};
    }
  });
  rows_.clear();
  for (int cell = 0; cell < cells; ++cell) rows_.push_back({cell, -1, {}});
  surface_row_.assign(surfaces.size(), -1);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].points.empty()) continue;
    surface_row_[i] = static_cast<int>(rows_.size());
    rows_.push_back(std::move(surfaces[i]));
  }
}

void LightGuideStore::look_for_lights(const SceneView& scene, const EmbreeTracer& statics,
                                      int row) {
  const Row& from = rows_[static_cast<size_t>(row)];
  for (uint32_t light = 0; light < grid_.lights; ++light) {
    int seen = 0, sent = 0;
    Probes(scene, statics)
        .trace(
            kLightRays,
            [&](int i, Ray* ray) {
              Sampler sampler = guide_sampler(row, i, 0);
              const SurfacePoint start = start_of(from, i, &sampler);
              ray->o = start.p;
              const float pick = sampler.next_1d();
              const LightSample sample =
                  sample_one_light(scene, light, ray->o, pick, sampler.next_2d(), 0.0f);
              const bool is_behind = from.facing >= 0 && dot(sample.wi, start.n) <= 0;
              if (!(sample.pdf > 0) || is_behind) return false;
              ++sent;
              const Vec3f to = sample.wi * sample.distance + sample.lift;
              ray->d = normalize(to);
              ray->tmax = length(to) * 0.9999f;
              return true;
            },
            [&seen](int, const Ray&) { ++seen; });
    seen_[static_cast<size_t>(row) * grid_.lights + light] =
        sent > 0 ? static_cast<float>(seen) / static_cast<float>(sent) : 0.0f;
  }
}

void LightGuideStore::look_for_sky(const SceneView& scene, const EmbreeTracer& statics, int row) {
  const Row& from = rows_[static_cast<size_t>(row)];
  Probes(scene, statics)
      .trace(
          kSkyRays,
          [&](int i, Ray* ray) {
            Sampler sampler = guide_sampler(row, i, 0);
            const SurfacePoint start = start_of(from, i, &sampler);
            ray->o = start.p;
            ray->d = sample_sphere(sampler.next_2d());
            return from.facing < 0 || dot(ray->d, start.n) > 0;
          },
          [&](int, const Ray& ray) {
            const float light = luminance(sky_radiance(scene, ray.d, 0.1f) + scene.sky_ambient);
            if (light > 0) sky_rays_[static_cast<size_t>(row)].push_back({ray.d, light});
          });
}

int LightGuideStore::neighborhood(int row, int* rows) const {
  const int cell = rows_[static_cast<size_t>(row)].cell;
  const int facing = rows_[static_cast<size_t>(row)].facing;
  const int n[3] = {grid_.nx, grid_.ny, grid_.nz}, stride[3] = {1, n[0], n[0] * n[1]};
  int count = 0;
  rows[count++] = row;
  const auto add = [&](int other) {
    const int found =
        facing < 0 ? other : surface_row_[static_cast<size_t>(kFacings * other + facing)];
    if (found >= 0) rows[count++] = found;
  };
  for (int k = 0; k < 3; ++k) {
    const int at = cell / stride[k] % n[k];
    if (at > 0) add(cell - stride[k]);
    if (at + 1 < n[k]) add(cell + stride[k]);
  }
  return count;
}

void LightGuideStore::conclude(int row) {
  int rows[7];
  const int count = neighborhood(row, rows);
  for (uint32_t light = 0; light < grid_.lights; ++light) {
    const auto seen = [&](int r) { return seen_[static_cast<size_t>(r) * grid_.lights + light]; };
    float around = 0;
    for (int i = 1; i < count; ++i) around += seen(rows[i]) / static_cast<float>(count - 1);
    const float share = count > 1 ? 0.5f * (seen(row) + around) : seen(row);
    visible_[static_cast<size_t>(row) * grid_.lights + light] = max(share, kFloor);
  }
  Vec3f sum;
  float light = 0;
  size_t rays = 0;
  for (int i = 0; i < count; ++i) {
    for (const SkyRay& ray : sky_rays_[static_cast<size_t>(rows[i])]) {
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
    for (const SkyRay& ray : sky_rays_[static_cast<size_t>(rows[i])]) {
      cone.one_minus_cos = max(cone.one_minus_cos, 1.0f - dot(cone.axis, ray.d));
    }
  }
  // The outermost of a few directions lies well inside the opening.
  cone.one_minus_cos = cone.one_minus_cos * (1.0f + 1.0f / static_cast<float>(rays)) + 1e-3f;
  if (cone.one_minus_cos > kWidest) cone.one_minus_cos = 0;
  cone.strength = light * (4 * kPi / static_cast<float>(kSkyRays * count));
  sky_[static_cast<size_t>(row)] = cone;
}

void LightGuideStore::build(SceneView scene, const EmbreeTracer& statics,
                            const std::vector<LightView>& lights) {
  grid_ = {};
  const bool has_sky = scene.environment.illuminance > 0 || scene.sky_texture >= 0 ||
                       luminance(scene.sky_ambient) > 0;
  const bool has_choice = has_sky || lights.size() > 1;
  const bool has_walls = statics.rows.size > statics.first_still;
  if (!has_walls || lights.size() > kMaxWeighedLights || !has_choice) {
    return;
  }
  grid_ = place_guide_grid(
      scene, {statics.rows.data + statics.first_still, statics.rows.size - statics.first_still},
      kCellsAlong);
  if (grid_.nx == 0) return;
  grid_.lights = static_cast<uint32_t>(lights.size());
  scene.lights = {lights.data(), grid_.lights};
  find_rows(scene, statics);
  visible_.resize(rows_.size() * grid_.lights);
  seen_.resize(visible_.size());
  sky_rays_.resize(rows_.size());
  sky_.assign(rows_.size(), {});
  const auto count = static_cast<int64_t>(rows_.size());
  parallel_for("light guide", count, [&](int64_t row) {
    look_for_lights(scene, statics, static_cast<int>(row));
    if (has_sky) look_for_sky(scene, statics, static_cast<int>(row));
  });
  parallel_for("light guide rows", count, [&](int64_t row) { conclude(static_cast<int>(row)); });
  rows_ = {};
  seen_ = {};
  sky_rays_ = {};
}

LightGuide LightGuideStore::view() const {
  LightGuide guide = grid_;
  guide.surface_row = {surface_row_.data(), static_cast<uint32_t>(surface_row_.size())};
  guide.visible = {visible_.data(), static_cast<uint32_t>(visible_.size())};
  guide.sky = {sky_.data(), static_cast<uint32_t>(sky_.size())};
  return guide;
}

}  // namespace gloam
