#include "render/cpu/guide/light_guide.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/cpu/guide/arriving_light.h"
#include "render/cpu/guide/guide_probes.h"
#include "render/kernel/light/light_directions.h"
#include "render/kernel/light/light_sampler.h"
#include "render/scene/light_tree_table.h"
#include "render/scene/span_of.h"

namespace gloam {
namespace {

constexpr int kCellsAlong = 16;     // of the longest edge
constexpr int kLightRays = 32;      // to each light from a cell, at most
constexpr int kRaysOfRow = 512;     // to all of them
constexpr float kMinGain = 0.002f;  // gain of a light that no ray has seen
constexpr float kMinMapFraction =
    0.02f;  // fraction of the map below which nothing is sampled from it
constexpr float kMaxUnevenness = 0.5f;  // unevenness up to which the BSDF finds light as well
constexpr float kGuidedProbability =
    0.75f;  // of directions by the guide, where surfaces are diffuse
constexpr int kFacings = LightGuide::kFacings;

/// Volumes that are the same in every picture.
std::vector<VolumeView> still_volumes(const MediaView& media) {
  std::vector<VolumeView> still;
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    if (!media.volumes[i].changes) still.push_back(media.volumes[i]);
  }
  return still;
}

}  // namespace

void LightGuideStore::find_rows(const SceneView& scene, const CpuTracer& statics) {
  const int cells = grid_.nx * grid_.ny * grid_.nz;
  std::vector<GuideRow> surfaces(static_cast<size_t>(cells) * kFacings);
  parallel_for("light guide surfaces", cells, [&](int64_t cell) {
    for (int facing = 0; facing < kFacings; ++facing) {
      const int c = static_cast<int>(cell);
      surfaces[static_cast<size_t>(cell * kFacings + facing)] = {
          c, facing, find_surface(scene, statics, grid_, c, facing)};
    }
  });
  rows_.clear();
  for (int cell = 0; cell < cells; ++cell) rows_.push_back({cell, -1, {}});
  surface_row_.assign(surfaces.size(), LightGuide::kNone);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].points.empty()) continue;
    surface_row_[i] = static_cast<uint32_t>(rows_.size());
    rows_.push_back(std::move(surfaces[i]));
  }
}

/// Weights of lights are the roots of their mean squares: one light then stands for all with the
/// least noise.
void LightGuideStore::look_for_lights(const SceneView& scene, const CpuTracer& statics, int row) {
  const GuideRow& from = rows_[static_cast<size_t>(row)];
  const int rays = clamp(kRaysOfRow / max(static_cast<int>(grid_.lights), 1), 1, kLightRays);
  for (uint32_t light = 0; light < grid_.lights; ++light) {
    float brought[kLightRays], expected = 0, found = 0;  // the latter two: sums of squares
    Vec3f origins[kLightRays];
    Probes(scene, statics)
        .trace(
            rays,
            [&](int i, Ray* ray) {
              Sampler sampler = guide_sampler(row, i, 0);
              const SurfacePoint start = start_of(grid_, from, i, &sampler);
              ray->o = origins[i] = start.p;
              expected += sqr(light_weight<float>(scene, scene.lights[light], start.p, start.n));
              const LightSample sample =
                  sample_one_light(scene, light, ray->o, sampler.next_2d(), 0.0f);
              const float cosine = from.facing < 0 ? 1.0f : dot(sample.wi, start.n);
              if (!(sample.pdf > 0 && cosine > 0)) return false;
              brought[i] = luminance(sample.radiance) * cosine / sample.pdf;
              const Vec3f to = sample.wi * sample.distance + sample.lift;
              ray->d = normalize(to);
              ray->tmax = length(to) * 0.9999f;
              return true;
            },
            [&](int i, const Ray& ray) {
              Ray way = ray;
              way.o = origins[i];
              way.tmax = dot(ray.o - way.o, ray.d) + ray.tmax;
              found += sqr(brought[i] * clearness(scene.media, way, row, i));
            });
    found_[static_cast<size_t>(row) * grid_.lights + light] =
        expected > 0 ? std::sqrt(found / expected) : 0.0f;
  }
}

void LightGuideStore::look_for_sky(const SceneView& scene, const CpuTracer& statics, int row) {
  const GuideRow& from = rows_[static_cast<size_t>(row)];
  const LightGuide guide = view();
  Vec3f origins[kLightRays];
  float seen = 0;
  Probes(scene, statics)
      .trace(
          kLightRays,
          [&](int i, Ray* ray) {
            Sampler sampler = guide_sampler(row, i, 0);
            const SurfacePoint start = start_of(grid_, from, i, &sampler);
            ray->o = origins[i] = start.p;
            ray->d = environment_sample(scene.environment, sampler.next_2d()).wi;
            return from.facing < 0 || dot(ray->d, start.n) > 0;
          },
          [&](int i, Ray ray) {
            const float by_map = environment_pdf(scene.environment, ray.d);
            const float by_guide = directions::pdf<float>(guide, static_cast<uint32_t>(row), ray.d);
            ray.o = origins[i];
            if (by_map > 0)
              seen += by_map / (by_map + by_guide) * clearness(scene.media, ray, row, i);
          });
  sky_seen_[static_cast<size_t>(row)] = seen / kLightRays;
}

