#include "sensors/lidar/lidar_particle_table.h"

#include <algorithm>
#include <cmath>

#include "render/kernel/lidar/lidar_particles.h"
#include "world/media/medium_presets.h"

namespace gloam {
namespace {

// Limit on particles in one cell of a beam: more are a medium, whose sum varies by less than a
// sixth.
constexpr float kMaxParticlesPerCell = 32;
constexpr size_t kMostCells = 4096;

/// Power that goes straight back from a drop over that of a sphere that scatters evenly: the front
/// reflects R, the back R (1 - R)² focused by (n / (2 - n))², n = 1.328 at 905 nm (Hale and Querry
/// 1973).
float axial_gain() {
  constexpr float n = 1.328f;
  const float r = sqr((n - 1) / (n + 1));
  return r + r * sqr(1 - r) * sqr(n / (2 - n));
}

/// The most that a particle sends back from cell `k`: on the axis, at its nearer or farther end.
float most_signal(const LidarOptics& optics, size_t k, float backscatter) {
  const float near = std::max(static_cast<float>(k) * lidar::kCell, optics.min_range);
  const float far = std::max(static_cast<float>(k + 1) * lidar::kCell, near);
  return std::max(lidar::particle_signal(optics, std::max(near, 1e-3f), backscatter, 0),
                  lidar::particle_signal(optics, far, backscatter, 0));
}

LidarCell make_cell(const LidarOptics& optics, const std::vector<LidarParticle>& classes,
                    size_t k) {
  LidarCell cell;
  const Vec2f half = lidar::half_widths(optics, static_cast<float>(k + 1) * lidar::kCell);
  const float volume = kPi * half.x * half.y * sqr(lidar::kSampledBeamRadius) * lidar::kCell;
  // Noise lifts nothing over the threshold that is weaker than itself.
  const float least = optics.threshold / lidar::kLeastRatio;
  size_t first = classes.size();
  while (first > 0 && most_signal(optics, k, classes[first - 1].backscatter) >= least) --first;
  for (size_t i = first; i < classes.size(); ++i) cell.mean += classes[i].number * volume;
  if (cell.mean > kMaxParticlesPerCell) {
    cell.mean = 0;
    first = classes.size();
  }
  cell.first = static_cast<uint32_t>(first);
  for (size_t i = 0; i < first; ++i) cell.even += classes[i].number * classes[i].backscatter;
  return cell;
}

LidarParticleTable make_table(const ParticleSet& set, const LidarOptics& optics) {
  LidarParticleTable table;
  table.density = set.water;
  for (const ParticleClass& c : set.classes)
    table.classes.push_back({c.number, particle_backscatter(set.kind, c.diameter)});
  const double cells = std::ceil(static_cast<double>(optics.max_range / lidar::kCell));
  for (size_t k = 0; k <= std::min(static_cast<size_t>(cells), kMostCells); ++k)
    table.cells.push_back(make_cell(optics, table.classes, k));
  // Ranges beyond the last cell have no particles of their own.
  LidarCell beyond;
  for (const LidarParticle& c : table.classes) beyond.even += c.number * c.backscatter;
  beyond.first = static_cast<uint32_t>(table.classes.size());
  table.cells.push_back(beyond);
  return table;
}

}  // namespace

float particle_backscatter(ParticleKind kind, float diameter) {
  const float radius2 = sqr(0.5f * diameter);
  if (kind == ParticleKind::kDrop) return 0.25f * axial_gain() * radius2;
  return 2 * kPi * radius2 / lidar_ratio("snowfall");
}

std::vector<LidarParticleTable> tabulate_particles(const RenderDescription& rendered,
                                                   const LidarOptics& optics) {
  std::vector<LidarParticleTable> tables(rendered.volumes.size());
  bool any = false;
  for (size_t v = 0; v < tables.size(); ++v) {
    for (const ParticleSet& set : rendered.weather.particles) {
      if (rendered.volumes[v].name != "weather/" + medium_of(set).name) continue;
      tables[v] = make_table(set, optics);
      any = true;
    }
  }
  if (!any) tables.clear();
  return tables;
}

}  // namespace gloam
