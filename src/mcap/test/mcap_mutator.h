#pragma once
// Damaged logs that are logs: fields of records change, inside chunks too.

#include <algorithm>
#include <string>

#include "base/test/mutator.h"
#include "mcap/test/mcap_tree.h"

namespace gloam {

class McapMutator {
 public:
  explicit McapMutator(uint64_t seed) : random_(seed) {}

  /// Bytes that are no log stay.
  McapBytes mutate(const McapBytes& log) {
    if (log.size() < 16 || !std::equal(kMcapMagic.begin(), kMcapMagic.end(), log.begin()))
      return log;
    McapTree records = read_mcap_tree(std::span<const uint8_t>(log).subspan(8));
    if (records.empty()) return log;
    for (uint32_t times = 1 + random_.draw(4); times > 0; --times) change(&records);
    return McapTreeWriter().write(records, random_.draw(4) != 0);
  }

 private:
  void change(McapTree* records) {
    const size_t i = random_.draw(records->size());
    McapTreeRecord& record = (*records)[i];
    if (record.op == McapOp::kChunk && !record.inside.empty() && random_.draw(8) != 0)
      return change(&record.inside);
    switch (random_.draw(8)) {
      case 0:
        if (records->size() > 1) records->erase(records->begin() + static_cast<std::ptrdiff_t>(i));
        break;
      case 1: {
        const McapTreeRecord copy = record;
        records->insert(records->begin() + random_.draw(records->size()), copy);
        break;
      }
      case 2:
        std::swap(record, (*records)[random_.draw(records->size())]);
        break;
      case 3:  // anything
        record.content = bytes_of(random_.mutate({record.content.begin(), record.content.end()}));
        break;
      default:
        change_field(&record.content);
    }
  }

  static McapBytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

  // A number of 2, 4 or 8 bytes somewhere in the content: ids, times, lengths of strings.
  void change_field(McapBytes* content) {
    constexpr size_t kSizes[] = {2, 4, 8};
    static const uint64_t kNumbers[] = {0,          1,          2,     0xFFFF,    0x7FFFFFFF,
                                        0xFFFFFFFF, 1ull << 40, ~0ull, 1ull << 63};
    const size_t size = kSizes[random_.draw(3)];
    if (content->size() < size) return;
    // The front of a record has its fields, the rest is mostly data.
    const size_t reach =
        random_.draw(2) == 0 ? std::min<size_t>(content->size(), 24) : content->size();
    if (reach < size) return;
    const size_t at = random_.draw(reach - size + 1);
    const uint64_t value = kNumbers[random_.draw(std::size(kNumbers))];
    for (size_t k = 0; k < size; ++k) (*content)[at + k] = static_cast<uint8_t>(value >> (8 * k));
  }

  Mutator random_;
};

}  // namespace gloam
