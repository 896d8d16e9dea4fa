#pragma once
// Snapshots are made on the sim thread without allocating: their buffers and their shared_ptr's
// control blocks live in slots that are used again when the last reader lets go.

#include <atomic>
#include <memory>
#include <vector>

#include "sim/snapshots/snapshot.h"

namespace gloam {

class SnapshotPool : public std::enable_shared_from_this<SnapshotPool> {
 public:
  /// `slots` Snapshots of `world`, made at once.
  static std::shared_ptr<SnapshotPool> create(std::shared_ptr<const CompiledWorld> world,
                                              int slots);
  ~SnapshotPool();

  /// A Snapshot to be filled by `fill(SnapshotData&)`; its buffers have their final size. One
  /// thread at a time may call it; any thread may let go of what it returns, also after the pool's
  /// owner is gone. Allocates only when every slot is held by a reader, which `grown` counts.
  template <class Fill>
  Snapshot make(Fill&& fill) {
    Slot* slot = take();
    fill(data_of(*slot));
    return finish(slot);
  }

  /// Makes room for `count` more Snapshots at once. Same thread as make().
  void add_slots(int count);

  int64_t slots() const { return slots_.load(std::memory_order_relaxed); }
  /// Slots added because readers held all the others.
  int64_t grown() const { return grown_.load(std::memory_order_relaxed); }

 private:
  struct Slot;
  template <class T>
  struct SlotAllocator;

  explicit SnapshotPool(std::shared_ptr<const CompiledWorld> world);
  Slot* take();
  Slot* add_slot();
  void put_back(Slot* slot);
  static SnapshotData& data_of(Slot& slot);
  Snapshot finish(Slot* slot);

  std::shared_ptr<const CompiledWorld> world_;
  std::vector<std::unique_ptr<Slot>> all_;
  std::atomic<Slot*> free_{nullptr};  // stack: many threads push, only the sim thread pops
  std::atomic<int64_t> slots_{0}, grown_{0};
};

}  // namespace gloam
