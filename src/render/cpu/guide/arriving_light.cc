#include "render/cpu/guide/arriving_light.h"

#include <algorithm>
#include <array>
#include <memory>

#include "base/parallel.h"
#include "render/cpu/guide/guide_probes.h"
#include "render/kernel/light/light_directions.h"

namespace gloam {
namespace {

constexpr int kProbes = 256;         // of a row, evenly; then as many where light was found
constexpr int kReflections = 4;      // among rows
constexpr float kConeSpread = 0.2f;  // of a probe: about a cell's width
constexpr float kGuidedFraction =
    0.75f;                          // fraction of the later probes that follow the earlier ones
constexpr float kOwnWeight = 0.7f;  // fraction of a row's own light; its neighbours' is the rest
constexpr float kNeighbourWeight = 0.1f;  // fraction that a cell gets of those beside it
constexpr uint32_t kAcross = directions::kAcross, kCells = kAcross * kAcross;

/// Surface or sky that a probe met.
struct Arrival {
  float light = 0;   ///< luminance of what shines by itself or is lit by lights [cd/m²]
  float albedo = 0;  ///< of the surface
  int row = -1;      ///< where it lies; -1 = outside the grid
  float weight = 0;  ///< solid angle per area of the map, times the cosine at the row's surface
};

Vec3f direction_in(uint32_t cell, Vec2f u) {
  constexpr float kEdge = 2.0f / kAcross;
  const uint32_t x = cell % kAcross, y = cell / kAcross;
  return directions::from_square(Vec2f{(static_cast<float>(x) + u.x) * kEdge - 1.0f,
                                       (static_cast<float>(y) + u.y) * kEdge - 1.0f});
}

using Map = std::array<float, kCells>;

/// Sum over the cells that share an edge with `cell` on the square.
float beside(const Map& map, uint32_t cell) {
  const uint32_t x = cell % kAcross, y = cell / kAcross;
  return (x > 0 ? map[cell - 1] : 0) + (x + 1 < kAcross ? map[cell + 1] : 0) +
         (y > 0 ? map[cell - kAcross] : 0) + (y + 1 < kAcross ? map[cell + kAcross] : 0);
}

class ArrivingLight {
 public:
  ArrivingLight(const SceneView& scene, const CpuTracer& statics, const LightGuide& grid,
                const std::vector<GuideRow>& rows)
      : scene_(scene), statics_(statics), grid_(grid), rows_(rows), even_(rows.size() * kProbes) {
    scene_.guide = {};
    scene_.environment.row_cdf = {};  // probes look for its light themselves
    for (int facing = -1; facing < LightGuide::kFacings; ++facing) {
      for (uint32_t cell = 0; cell < kCells; ++cell) {
        const Vec3f d = direction_in(cell, {0.5f, 0.5f});
        const bool faces = facing < 0 || (facing % 2 == 0 ? d : -d)[facing / 2] > 0;
        if (faces) cells_[static_cast<size_t>(facing + 1)].push_back(cell);
      }
    }
  }

  std::vector<float> find() {
    const auto count = static_cast<int64_t>(rows_.size());
    parallel_for("arriving light", count, [&](int64_t row) {
      const std::vector<uint32_t>& cells = cells_of(static_cast<int>(row));
      uint32_t which[kProbes];
      for (size_t i = 0; i < kProbes; ++i) which[i] = cells[i % cells.size()];
      probe(static_cast<int>(row), 0, which, even_of(static_cast<int>(row)));
    });
    reflected_.assign(rows_.size(), 0);
    for (int i = 0; i < kReflections; ++i) {
      std::vector<float> next(rows_.size());
      for (size_t row = 0; row < rows_.size(); ++row) next[row] = add_up(static_cast<int>(row));
      reflected_ = std::move(next);
    }
    std::vector<Map> squares(rows_.size());
    parallel_for("arriving light sought", count, [&](int64_t row) {
      squares[static_cast<size_t>(row)] = seek(static_cast<int>(row));
    });
    std::vector<float> sums(rows_.size() * LightGuide::kSums);
    parallel_for("arriving light rows", count, [&](int64_t row) {
      conclude(squares, static_cast<int>(row), &sums[static_cast<size_t>(row) * LightGuide::kSums]);
    });
    return sums;
  }

