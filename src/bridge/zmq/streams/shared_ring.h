#pragma once
// SharedRing: messages for readers on this machine, in POSIX shared memory, read where they stand.
//
// Little endian. Head of 4096 bytes: "GLOAMSHM", u32 version 1, u32 slots, u64 bytes of a slot;
// from byte 64 on for each slot u64 sequence, u64 bytes of its message. Slots follow, each begins
// on a page. A slot's sequence is odd while it is written; a reader compares it with the sequence
// of the message's header before and after it reads: another one means that the slot was
// overwritten. The object has mode 600; its writer holds a lock (flock) on it while it lives.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gloam/result.h"

namespace gloam::bridge::zeromq {

/// Removes objects of this user whose writers were killed. Returns how many.
int remove_stale_rings();

/// Used by one thread at a time. The object is unlinked at its end.
class SharedRing {
 public:
  struct Slot {
    uint32_t slot = 0;
    uint64_t sequence = 0;
    uint64_t offset = 0;  ///< of the message in the object [B]
  };

  /// For messages of `bytes` or fewer. Errors: no shared memory, no room in it.
  static Result<std::unique_ptr<SharedRing>> create(size_t bytes);
  ~SharedRing();
  SharedRing(const SharedRing&) = delete;
  SharedRing& operator=(const SharedRing&) = delete;

  const std::string& name() const { return name_; }  ///< of shm_open, "/gloam-zmq-…"
  size_t slot_bytes() const { return slot_bytes_; }
  size_t total_bytes() const { return total_bytes_; }
  /// Writes into the oldest slot; `message` is no larger than slot_bytes().
  Slot write(std::span<const uint8_t> message);

 private:
  SharedRing(std::string name, int fd) : name_(std::move(name)), fd_(fd) {}
  Status map(size_t bytes);

  const std::string name_;
  const int fd_;  // holds the lock
  size_t slot_bytes_ = 0, total_bytes_ = 0;
  uint8_t* memory_ = nullptr;
  uint64_t written_ = 0;
};

}  // namespace gloam::bridge::zeromq