void LightGuideStore::conclude(int row) {
  int rows[7];
  const int count = neighborhood(view(), rows_, row, rows);
  // Mean of what a row has seen itself and what its neighbours have.
  const auto smooth = [&](const std::vector<float>& seen, size_t stride, size_t first) {
    const auto of = [&](int r) { return seen[static_cast<size_t>(r) * stride + first]; };
    float around = 0;
    for (int i = 1; i < count; ++i) around += of(rows[i]) / static_cast<float>(count - 1);
    return max(count > 1 ? 0.5f * (of(row) + around) : of(row), kMinGain);
  };
  for (uint32_t light = 0; light < grid_.lights; ++light) {
    gain_[static_cast<size_t>(row) * grid_.lights + light] = smooth(found_, grid_.lights, light);
  }
  if (sky_seen_.empty()) return;
  const float sky = smooth(sky_seen_, 1, 0);
  sky_visible_[static_cast<size_t>(row)] = sky > kMinMapFraction ? sky : 0.0f;
}

void LightGuideStore::build(SceneView scene, const CpuTracer& statics, const DescribedLook& look) {
  grid_ = {};
  scene.environment = look.environment;
  scene.sky_ambient = look.sky_ambient;
  const bool has_sky = scene.environment.illuminance > 0 || scene.sky_texture >= 0 ||
                       luminance(scene.sky_ambient) > 0;
  const bool has_sun =
      std::any_of(look.lights.begin(), look.lights.end(),
                  [](const LightView& light) { return light.kind == LightKind::kDirectional; });
  const bool has_choice = has_sky || has_sun || look.lights.size() > 1;
  const bool has_walls = statics.rows.size > statics.first_still;
  if (!has_walls || !has_choice) return;
  grid_ = place_guide_grid(
      scene, {statics.rows.data + statics.first_still, statics.rows.size - statics.first_still},
      kCellsAlong);
  if (grid_.nx == 0) return;
  scene.lights = {look.lights.data(), static_cast<uint32_t>(look.lights.size())};
  scene.selects_by_tree = scene.lights.size > kMaxWeighedLights;
  if (!scene.selects_by_tree) grid_.lights = scene.lights.size;
  LightTreeTable tree;
  if (scene.selects_by_tree) tree.build(look.lights, {});
  scene.light_tree = tree.view();
  const std::vector<VolumeView> still = still_volumes(scene.media);
  scene.media.volumes = span_of(still);
  scene.media.glows = {};
  scene.materials = {look.materials.data(), static_cast<uint32_t>(look.materials.size())};
  scene.instances = {look.instances.data(), static_cast<uint32_t>(look.instances.size())};
  find_rows(scene, statics);
  const bool has_map = !scene.environment.row_cdf.empty();
  // Light through windows falls on small patches. Lamps light a room more evenly: there, looking up
  // directions costs more time than it saves noise.
  if (has_sky || has_sun) {
    arriving_ = find_arriving_light(scene, statics, view(), rows_);
    grid_.probability =
        unevenness_of(arriving_, rows_) > kMaxUnevenness ? kGuidedProbability : 0.0f;
  }
  gain_.resize(rows_.size() * grid_.lights);
  found_.resize(gain_.size());
  sky_visible_.resize(rows_.size());
  if (has_map) sky_seen_.resize(rows_.size());
  const auto count = static_cast<int64_t>(rows_.size());
  parallel_for("light guide", count, [&](int64_t row) {
    look_for_lights(scene, statics, static_cast<int>(row));
    if (has_map) look_for_sky(scene, statics, static_cast<int>(row));
  });
  parallel_for("light guide rows", count, [&](int64_t row) { conclude(static_cast<int>(row)); });
  rows_ = {};
  found_ = {};
  sky_seen_ = {};
}

LightGuide LightGuideStore::view() const {
  LightGuide guide = grid_;
  guide.surface_row = {surface_row_.data(), static_cast<uint32_t>(surface_row_.size())};
  guide.gain = {gain_.data(), static_cast<uint32_t>(gain_.size())};
  guide.sky_visible = {sky_visible_.data(), static_cast<uint32_t>(sky_visible_.size())};
  guide.arriving = {arriving_.data(), static_cast<uint32_t>(arriving_.size())};
  return guide;
}

}  // namespace gloam
