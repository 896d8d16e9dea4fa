#pragma once
// A bounded queue that any number of threads may push to and pop from without locks or allocation.
// Each cell carries a ticket that says whose turn it is (D. Vyukov, "Bounded MPMC queue").

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "base/check.h"

namespace gloam {

template <class T>
class LockFreeQueue {
 public:
  /// Holds `capacity` items, at least 2.
  explicit LockFreeQueue(int capacity)
      : capacity_(static_cast<uint64_t>(capacity)),
        cells_(new Cell[static_cast<size_t>(capacity)]) {
    GLOAM_CHECK(capacity >= 2, "a queue needs a capacity of at least 2");
    for (uint64_t i = 0; i < capacity_; ++i) cells_[i].ticket.store(i, std::memory_order_relaxed);
  }

  /// False when it is full; `item` is then left as it was.
  bool try_push(T& item) {
    uint64_t position = tail_.load(std::memory_order_relaxed);
    for (;;) {
      Cell& cell = cells_[position % capacity_];
      const uint64_t ticket = cell.ticket.load(std::memory_order_acquire);
      if (ticket == position) {
        if (tail_.compare_exchange_weak(position, position + 1, std::memory_order_relaxed)) {
          cell.item = std::move(item);
          cell.ticket.store(position + 1, std::memory_order_release);
          return true;
        }
      } else if (ticket < position) {
        return false;
      } else {
        position = tail_.load(std::memory_order_relaxed);
      }
    }
  }

  /// False when there is nothing, or when the oldest item is still being written.
  bool try_pop(T& item) {
    uint64_t position = head_.load(std::memory_order_relaxed);
    for (;;) {
      Cell& cell = cells_[position % capacity_];
      const uint64_t ticket = cell.ticket.load(std::memory_order_acquire);
      if (ticket == position + 1) {
        if (head_.compare_exchange_weak(position, position + 1, std::memory_order_relaxed)) {
          item = std::exchange(cell.item, T{});
          cell.ticket.store(position + capacity_, std::memory_order_release);
          return true;
        }
      } else if (ticket < position + 1) {
        return false;
      } else {
        position = head_.load(std::memory_order_relaxed);
      }
    }
  }

  /// Items held; a moment later it may be another number.
  int64_t size() const {
    const uint64_t head = head_.load(std::memory_order_acquire);
    const uint64_t tail = tail_.load(std::memory_order_acquire);
    return tail > head ? static_cast<int64_t>(tail - head) : 0;
  }
  int64_t capacity() const { return static_cast<int64_t>(capacity_); }

 private:
  struct Cell {
    std::atomic<uint64_t> ticket;
    T item{};
  };
  const uint64_t capacity_;
  std::unique_ptr<Cell[]> cells_;
  alignas(64) std::atomic<uint64_t> head_{0};
  alignas(64) std::atomic<uint64_t> tail_{0};
};

}  // namespace gloam
