#pragma once
// Light that few rays of the irradiance cache's cells meet: regions spread it over their cells, as
// a source that one ray meets by chance would make a bright spot of its cell.

#include <unordered_map>

#include "render/cpu/path/key_groups.h"
#include "render/kernel/interactive/irradiance_cache_view.h"

namespace gloam {

class ExcessRegions {
 public:
  /// Excess of a cell in one round: light that its rays brought above what is likely, and its
  /// luminance before.
  struct OfCell {
    uint64_t key = 0;
    Vec3f excess;  ///< [cd/m²]
    float before = 0;
  };

  /// Adds those of a round, and sets the light that each cell gets for them. `remembers`: it is not
  /// the light's first coming round.
  void spread(std::span<const OfCell> cells, bool remembers, std::span<Vec3f> light);
  /// The light has changed about a cell.
  void forget(uint64_t key);
  /// Ends an update; drops regions that have had no cell for `kept` of them.
  void end_update(uint32_t kept);
  /// Writes or reads everything.
  template <class Archive>
  void visit(Archive& archive);

 private:
  /// Sums over cells and rounds, where old ones fade.
  struct Region {
    Vec3f sum, ratio;            ///< ratio: of excess to a cell's light
    float light = 0, cells = 0;  ///< what they had before
    uint32_t last_traced = 0;

    void add(const OfCell& cell);
    /// Scales the sums down to those of `most` cells.
    void fade(float most);
  };
  static constexpr size_t kLevels = 2;  ///< wide regions, and narrow ones in them

  Region all_;
  std::unordered_map<uint64_t, Region> regions_[kLevels];  ///< by masked key
  KeyGroups groups_;
  uint32_t update_ = 0;
};

template <class Archive>
void ExcessRegions::visit(Archive& archive) {
  archive(all_);
  archive(update_);
  for (auto& regions : regions_) {
    std::vector<std::pair<uint64_t, Region>> list(regions.begin(), regions.end());
    std::sort(list.begin(), list.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<uint64_t> keys;
    std::vector<Region> values;
    for (const auto& [key, region] : list) keys.push_back(key), values.push_back(region);
    archive(keys);
    archive(values);
    if (keys.size() != values.size()) return;
    regions.clear();
    for (size_t i = 0; i < keys.size(); ++i) regions[keys[i]] = values[i];
  }
}

}  // namespace gloam
