#pragma once
// Damaged files for tests of readers.

#include <algorithm>
#include <cstdlib>
#include <string>

#include "base/rng.h"

namespace gloam {

class Mutator {
 public:
  explicit Mutator(uint64_t seed) : stream_{seed, 77} {}
  uint32_t draw(size_t n) { return static_cast<uint32_t>(stream_.draw(0, count_++).v[0] % n); }

  // Flipped bits, changed bytes and digits, cuts, copies of a part over another.
  std::string mutate(std::string text) {
    for (uint32_t times = 1 + draw(4); times > 0 && !text.empty(); --times) {
      const size_t at = draw(text.size());
      switch (draw(7)) {
        case 0:
          text[at] = static_cast<char>(text[at] ^ (1 << draw(8)));
          break;
        case 1:
          text[at] = static_cast<char>(draw(256));
          break;
        case 2:
          text.resize(at);
          break;
        case 3:
          text.erase(at, 1 + draw(64));
          break;
        case 4:
          text.insert(draw(text.size()), text.substr(at, 1 + draw(64)));
          break;
        case 5: {
          const std::string part = text.substr(at, 1 + draw(16));
          text.replace(std::min<size_t>(draw(text.size()), text.size() - part.size()), part.size(),
                       part);
          break;
        }
        default: {  // a number becomes another that tends to break things
          static const char* const kNumbers[] = {
              "-1", "0", "4294967296", "1e39", "99999999", "1099511627776", "nan", "2147483647"};
          const size_t digit = text.find_first_of("0123456789", at);
          if (digit == std::string::npos) break;
          text.replace(digit, 1, kNumbers[draw(8)]);
        }
      }
    }
    return text;
  }

 private:
  RandomStream stream_;
  uint32_t count_ = 0;
};

/// Damaged files per reader: GLOAM_MUTATIONS, or 200.
inline size_t mutation_count() {
  const char* count = std::getenv("GLOAM_MUTATIONS");
  return count != nullptr ? static_cast<size_t>(std::atoi(count)) : 200;
}

}  // namespace gloam
