#include "bridge/zmq/streams/shared_ring.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <new>
#include <string_view>
#include <vector>

#include "web/access.h"

namespace gloam::bridge::zeromq {
namespace {

constexpr std::string_view kPrefix = "gloam-zmq-";
constexpr const char* kFolder = "/dev/shm";
constexpr size_t kPage = 4096;
constexpr uint32_t kSlots = 8;
constexpr size_t kMaxSlot = size_t{1} << 30;

struct RingHead {
  char magic[8];
  uint32_t version, slots;
  uint64_t slot_bytes;
};
struct SlotHead {
  std::atomic<uint64_t> sequence;
  std::atomic<uint64_t> bytes;
};
constexpr size_t kSlotHeads = 64;
static_assert(sizeof(RingHead) <= kSlotHeads && sizeof(SlotHead) == 16);
static_assert(kSlotHeads + kSlots * sizeof(SlotHead) <= kPage);

SlotHead* slot_head(uint8_t* memory, uint32_t slot) {
  return reinterpret_cast<SlotHead*>(memory + kSlotHeads) + slot;
}

// An object without a lock is a killed writer's; one without a size has only just been made.
bool is_stale(const std::string& name) {
  const int fd = shm_open(name.c_str(), O_RDWR | O_CLOEXEC, 0);
  if (fd < 0) return false;
  struct stat about = {};
  const bool is_ours = fstat(fd, &about) == 0 && about.st_uid == geteuid() && about.st_size > 0;
  const bool stale = is_ours && flock(fd, LOCK_EX | LOCK_NB) == 0;
  close(fd);
  return stale;
}

Error ring_error(std::string_view what) {
  return {ErrorKind::kIo,
          fmt::format("shared memory: {}: {}", what, std::strerror(errno)),
          {},
          "free some space in /dev/shm, or set [bridge.zmq] shared_memory = false"};
}

}  // namespace

int remove_stale_rings() {
  DIR* folder = opendir(kFolder);
  if (folder == nullptr) return 0;
  std::vector<std::string> names;
  while (const dirent* entry = readdir(folder))
    if (std::string_view(entry->d_name).starts_with(kPrefix))
      names.push_back(fmt::format("/{}", entry->d_name));
  closedir(folder);
  int removed = 0;
  for (const std::string& name : names)
    if (is_stale(name) && shm_unlink(name.c_str()) == 0) ++removed;
  return removed;
}

Result<std::unique_ptr<SharedRing>> SharedRing::create(size_t bytes) {
  if (bytes > kMaxSlot)
    return Error{ErrorKind::kUnsupported, "a message is too large for shared memory"};
  GLOAM_TRY(const std::string token, web::make_token());
  std::string name = fmt::format("/{}{}-{}", kPrefix, getpid(), token.substr(0, 16));
  const int fd = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) return ring_error("cannot be created");
  std::unique_ptr<SharedRing> ring(new SharedRing(std::move(name), fd));
  if (flock(fd, LOCK_EX) != 0) return ring_error("cannot be locked");
  GLOAM_TRY_STATUS(ring->map(bytes));
  return ring;
}

Status SharedRing::map(size_t bytes) {
  slot_bytes_ = (std::max<size_t>(bytes, 1) + kPage - 1) / kPage * kPage;
  total_bytes_ = kPage + kSlots * slot_bytes_;
  // Pages are taken now: a full /dev/shm would end the program at a write.
  if (const int fault = posix_fallocate(fd_, 0, static_cast<off_t>(total_bytes_)); fault != 0) {
    errno = fault;
    return ring_error("no space left");
  }
  void* memory = mmap(nullptr, total_bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, 0);
  if (memory == MAP_FAILED) return ring_error("cannot be mapped");
  memory_ = static_cast<uint8_t*>(memory);
  for (uint32_t slot = 0; slot < kSlots; ++slot) new (slot_head(memory_, slot)) SlotHead{0, 0};
  const RingHead head = {{'G', 'L', 'O', 'A', 'M', 'S', 'H', 'M'}, 1, kSlots, slot_bytes_};
  std::memcpy(memory_, &head, sizeof head);
  return {};
}

SharedRing::~SharedRing() {
  if (memory_ != nullptr) munmap(memory_, total_bytes_);
  shm_unlink(name_.c_str());
  close(fd_);
}

SharedRing::Slot SharedRing::write(std::span<const uint8_t> message) {
  const auto index = static_cast<uint32_t>(written_ % kSlots);
  const uint64_t round = written_ / kSlots;
  SlotHead* head = slot_head(memory_, index);
  Slot slot{.slot = index, .sequence = 2 * round + 2, .offset = kPage + index * slot_bytes_};
  head->sequence.store(slot.sequence - 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);  // odd is seen before any new byte
  std::memcpy(memory_ + slot.offset, message.data(), message.size());
  head->bytes.store(message.size(), std::memory_order_relaxed);
  head->sequence.store(slot.sequence, std::memory_order_release);
  ++written_;
  return slot;
}

}  // namespace gloam::bridge::zeromq
