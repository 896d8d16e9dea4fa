#pragma once
// libFuzzer's hook for mutations that keep a format's structure.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace gloam {

/// One input in eight changes anywhere, the others by `mutate(text, seed)`.
template <class Mutate>
size_t mutate_structure(uint8_t* data, size_t size, size_t max_size, unsigned seed,
                        const Mutate& mutate) {
  constexpr size_t kLargest = 1 << 16;  // larger ones take too long to be worth it
  if (seed % 8 == 0 || size > kLargest) return LLVMFuzzerMutate(data, size, max_size);
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string changed = mutate(text, seed);
  if (changed == text || changed.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, changed.data(), changed.size());
  return changed.size();
}

}  // namespace gloam
