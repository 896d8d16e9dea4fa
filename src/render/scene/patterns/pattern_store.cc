#include "render/scene/patterns/pattern_store.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"
#include "render/kernel/surface/baked_lookup.h"
#include "render/scene/patterns/surface_cubes.h"
#include "render/scene/patterns/texel_choice.h"
#include "render/scene/patterns/tile_baker.h"
#include "render/scene/span_of.h"

namespace gloam {
namespace {

/// A tile to bake: triangles `first` to `last` of a surface's list.
struct Tile {
  uint32_t surface, first, last;
};

class Tiles {
 public:
  /// Chooses texels and lists the tiles, within the budget.
  Tiles(const PatternBaking& baking, std::span<PatternSurface> surfaces) {
    const double most = static_cast<double>(baking.most_bytes) /
                        (baking::kTileTexels * sizeof(BakedTexel) + 2 * sizeof(BakedSlot));
    // The estimate may be short of what borders take.
    for (double goal = most; goal > 1; goal *= 0.7) {
      choose_texels(baking.metres_per_texel, goal, surfaces);
      list(surfaces);
      if (static_cast<double>(tiles.size()) <= most) break;
    }
  }
  std::span<const CubeTriangle> triangles(const Tile& tile) const {
    return std::span(cubes_[tile.surface]).subspan(tile.first, tile.last - tile.first);
  }

  std::vector<Tile> tiles;

 private:
  void list(std::span<const PatternSurface> surfaces) {
    cubes_.resize(surfaces.size());
    parallel_for("pattern cubes", static_cast<int64_t>(surfaces.size()), [&](int64_t i) {
      cubes_[static_cast<size_t>(i)] = list_cubes(surfaces[static_cast<size_t>(i)]);
    });
    tiles.clear();
    for (uint32_t s = 0; s < cubes_.size(); ++s) {
      const std::vector<CubeTriangle>& in = cubes_[s];
      for (uint32_t i = 0; i < in.size(); ++i) {
        if (i == 0 || in[i].key != in[i - 1].key) tiles.push_back({s, i, i});
        tiles.back().last = i + 1;
      }
    }
  }

  std::vector<std::vector<CubeTriangle>> cubes_;  ///< by surface
};

BakedPattern pattern_of(const PatternSurface& surface) {
  BakedPattern out;
  out.low = surface.low;
  out.per_metre = 1.0f / surface.texel;
  out.first_table = surface.first_table;
  out.tables = surface.tables;
  out.is_sheet = surface.is_sheet;
  ProceduralPoint far;
  far.footprint = 1e4f;
  const ProceduralSample mean = eval_procedural(*surface.pattern, far);
  out.coat_roughness = mean.coat_roughness;
  out.mean = pack_texel(mean, 0, 0);
  return out;
}

std::vector<BakedSlot> hash_table(std::span<const uint64_t> keys) {
  std::vector<BakedSlot> slots(std::bit_ceil(2 * keys.size() + 1));
  const auto last = static_cast<uint32_t>(slots.size() - 1);
  for (size_t i = 0; i < keys.size(); ++i) {
    uint32_t at = baking::slot_of(keys[i], static_cast<uint32_t>(slots.size()));
    while (slots[at].key != BakedSlot::kEmpty) at = (at + 1) & last;
    slots[at] = {keys[i], i * baking::kTileTexels};
  }
  return slots;
}

}  // namespace

PatternStore PatternStore::make(const RenderDescription& description, const PoseFrame& frame) {
  PatternStore out;
  if (description.pattern_baking.by_formula) return out;
  PatternSurfaces found = collect_pattern_surfaces(description, frame);
  if (found.surfaces.empty()) return out;
  const Tiles tiles(description.pattern_baking, found.surfaces);
  out.texels_.resize(tiles.tiles.size() * baking::kTileTexels);
  std::vector<uint64_t> keys(tiles.tiles.size());
  parallel_for("pattern tiles", static_cast<int64_t>(tiles.tiles.size()), [&](int64_t i) {
    const auto row = static_cast<size_t>(i);
    const Tile& tile = tiles.tiles[row];
    const std::span<const CubeTriangle> triangles = tiles.triangles(tile);
    keys[row] = triangles[0].key;
    bake_tile(found.surfaces[tile.surface], triangles,
              out.texels_.data() + row * baking::kTileTexels);
  });
  out.slots_ = hash_table(keys);
  for (const PatternSurface& surface : found.surfaces) out.patterns_.push_back(pattern_of(surface));
  out.instances_ = std::move(found.instances);
  return out;
}

BakedView PatternStore::view() const {
  return {span_of(patterns_), span_of(slots_), span_of(texels_)};
}

}  // namespace gloam
