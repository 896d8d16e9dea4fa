#include "render/scene/patterns/pattern_store.h"

#include <algorithm>
#include <bit>

#include "base/archive.h"
#include "base/cache.h"
#include "base/cache_writer.h"
#include "base/files.h"
#include "base/parallel.h"
#include "render/kernel/surface/baked_lookup.h"
#include "render/scene/patterns/detail_map.h"
#include "render/scene/patterns/pattern_cache.h"
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
    constexpr double kPart = 0.4;  // of the memory: maps of detail show what is too fine for it
    const double most = kPart * static_cast<double>(baking.most_bytes) /
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

/// Maps of detail for the surfaces whose texels leave something out: a row of `orders` for each, or
/// -1.
struct DetailOrders {
  std::vector<DetailOrder> orders;
  std::vector<int> rows;  ///< by surface
};

void add_order(const PatternSurface& surface, float texel, DetailOrders* out) {
  constexpr float kVisible = 1e-5f;
  out->rows.push_back(-1);
  if (surface.texel <= 2 * texel || surface.lost < kVisible) return;
  // The map of a small surface may repeat at shorter distances than the map of a floor or a wall.
  DetailOrder order{surface.pattern, surface.texel, texel,
                    surface.area > 10 ? 512 : (surface.area > 1 ? 256 : 128)};
  const auto at = std::find_if(out->orders.begin(), out->orders.end(), [&](const DetailOrder& in) {
    return in.pattern == order.pattern && in.surface_texel == order.surface_texel;
  });
  out->rows.back() = static_cast<int>(at - out->orders.begin());
  if (at == out->orders.end()) {
    out->orders.push_back(order);
  } else {
    at->side = std::max(at->side, order.side);
  }
}

DetailOrders order_details(const PatternBaking& baking, std::span<const PatternSurface> surfaces) {
  DetailOrders out;
  for (const PatternSurface& surface : surfaces)
    add_order(surface, 2 * baking.metres_per_texel, &out);
  const auto bytes = [&] {
    uint64_t texels = 0;
    for (const DetailOrder& order : out.orders) texels += detail_texels(order);
    return texels * sizeof(BakedTexel);
  };
  for (int most = 256; most >= 16 && bytes() > baking.most_bytes / 2; most /= 2)
    for (DetailOrder& order : out.orders) order.side = std::min(order.side, most);
  return out;
}

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
  const PatternBaking& baking = description.pattern_baking;
  if (baking.by_formula) return out;
  PatternSurfaces found = collect_pattern_surfaces(description, frame);
  if (found.surfaces.empty()) return out;
  out.instances_ = std::move(found.instances);
  const uint64_t key = pattern_key(baking, found);
  const std::filesystem::path path =
      cache_folder(kPatternCache) / cache_entry_name(kPatternCache, key);
  if (out.load(path, found.surfaces.size())) return out;
  out.bake(baking, found.surfaces);
  out.keep(path);
  return out;
}

void PatternStore::bake(const PatternBaking& baking, std::span<PatternSurface> surfaces) {
  const Tiles tiles(baking, surfaces);
  texels_.resize(tiles.tiles.size() * baking::kTileTexels);
  std::vector<uint64_t> keys(tiles.tiles.size());
  parallel_for("pattern tiles", static_cast<int64_t>(tiles.tiles.size()), [&](int64_t i) {
    const auto row = static_cast<size_t>(i);
    const Tile& tile = tiles.tiles[row];
    const std::span<const CubeTriangle> triangles = tiles.triangles(tile);
    keys[row] = triangles[0].key;
    bake_tile(surfaces[tile.surface], triangles, texels_.data() + row * baking::kTileTexels);
  });
  slots_ = hash_table(keys);
  for (const PatternSurface& surface : surfaces) patterns_.push_back(pattern_of(surface));
  const DetailOrders details = order_details(baking, surfaces);
  std::vector<BakedDetail> maps;
  for (const DetailOrder& order : details.orders) maps.push_back(bake_detail(order, &texels_));
  for (size_t i = 0; i < details.rows.size(); ++i)
    if (details.rows[i] >= 0) patterns_[i].detail = maps[static_cast<size_t>(details.rows[i])];
}

bool PatternStore::load(const std::filesystem::path& path, size_t surfaces) {
  const auto bytes = read_file(path, UINT64_MAX);
  if (!bytes.ok()) return false;
  ArchiveReader in(unseal_cache_entry(kPatternMagic, *bytes));
  PatternStore read;
  in(read.patterns_), in(read.slots_), in(read.texels_);
  if (!in.is_done() || read.patterns_.size() != surfaces) return false;
  mark_cache_use(path);
  read.instances_ = std::move(instances_);
  *this = std::move(read);
  return true;
}

void PatternStore::keep(const std::filesystem::path& path) {
  constexpr size_t kWorthKeeping = size_t{1} << 16;  // texels
  if (texels_.size() < kWorthKeeping) return;
  ArchiveWriter out;
  begin_cache_entry(&out.bytes);
  out(patterns_), out(slots_), out(texels_);
  keep_in_cache_later(path, kPatternMagic, std::move(out.bytes));
}

BakedView PatternStore::view() const {
  return {span_of(patterns_), span_of(slots_), span_of(texels_)};
}

}  // namespace gloam
