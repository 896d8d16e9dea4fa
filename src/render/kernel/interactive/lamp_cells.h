#pragma once
// Lamps by cell: which of them light the surfaces of each cell of a hash grid, and which of those
// are hidden from no point of it, so that a surface needs no search among all lamps and shadow
// rays only in the penumbra. Device-safe.

#include "render/kernel/interactive/irradiance_cache_view.h"

namespace gloam {

/// Lamps of one cell.
struct LampCell {
  static constexpr uint32_t kMost = 40;
  /// Results of rays from the cell to a lamp, as bits.
  enum Seen : uint8_t { kHidden = 1, kClear = 2 };

  uint16_t lamp[kMost];   ///< rows of SceneView::lights, rising
  uint8_t seen[kMost];    ///< by all rays so far
  uint8_t weight[kMost];  ///< light_weight() over the cell's largest [1/255], at least 1
  float brightest = 0;    ///< light_weight() of weight 255
  uint8_t count = 0;
  uint8_t visible = 0;  ///< of these, how many a ray has reached

  GLOAM_HD bool is_visible(uint32_t i) const { return (seen[i] & kClear) != 0; }
  /// Whether no ray met anything.
  GLOAM_HD bool is_clear(uint32_t i) const { return seen[i] == kClear; }
};

struct LampCellsView : CellGrid {
  DeviceSpan<const LampCell> lists;
  /// Rows of lights that have moved: they are in no list, and light every cell.
  DeviceSpan<const uint16_t> movable;
};

/// Lists of the surfaces in lanes.
template <class F>
struct LampListsOf {
  const LampCell* of[Lanes<F>::kCount] = {};  ///< null: not known yet
  MaskOf<F> known = false;

  GLOAM_HD void set(int i, const LampCell* cell) {
    of[i] = cell;
    set_lane(&known, i, cell != nullptr);
  }
  friend GLOAM_HD void copy_lane(const LampListsOf& from, int i, LampListsOf* to, int k) {
    to->set(k, from.of[i]);
  }
};

/// A lamp that several lanes take, and whether static geometry hides it from them.
template <class F>
struct ListedLampOf {
  uint32_t lamp = 0;
  MaskOf<F> lanes = false;
  MaskOf<F> clear = false;
};

/// The lamps of the lanes' lists one after the other, each once for all lanes that list it.
template <class F>
class ListedLamps {
 public:
  GLOAM_HD ListedLamps(const LampListsOf<F>& lists, MaskOf<F> active) : lists_(lists) {
    each_lane(active, [&](int i) {
      next_[i] = 0;
      skip_hidden(i);
    });
    active_ = active;
  }

  /// False: there are no more.
  GLOAM_HD bool next(ListedLampOf<F>* out) {
    uint32_t lamp = kEnd;
    each_lane(active_, [&](int i) { lamp = min(lamp, row(i)); });
    if (lamp == kEnd) return false;
    *out = {lamp, false, false};
    each_lane(active_, [&](int i) {
      if (row(i) != lamp) return;
      set_lane(&out->lanes, i, true);
      set_lane(&out->clear, i, lists_.of[i]->is_clear(next_[i]));
      ++next_[i];
      skip_hidden(i);
    });
    return true;
  }

 private:
  static constexpr uint32_t kEnd = ~0u;
  GLOAM_HD uint32_t row(int i) const {
    return next_[i] < lists_.of[i]->count ? lists_.of[i]->lamp[next_[i]] : kEnd;
  }
  GLOAM_HD void skip_hidden(int i) {
    const LampCell& cell = *lists_.of[i];
    while (next_[i] < cell.count && !cell.is_visible(next_[i])) ++next_[i];
  }

  const LampListsOf<F>& lists_;
  MaskOf<F> active_ = false;
  uint32_t next_[Lanes<F>::kCount] = {};
};

/// One of a cell's visible lamps, by weight.
struct LampDraw {
  uint32_t lamp = 0;
  bool clear = false;
  float probability = 0;  ///< 0 = the cell has none
  float rest = 0;         ///< of u, again in [0, 1)
};
GLOAM_HD LampDraw draw_lamp(const LampCell& cell, float u) {
  uint32_t total = 0;
  for (uint32_t i = 0; i < cell.count; ++i) total += cell.is_visible(i) ? cell.weight[i] : 0u;
  float left = u * static_cast<float>(total);
  LampDraw out;
  for (uint32_t i = 0; i < cell.count; ++i) {
    if (!cell.is_visible(i)) continue;
    const auto weight = static_cast<float>(cell.weight[i]);
    out = {cell.lamp[i], cell.is_clear(i), weight / static_cast<float>(total),
           min(left / weight, 0.9999999f)};
    if (left < weight) break;
    left -= weight;
  }
  return out;
}

/// Probability with which draw_lamp() takes a lamp.
GLOAM_HD float draw_probability(const LampCell& cell, uint32_t lamp) {
  uint32_t total = 0, mine = 0;
  for (uint32_t i = 0; i < cell.count; ++i) {
    if (!cell.is_visible(i)) continue;
    total += cell.weight[i];
    if (cell.lamp[i] == lamp) mine = cell.weight[i];
  }
  return mine > 0 ? static_cast<float>(mine) / static_cast<float>(total) : 0.0f;
}

}  // namespace gloam
