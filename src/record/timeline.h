#pragma once
// A bounded, evenly spaced selection of a stream whose length is not known in advance.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gloam {

/// Keeps every stride-th item; when `capacity` is reached every second one goes and the stride
/// doubles. So between capacity / 2 and capacity items are kept, whatever the length.
template <class T>
class Timeline {
 public:
  explicit Timeline(size_t capacity) : capacity_(capacity) {}

  /// True if the next item will be kept: then make it and add() it, else skip().
  bool wants_next() const { return count_ % stride_ == 0; }
  void skip() { ++count_; }
  void add(T item) {
    if (items_.size() == capacity_) {
      for (size_t i = 1; 2 * i < items_.size(); ++i) items_[i] = std::move(items_[2 * i]);
      items_.resize((items_.size() + 1) / 2);
      stride_ *= 2;
      if (!wants_next()) {
        skip();
        return;
      }
    }
    items_.push_back(std::move(item));
    skip();
  }
  const std::vector<T>& items() const { return items_; }

 private:
  size_t capacity_;
  uint64_t stride_ = 1, count_ = 0;
  std::vector<T> items_;
};

}  // namespace gloam
