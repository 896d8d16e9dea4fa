#pragma once
// Random choices of a generator, one after the other. What comes out is a function of seed and name
// alone; another part of the place has other dice and is not disturbed by more throws here.

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "base/hash.h"
#include "base/rng.h"

namespace gloam {

class Dice {
 public:
  Dice(uint64_t seed, std::string_view name)
      : random_{seed, static_cast<uint32_t>(hash_bytes(name.data(), name.size()))} {}

  double uniform() { return random_.uniform(throws_++, 0); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// low … high, both included.
  int integer(int low, int high) {
    return std::min(high, low + static_cast<int>(uniform() * (high - low + 1)));
  }
  bool chance(double probability) { return uniform() < probability; }
  template <class T>
  T pick(std::initializer_list<T> list) {
    return list.begin()[integer(0, static_cast<int>(list.size()) - 1)];
  }
  template <class T>
  const T& pick(const std::vector<T>& list) {
    return list[static_cast<size_t>(integer(0, static_cast<int>(list.size()) - 1))];
  }
  template <class T>
  void shuffle(std::vector<T>* list) {
    for (int i = static_cast<int>(list->size()) - 1; i > 0; --i)
      std::swap((*list)[static_cast<size_t>(i)], (*list)[static_cast<size_t>(integer(0, i))]);
  }
  /// A seed for something of its own.
  uint64_t seed() {
    const Philox4 d = random_.draw(throws_++, 0);
    return (static_cast<uint64_t>(d.v[0]) << 32) | d.v[1];
  }

 private:
  RandomStream random_;
  uint64_t throws_ = 0;
};

}  // namespace gloam
