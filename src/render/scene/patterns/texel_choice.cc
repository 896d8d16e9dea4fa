#include "render/scene/patterns/texel_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "render/kernel/surface/baked_view.h"
#include "render/kernel/surface/procedural.h"

namespace gloam {
namespace {

using DetailLost = std::array<float, kTexelWidths>;

double tiles_of(const PatternSurface& s, float texel) {
  const double edge = static_cast<double>(texel) * baking::kSide;
  return 6 + 1.4 * s.area / (edge * edge);
}

/// The texels that a surface may have, whatever its pattern gains by them [m].
struct Limits {
  float narrowest, widest;
};
Limits limits_of(const PatternSurface& s, float relax) {
  const Vec3f size = s.high - s.low;
  // Keys of cubes have room for so many; far layers must not fall into one cube.
  const float cubes = static_cast<float>((1 << baking::kCubesLog2) - 2);
  return {max(size.x, max(size.y, size.z)) / (static_cast<float>(baking::kSide) * cubes),
          relax * max(0.064f, 0.004f * std::sqrt(s.area))};
}

/// Index of the width at which what the surface loses and `price` per tile come to the least.
int choose(const PatternSurface& s, const DetailLost& lost, const TexelWidths& widths, double price,
           float relax) {
  constexpr double kSeenArea = 400;  // of a large surface, in detail from one place [m²]
  const double seen = s.area / (1 + s.area / kSeenArea);
  const Limits limits = limits_of(s, relax);
  int best = -1;
  double least = 0;
  for (int i = 0; i < kTexelWidths; ++i) {
    const auto row = static_cast<size_t>(i);
    if (widths[row] < limits.narrowest) continue;
    if (best >= 0 && widths[row] > limits.widest) break;
    const double cost = seen * lost[row] + price * tiles_of(s, widths[row]);
    if (best >= 0 && cost >= least) continue;
    best = i;
    least = cost;
  }
  return best >= 0 ? best : kTexelWidths - 1;
}

/// Chooses all texels for a price; about how many tiles that takes.
double choose_all(const std::vector<DetailLost>& lost, const TexelWidths& widths, double price,
                  float relax, std::span<PatternSurface> surfaces) {
  double tiles = 0;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    PatternSurface& s = surfaces[i];
    const auto width = static_cast<size_t>(choose(s, lost[i], widths, price, relax));
    s.texel = widths[width];
    s.lost = lost[i][width];
    tiles += tiles_of(s, s.texel);
  }
  return tiles;
}

void number_tables(std::span<PatternSurface> surfaces) {
  uint32_t table = 0;
  for (PatternSurface& s : surfaces) {
    const Vec3f size = s.high - s.low;
    float edge = s.texel * baking::kSide;
    s.first_table = table;
    s.tables = 1;
    for (; edge < 0.5f * max(size.x, max(size.y, size.z)); edge *= baking::kSide) ++s.tables;
    table += static_cast<uint32_t>(s.tables);
  }
}

DetailLost detail_lost(const ProceduralDescription& pattern, const TexelWidths& widths) {
  constexpr int kPlaces = 192;
  constexpr float kRegion = 8;  // [m]
  const RandomStream stream{pattern.seed, stream_id("pattern detail")};
  DetailLost lost{};
  for (int i = 0; i < kPlaces; ++i) {
    const Philox4 d = stream.draw(0, static_cast<uint32_t>(i));
    ProceduralPoint at;
    at.p = Vec3f{uniform_float(d.v[0]), uniform_float(d.v[1]), uniform_float(d.v[2])} * kRegion;
    at.n = {i % 3 == 0 ? 1.0f : 0.0f, i % 3 == 1 ? 1.0f : 0.0f, i % 3 == 2 ? 1.0f : 0.0f};
    at.footprint = widths[0];
    const ProceduralSample full = eval_procedural(pattern, at);
    for (size_t w = 1; w < widths.size(); ++w) {
      at.footprint = widths[w];
      lost[w] += visible_difference(eval_procedural(pattern, at), full, at.n) / kPlaces;
    }
  }
  return lost;
}

}  // namespace

float visible_difference(const ProceduralSample& a, const ProceduralSample& b, Vec3f n) {
  // Eyes see albedos about by their roots; slopes tilt the light, roughness its highlights.
  const auto root = [](Vec3f c) {
    return Vec3f{std::sqrt(max(c.x, 0.0f)), std::sqrt(max(c.y, 0.0f)), std::sqrt(max(c.z, 0.0f))};
  };
  const Vec3f slope = patterns::in_surface(a.relief.gradient - b.relief.gradient, n);
  return length_squared(root(a.base_color) - root(b.base_color)) * (1.0f / 3) +
         0.05f * min(length_squared(slope), 0.1f) + 0.1f * sqr(a.roughness - b.roughness) +
         0.25f * sqr(a.mask - b.mask);
}

void choose_texels(float finest, double most_tiles, std::span<PatternSurface> surfaces) {
  TexelWidths widths;
  for (size_t i = 0; i < widths.size(); ++i)
    widths[i] = finest * static_cast<float>(1 << static_cast<int>(i));
  std::vector<DetailLost> lost(surfaces.size());
  parallel_for("pattern details", static_cast<int64_t>(surfaces.size()), [&](int64_t i) {
    const auto row = static_cast<size_t>(i);
    lost[row] = detail_lost(*surfaces[row].pattern, widths);
  });
  // The least price that can be paid; where none can, coarser texels are allowed.
  constexpr double kDear = 1e3;
  float relax = 1;
  while (relax < 1e3f && choose_all(lost, widths, kDear, relax, surfaces) > most_tiles) relax *= 2;
  double low = -40, high = std::log(kDear);
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    const bool fits = choose_all(lost, widths, std::exp(middle), relax, surfaces) <= most_tiles;
    (fits ? high : low) = middle;
  }
  choose_all(lost, widths, std::exp(high), relax, surfaces);
  number_tables(surfaces);
}

}  // namespace gloam