 private:
  const std::vector<uint32_t>& cells_of(int row) const {
    return cells_[static_cast<size_t>(rows_[static_cast<size_t>(row)].facing + 1)];
  }
  Arrival* even_of(int row) { return &even_[static_cast<size_t>(row) * kProbes]; }

  /// Sends a ray from the row through each of the map's cells in `which` (kProbes).
  void probe(int row, uint32_t round, const uint32_t* which, Arrival* arrivals) const {
    const GuideRow& from = rows_[static_cast<size_t>(row)];
    Vec3f origins[kProbes];
    Surface met[kProbes];
    LightSample lights[kProbes];
    const Probes probes(scene_, statics_);
    probes.find(
        kProbes,
        [&](int i, Ray* ray) {
          Sampler sampler = guide_sampler(row, i, 2 + 2 * round);
          const int start = static_cast<int>(sampler.next_1d() * 4096.0f);
          const SurfacePoint at = start_of(grid_, from, start, &sampler);
          ray->o = origins[i] = at.p;
          ray->d = direction_in(which[i], sampler.next_2d());
          const float cosine = from.facing < 0 ? 1.0f : max(dot(ray->d, at.n), 0.0f);
          arrivals[i].weight = cosine / directions::area_per_solid_angle(ray->d);
          return cosine > 0;
        },
        [&](int i, const Ray& ray, bool found, const RayHit& hit) {
          Ray way = ray;
          way.o = origins[i];
          way.tmax = found ? dot(ray.o - way.o, ray.d) + hit.t : 1e30f;
          arrivals[i].weight *= clearness(scene_.media, way, row, i);
          if (!found) {
            arrivals[i].light =
                luminance(sky_radiance(scene_, ray.d, kConeSpread) + scene_.sky_ambient);
            return;
          }
          met[i] = make_surface(scene_, ray, hit, RayCone{0, kConeSpread});
          const Surface& s = met[i];
          if (scene_.instances[s.instance].light < 0) arrivals[i].light = luminance(s.emission);
          arrivals[i].albedo = luminance(s.base_color);
          arrivals[i].row = static_cast<int>(grid_.row_at(s.p, s.geometric));
          Sampler sampler = guide_sampler(row, i, 3 + 2 * round);
          LightSampler light_sampler;
          light_sampler.prepare(scene_, s.p, s.geometric);
          lights[i] = light_sampler.sample(scene_, s.p, sampler.next_2d(), 0.0f);
        });
    probes.trace(
        kProbes,
        [&](int i, Ray* ray) {
          const LightSample& light = lights[i];
          if (!(light.pdf > 0 && dot(light.wi, met[i].geometric) > 0)) return false;
          aim_shadow_ray(met[i].p, met[i].geometric, met[i].t, light, ray);
          return true;
        },
        [&](int i, const Ray& ray) {
          const float cosine = dot(lights[i].wi, met[i].geometric);
          Ray way = ray;
          way.o = met[i].p;
          way.tmax = lights[i].distance;
          arrivals[i].light += arrivals[i].albedo * kInvPi * cosine *
                               luminance(lights[i].radiance) / lights[i].pdf *
                               clearness(scene_.media, way, row, i);
        });
  }

  /// Luminance that the probe brought, weighted by the map's area.
  float light_of(const Arrival& a) const {
    const float reflected = a.row < 0 ? 0.0f : reflected_[static_cast<size_t>(a.row)];
    return (a.light + a.albedo * reflected) * a.weight;
  }

  /// Luminance of a white surface at the row; in the open, the mean from all around.
  float add_up(int row) {
    float sum = 0;
    for (int i = 0; i < kProbes; ++i) sum += light_of(even_of(row)[i]);
    const bool floats = rows_[static_cast<size_t>(row)].facing < 0;
    return sum / kProbes * (floats ? kInvPi : 2 * kInvPi);
  }

