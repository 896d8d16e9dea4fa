#include "render/scene/patterns/detail_map.h"

#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "render/kernel/surface/baked_lookup.h"
#include "render/kernel/surface/procedural.h"
#include "render/scene/patterns/tile_baker.h"

namespace gloam {
namespace {

/// Edges of the rectangle after which the units of a pattern lie in the same way again [m]; 0 = it
/// has no units along that axis.
Vec2f unit_period(const ProceduralDescription& d) {
  switch (d.kind) {
    case ProceduralKind::kBrick:
      return {d.size_u + d.gap, 2 * (d.size_v + d.gap)};
    case ProceduralKind::kTiles:
      if (d.tile == TileShape::kSquare) return {d.size_u + d.gap, d.size_v + d.gap};
      return {d.size_u + d.gap, 1.7320508f * (d.size_u + d.gap)};
    case ProceduralKind::kConcrete:
      return d.size_u > 0 && d.size_v > 0 ? Vec2f{d.size_u, d.size_v} : Vec2f{};
    case ProceduralKind::kWood:  // boards begin anywhere along their row
      return d.size_u > 0 && d.size_v > 0 ? Vec2f{0, d.size_v} : Vec2f{};
    case ProceduralKind::kFabric:
      return {4 * d.scale, 4 * d.scale};
    default:
      return {};
  }
}

/// Whether the pattern runs in space, another way along each axis.
bool differs_by_axis(const ProceduralDescription& d) {
  const bool solid_wood = d.kind == ProceduralKind::kWood && !(d.size_u > 0 && d.size_v > 0);
  return solid_wood || d.kind == ProceduralKind::kScratches || d.kind == ProceduralKind::kDirt;
}

float whole_units(float length, float unit) {
  return unit > 0 ? unit * max(std::round(length / unit), 1.0f) : length;
}

/// Levels until the surface's own texels show all that is left.
int level_count(const DetailOrder& order) {
  int levels = 1;
  while (order.texel * static_cast<float>(1 << levels) < order.surface_texel &&
         (order.side >> levels) > 2)
    ++levels;
  return levels;
}

/// Weighted sum of samples.
struct Difference {
  ProceduralSample sample{{0, 0, 0}, 0, 0, 0, 0, 0, 0, {}};

  void add(const ProceduralSample& a, float weight) {
    sample.base_color += a.base_color * weight;
    sample.roughness += a.roughness * weight;
    sample.metallic += a.metallic * weight;
    sample.coat_weight += a.coat_weight * weight;
    sample.fuzz += a.fuzz * weight;
    sample.mask += a.mask * weight;
    sample.relief.gradient += a.relief.gradient * weight;
  }
};

struct MapLevel {
  const DetailOrder& order;
  Vec2f period;  ///< [m]
  int face, side;

  /// Adds the detail at a place on the face [m].
  void add(Vec3f q, float weight, Difference* sum) const {
    ProceduralPoint at;
    at.p = baking::from_face(q, face);
    at.n = baking::from_face({0, 0, 1}, face);
    at.footprint = kBakedFootprint * max(period.x, period.y) / static_cast<float>(side);
    sum->add(eval_procedural(*order.pattern, at), weight);
    at.footprint = order.surface_texel * (1.0f / 0.615f);
    sum->add(eval_procedural(*order.pattern, at), -weight);
  }

  /// Mean over the pattern, which is not zero where its units differ much.
  Difference mean_of_pattern() const {
    constexpr int kPlaces = 1024;
    constexpr float kRegion = 50;  // [m]
    const RandomStream stream{order.pattern->seed, stream_id("pattern detail")};
    Difference out;
    for (int i = 0; i < kPlaces; ++i) {
      const Philox4 d = stream.draw(0, static_cast<uint32_t>(i));
      add({uniform_float(d.v[0]) * kRegion, uniform_float(d.v[1]) * kRegion, 0}, 1.0f / kPlaces,
          &out);
    }
    return out;
  }

  /// Value of the texel at (i, j). Near the low borders the map fades to the values that follow
  /// its high borders.
  Difference at(int i, int j) const {
    constexpr float kBorder = 1.0f / 12;
    const float x = static_cast<float>(i) / static_cast<float>(side),
                y = static_cast<float>(j) / static_cast<float>(side);
    const float here_x = smooth_step(0, kBorder, x), here_y = smooth_step(0, kBorder, y);
    Difference sum;
    for (int k = 0; k < 4; ++k) {
      const float weight =
          ((k & 1) != 0 ? 1 - here_x : here_x) * ((k & 2) != 0 ? 1 - here_y : here_y);
      if (weight <= 0) continue;
      add({(x + static_cast<float>(k & 1)) * period.x, (y + static_cast<float>(k >> 1)) * period.y,
           0},
          weight, &sum);
    }
    return sum;
  }

  /// All texels. A map has few units: its mean is brought to the pattern's.
  void bake(BakedTexel* texels) const {
    std::vector<Difference> all(static_cast<size_t>(side) * static_cast<size_t>(side));
    parallel_for("pattern detail", side, [&](int64_t row) {
      for (int i = 0; i < side; ++i)
        all[static_cast<size_t>(row * side + i)] = at(i, static_cast<int>(row));
    });
    Difference missing = mean_of_pattern();
    for (const Difference& texel : all)
      missing.add(texel.sample, -1.0f / static_cast<float>(all.size()));
    missing.sample.relief = {};
    for (size_t i = 0; i < all.size(); ++i) {
      all[i].add(missing.sample, 1);
      const Vec3f slope = baking::along_face(all[i].sample.relief.gradient, face);
      texels[i] = pack_difference(all[i].sample, slope.x, slope.y);
    }
  }
};

}  // namespace

uint64_t detail_texels(const DetailOrder& order) {
  uint64_t texels = 0;
  for (int i = 0; i < level_count(order); ++i)
    texels += static_cast<uint64_t>(order.side >> i) * static_cast<uint64_t>(order.side >> i);
  return texels * (differs_by_axis(*order.pattern) ? 3 : 1);
}

BakedDetail bake_detail(const DetailOrder& order, std::vector<BakedTexel>* texels) {
  const float length = order.texel * static_cast<float>(order.side);
  const Vec2f unit = unit_period(*order.pattern);
  const Vec2f period{whole_units(length, unit.x), whole_units(length, unit.y)};
  BakedDetail out;
  out.side = order.side;
  out.levels = level_count(order);
  out.repeats = {1 / period.x, 1 / period.y};
  out.texels_per_metre = static_cast<float>(order.side) / max(period.x, period.y);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0 && !differs_by_axis(*order.pattern)) {
      out.first[axis] = out.first[0];
      continue;
    }
    out.first[axis] = static_cast<uint32_t>(texels->size());
    for (int level = 0; level < out.levels; ++level) {
      const int side = order.side >> level;
      const MapLevel map{order, period, 2 * axis, side};
      const size_t begin = texels->size();
      texels->resize(begin + static_cast<size_t>(side) * static_cast<size_t>(side));
      map.bake(texels->data() + begin);
    }
  }
  return out;
}

}  // namespace gloam
