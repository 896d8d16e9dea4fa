#pragma once
// Messages with random contents, for round trips.

#include "base/rng.h"
#include "ros/message.h"

namespace gloam {

class RandomMessage {
 public:
  explicit RandomMessage(uint64_t seed) : stream_{seed, stream_id("topics.test")} {}

  uint32_t draw(uint32_t n) { return stream_.draw(0, count_++).v[0] % n; }

  template <class T>
  void fill(T* value) {
    if constexpr (Message<T>) {
      std::apply([&](auto&... field) { (fill(&field), ...); }, value->members());
    } else if constexpr (std::same_as<T, bool>) {
      *value = draw(2) == 1;
    } else if constexpr (std::is_floating_point_v<T>) {
      *value = static_cast<T>(stream_.uniform(1, count_++) * 2000 - 1000);
    } else if constexpr (CdrPrimitive<T>) {
      const Philox4 bits = stream_.draw(2, count_++);
      std::memcpy(value, bits.v, sizeof(T));
    } else if constexpr (std::derived_from<T, std::string>) {
      value->clear();
      for (uint32_t n = draw(12); n > 0; --n) value->push_back(static_cast<char>('a' + draw(26)));
    } else if constexpr (std::same_as<T, Bytes>) {
      std::vector<uint8_t> bytes(draw(20));
      for (uint8_t& byte : bytes) fill(&byte);
      *value = std::move(bytes);
    } else if constexpr (std::same_as<T, Bools>) {
      value->resize(draw(20));
      for (uint8_t& element : *value) element = static_cast<uint8_t>(draw(2));
    } else {
      constexpr uint32_t kMost = FieldTraits<T>::kSize > 0 ? FieldTraits<T>::kSize : 3;
      if constexpr (FieldTraits<T>::kIsSequence) value->resize(draw(kMost + 1));
      for (auto& element : *value) fill(&element);
    }
  }

 private:
  RandomStream stream_;
  uint32_t count_ = 0;
};

template <Message T>
T random_message(uint64_t seed) {
  T message;
  RandomMessage(seed).fill(&message);
  return message;
}

}  // namespace gloam