  /// Mean squares of what arrives through the cells of the map, from even probes and others through
  /// cells where these, those of the neighbours, or those through cells beside them found light.
  Map seek(int row) {
    const std::vector<uint32_t>& cells = cells_of(row);
    int near[7];
    const int count = neighborhood(grid_, rows_, row, near);
    Map found{}, spread{};
    for (int k = 0; k < count; ++k) {
      const float weight = k == 0 ? 1.0f : 1.0f / static_cast<float>(count);
      for (size_t i = 0; i < kProbes; ++i)
        found[cells[i % cells.size()]] += weight * light_of(even_of(near[k])[i]);
    }
    double total = 0;
    for (const uint32_t cell : cells) {
      spread[cell] = found[cell] + 0.25f * beside(found, cell);
      total += static_cast<double>(spread[cell]);
    }
    const auto even = 1.0 / static_cast<double>(cells.size());
    uint32_t which[kProbes];
    double before = 0;
    size_t used = 0;
    for (const uint32_t cell : cells) {
      const double sought = total > 0 ? static_cast<double>(spread[cell]) / total : even;
      before += (kGuidedFraction * sought + (1 - kGuidedFraction) * even) * kProbes;
      while (used < kProbes && static_cast<double>(used) + 0.5 < before) which[used++] = cell;
    }
    while (used < kProbes) which[used++] = cells.back();
    Arrival later[kProbes];
    probe(row, 1, which, later);
    Map squares{}, probes{};
    const auto add = [&](uint32_t cell, const Arrival& a) {
      squares[cell] += sqr(light_of(a));
      probes[cell] += 1;
    };
    for (size_t i = 0; i < kProbes; ++i) {
      add(cells[i % cells.size()], even_of(row)[i]);
      add(which[i], later[i]);
    }
    for (const uint32_t cell : cells) squares[cell] /= probes[cell];
    return squares;
  }

  /// The running sums of the row. Directions are sampled by the root of the mean square: where
  /// light fills a part of a cell, that part needs them.
  void conclude(const std::vector<Map>& squares, int row, float* sums) const {
    int near[7];
    const int count = neighborhood(grid_, rows_, row, near);
    Map light{}, own_and_near{};
    double total = 0;
    for (const uint32_t cell : cells_of(row)) {
      float around = 0;
      for (int k = 1; k < count; ++k) around += squares[static_cast<size_t>(near[k])][cell];
      const float own = squares[static_cast<size_t>(row)][cell];
      const float mean =
          count > 1 ? kOwnWeight * own + (1 - kOwnWeight) * around / static_cast<float>(count - 1)
                    : own;
      own_and_near[cell] = mean;
    }
    for (const uint32_t cell : cells_of(row)) {
      light[cell] = sqrtf(own_and_near[cell] + kNeighbourWeight * beside(own_and_near, cell));
      total += static_cast<double>(light[cell]);
    }
    double before = 0;
    for (uint32_t cell = 0; cell < kCells; ++cell) {
      sums[cell] = static_cast<float>(std::min(before, 1.0));
      // Dark maps count as even light from all around.
      before += total > 0 ? static_cast<double>(light[cell]) / total : 1.0 / kCells;
    }
    sums[kCells] = 1;
  }

  SceneView scene_;
  const CpuTracer& statics_;
  const LightGuide grid_;
  const std::vector<GuideRow>& rows_;
  std::vector<uint32_t> cells_[LightGuide::kFacings + 1];  ///< of the map, before each facing
  std::vector<Arrival> even_;                              ///< of the first probes of each row
  std::vector<float> reflected_;  ///< by row: luminance of a white surface there [cd/m²]
};

}  // namespace

std::vector<float> find_arriving_light(const SceneView& scene, const CpuTracer& statics,
                                       const LightGuide& grid, const std::vector<GuideRow>& rows) {
  return ArrivingLight(scene, statics, grid, rows).find();
}

float unevenness_of(const std::vector<float>& arriving, const std::vector<GuideRow>& rows) {
  double sum = 0, count = 0;
  for (size_t row = 0; row < rows.size(); ++row) {
    const int facing = rows[row].facing;
    if (facing < 0) continue;
    count += 1;
    const float* sums = &arriving[row * LightGuide::kSums];
    double squares = 0;
    for (uint32_t cell = 0; cell < kCells; ++cell) {
      const float probability = sums[cell + 1] - sums[cell];
      const Vec3f d = direction_in(cell, {0.5f, 0.5f});
      const float cosine = (facing % 2 == 0 ? d : -d)[facing / 2];
      if (probability > 0 && cosine <= 0) break;  // all is dark
      if (!(cosine > 0)) continue;
      const float even = cosine * (4 * kInvPi / kCells) / directions::area_per_solid_angle(d);
      squares += static_cast<double>(sqr(probability) / even);
    }
    sum += std::max(squares - 1, 0.0);
  }
  return count > 0 ? static_cast<float>(sum / count) : 0.0f;
}

}  // namespace gloam
