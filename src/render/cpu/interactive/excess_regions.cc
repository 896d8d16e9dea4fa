#include "render/cpu/interactive/excess_regions.h"

namespace gloam {
namespace {

/// Bits of keys that tell wide regions, and narrow ones in them.
constexpr uint64_t kRegionMasks[] = {caches::kWideRegion | caches::kFacing,
                                     caches::kRegion | caches::kFacing};

}  // namespace

void ExcessRegions::Region::add(const OfCell& cell) {
  sum += cell.excess;
  light += cell.before;
  ++cells;
}

void ExcessRegions::Region::fade(float most) {
  const float kept = min(1.0f, most / max(cells, 1.0f));
  sum = sum * kept;
  light *= kept;
  cells *= kept;
}

void ExcessRegions::spread(std::span<const OfCell> cells, bool remembers, std::span<Vec3f> light) {
  // Light from before counts less as long as light comes round for the first time.
  const float past = remembers ? interactive::kMaxExcessMemory : interactive::kFirstExcessMemory;
  all_.fade(past);
  for (const OfCell& cell : cells) all_.add(cell);
  all_.ratio = all_.sum / max(all_.light, interactive::kMinLuminance);
  // Levels from wide to narrow: a region that has seen few cells is completed by the wider region.
  for (size_t level = 0; level < kLevels; ++level) {
    const auto key_of = [&](size_t k) { return cells[k].key; };
    groups_.each(cells.size(), kRegionMasks[level], key_of, [&](auto group) {
      const uint64_t key = group.front().first;
      const Region& wider = level == 0 ? all_ : regions_[level - 1][key & kRegionMasks[level - 1]];
      Region& region = regions_[level][key];
      region.fade(past);
      for (const auto& [_, k] : group) region.add(cells[k]);
      region.last_traced = update_;
      const float guessed = region.light / region.cells * interactive::kRegionPriorCells;
      region.ratio = (region.sum + wider.ratio * guessed) /
                     max(region.light + guessed, interactive::kMinLuminance);
      if (level + 1 < kLevels) return;
      // Excess in proportion to each cell's light: dark corners of a region see little of bright
      // surfaces, too.
      for (const auto& [_, k] : group) light[k] = region.ratio * cells[k].before;
    });
  }
}

void ExcessRegions::forget(uint64_t key) {
  all_.fade(interactive::kChangedExcessMemory);
  for (size_t level = 0; level < kLevels; ++level) {
    regions_[level][key & kRegionMasks[level]].fade(interactive::kChangedExcessMemory);
  }
}

void ExcessRegions::end_update(uint32_t kept) {
  ++update_;
  for (auto& regions : regions_) {
    std::erase_if(regions,
                  [&](const auto& region) { return region.second.last_traced + kept < update_; });
  }
}

}  // namespace gloam
