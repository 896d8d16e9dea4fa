#include "sim/snapshots/snapshot_pool.h"

#include <algorithm>
#include <cstddef>

#include "base/check.h"
#include "sim/state/state_layout.h"
#include "world/world.h"

namespace gloam {
namespace {
constexpr size_t kControlBlockBytes = 128;
}

struct SnapshotPool::Slot {
  SnapshotData data;
  Slot* next = nullptr;
  alignas(std::max_align_t) std::byte control_block[kControlBlockBytes];
};

/// Puts the control block of a Snapshot into its slot. The control block is the last thing to go,
/// so freeing it is what returns the slot.
template <class T>
struct SnapshotPool::SlotAllocator {
  using value_type = T;
  std::shared_ptr<SnapshotPool> pool;
  Slot* slot;

  SlotAllocator(std::shared_ptr<SnapshotPool> p, Slot* s) : pool(std::move(p)), slot(s) {}
  template <class U>
  SlotAllocator(const SlotAllocator<U>& other)  // NOLINT: rebinding is implicit
      : pool(other.pool), slot(other.slot) {}

  T* allocate(size_t n) {
    static_assert(sizeof(T) <= kControlBlockBytes);
    GLOAM_CHECK(n == 1, "a slot has room for one control block");
    return reinterpret_cast<T*>(slot->control_block);
  }
  void deallocate(T*, size_t) { pool->put_back(slot); }
  template <class U>
  bool operator==(const SlotAllocator<U>& other) const {
    return slot == other.slot;
  }
};

SnapshotPool::SnapshotPool(std::shared_ptr<const CompiledWorld> world) : world_(std::move(world)) {}
SnapshotPool::~SnapshotPool() = default;

std::shared_ptr<SnapshotPool> SnapshotPool::create(std::shared_ptr<const CompiledWorld> world,
                                                   int slots) {
  std::shared_ptr<SnapshotPool> pool(new SnapshotPool(std::move(world)));
  pool->add_slots(slots);
  return pool;
}

void SnapshotPool::add_slots(int count) {
  for (int i = 0; i < count; ++i) put_back(add_slot());
}

SnapshotPool::Slot* SnapshotPool::add_slot() {
  all_.push_back(std::make_unique<Slot>());
  SnapshotData& data = all_.back()->data;
  data.world = world_;
  data.state.resize(static_cast<size_t>(state_size(*world_->model)));
  data.sensordata.resize(static_cast<size_t>(world_->model->nsensordata));
  data.effects.fit(*world_);
  data.trajectories.resize(static_cast<size_t>(world_->model->njnt));
  slots_.fetch_add(1, std::memory_order_relaxed);
  return all_.back().get();
}

SnapshotPool::Slot* SnapshotPool::take() {
  // Only this thread pops, so a slot at the top cannot leave and come back in between (no ABA).
  Slot* top = free_.load(std::memory_order_acquire);
  while (top != nullptr &&
         !free_.compare_exchange_weak(top, top->next, std::memory_order_acquire)) {
  }
  if (top != nullptr) return top;
  grown_.fetch_add(1, std::memory_order_relaxed);
  return add_slot();
}

void SnapshotPool::put_back(Slot* slot) {
  slot->next = free_.load(std::memory_order_relaxed);
  while (!free_.compare_exchange_weak(slot->next, slot, std::memory_order_release)) {
  }
}

SnapshotData& SnapshotPool::data_of(Slot& slot) { return slot.data; }

Snapshot SnapshotPool::finish(Slot* slot) {
  return Snapshot(std::shared_ptr<const SnapshotData>(
      &slot->data,
      [](SnapshotData* data) {
        data->live.reset();
        std::ranges::fill(data->trajectories, nullptr);
        data->effects.clear();
      },
      SlotAllocator<SnapshotData>(shared_from_this(), slot)));
}

}  // namespace gloam
