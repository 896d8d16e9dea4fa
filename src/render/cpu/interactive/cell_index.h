#pragma once
// Hash table from the keys of cells to their rows.

#include <cstdint>
#include <vector>

#include "render/kernel/interactive/irradiance_cache_view.h"

namespace gloam {

class CellIndex {
 public:
  /// Row of a cell, or -1.
  int find(uint64_t key) const {
    if (keys_.empty()) return -1;
    const uint32_t slot = slot_of(key);
    return keys_[slot] == 0 ? -1 : static_cast<int>(rows_[slot]);
  }
  /// Row of a cell; it is size() before the call if the cell was not there.
  uint32_t find_or_add(uint64_t key) {
    if (2 * (count_ + 1) > keys_.size()) grow();
    const uint32_t slot = slot_of(key);
    if (keys_[slot] == 0) set(slot, key, count_++);
    return rows_[slot];
  }
  uint32_t size() const { return count_; }

  /// Replaces all cells: cells[row].key is the key of a row.
  template <class Cells>
  void assign(const Cells& cells) {
    keys_.assign(keys_.size(), 0);
    count_ = 0;
    for (const auto& cell : cells) find_or_add(cell.key);
  }

  CellGrid grid(Vec3f eye, float edge_per_metre) const {
    return {{keys_.data(), static_cast<uint32_t>(keys_.size())},
            {rows_.data(), static_cast<uint32_t>(rows_.size())},
            eye,
            edge_per_metre};
  }

 private:
  uint32_t slot_of(uint64_t key) const {
    const auto size = static_cast<uint32_t>(keys_.size());
    uint32_t slot = caches::slot_of(key, size);
    while (keys_[slot] != 0 && keys_[slot] != key) slot = (slot + 1) & (size - 1);
    return slot;
  }
  void set(uint32_t slot, uint64_t key, uint32_t row) {
    keys_[slot] = key;
    rows_[slot] = row;
  }
  void grow() {
    const std::vector<uint64_t> keys = std::move(keys_);
    const std::vector<uint32_t> rows = std::move(rows_);
    const size_t size = keys.empty() ? 1u << 12 : 2 * keys.size();
    keys_.assign(size, 0);
    rows_.assign(size, 0);
    for (size_t i = 0; i < keys.size(); ++i)
      if (keys[i] != 0) set(slot_of(keys[i]), keys[i], rows[i]);
  }

  std::vector<uint64_t> keys_;  ///< open addressing, size a power of two; 0 = free
  std::vector<uint32_t> rows_;  ///< of each slot
  uint32_t count_ = 0;
};

/// Removes the cells that nothing has asked for in the last `lifetime` updates, and their rows in
/// the other lists. Returns the number of removed cells.
template <class Cells, class... Lists>
size_t drop_old_cells(uint32_t update, uint32_t lifetime, Cells* cells, Lists*... lists) {
  size_t kept = 0;
  for (size_t row = 0; row < cells->size(); ++row) {
    if ((*cells)[row].last_asked + lifetime < update) continue;
    (*cells)[kept] = (*cells)[row];
    (((*lists)[kept] = (*lists)[row]), ...);
    ++kept;
  }
  const size_t dropped = cells->size() - kept;
  cells->resize(kept);
  (lists->resize(kept), ...);
  return dropped;
}

}  // namespace gloam
