#pragma once
// Cells of the irradiance cache in groups whose keys are alike under a mask.

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gloam {

class KeyGroups {
 public:
  /// A masked key, and the row of what has it.
  using Member = std::pair<uint64_t, size_t>;

  /// visit(group), in the order of the masked keys. `key_of(row)`: of rows below `count`.
  template <class KeyOf, class Visit>
  void each(size_t count, uint64_t mask, const KeyOf& key_of, const Visit& visit) {
    order_.clear();
    for (size_t row = 0; row < count; ++row) order_.emplace_back(key_of(row) & mask, row);
    std::sort(order_.begin(), order_.end());
    for (size_t first = 0, next = 0; first < order_.size(); first = next) {
      while (next < order_.size() && order_[next].first == order_[first].first) ++next;
      visit(std::span<const Member>(order_).subspan(first, next - first));
    }
  }

 private:
  std::vector<Member> order_;
};

}  // namespace gloam
