// Rings in shared memory: what a reader sees, what is overwritten, what a killed writer leaves.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

#include "bridge/zmq/streams/shared_ring.h"

namespace gloam::bridge::zeromq {
namespace {

bool exists(const std::string& name) { return access(("/dev/shm" + name).c_str(), F_OK) == 0; }

/// A reader by the documented layout alone.
class RingReader {
 public:
  explicit RingReader(const SharedRing& ring) : size_(ring.total_bytes()) {
    const int fd = shm_open(ring.name().c_str(), O_RDONLY, 0);
    memory_ = static_cast<const uint8_t*>(mmap(nullptr, size_, PROT_READ, MAP_SHARED, fd, 0));
    close(fd);
  }
  ~RingReader() { munmap(const_cast<uint8_t*>(memory_), size_); }
  template <class T>
  T at(size_t offset) const {
    T value;
    std::memcpy(&value, memory_ + offset, sizeof value);
    return value;
  }
  uint64_t sequence(uint32_t slot) const { return at<uint64_t>(64 + 16 * slot); }
  std::string text(size_t offset, size_t size) const {
    return {reinterpret_cast<const char*>(memory_) + offset, size};
  }

 private:
  const size_t size_;
  const uint8_t* memory_;
};

std::span<const uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

TEST(ZmqSharedRing, ReadersSeeMessagesAndWhatWasOverwritten) {
  const auto ring = SharedRing::create(100);
  ASSERT_TRUE(ring.ok()) << ring.error().to_string();
  const RingReader reader(**ring);
  EXPECT_EQ(reader.text(0, 8), "GLOAMSHM");
  EXPECT_EQ(reader.at<uint32_t>(8), 1u);
  const auto slots = reader.at<uint32_t>(12);
  const SharedRing::Slot first = (*ring)->write(bytes_of("first"));
  EXPECT_EQ(reader.sequence(first.slot), first.sequence);
  EXPECT_EQ(reader.text(first.offset, 5), "first");
  for (uint32_t i = 1; i < slots; ++i) {
    const SharedRing::Slot next = (*ring)->write(bytes_of("next"));
    EXPECT_NE(next.slot, first.slot);
  }
  EXPECT_EQ(reader.sequence(first.slot), first.sequence) << "still there";
  const SharedRing::Slot again = (*ring)->write(bytes_of("again"));
  EXPECT_EQ(again.slot, first.slot);
  EXPECT_NE(reader.sequence(first.slot), first.sequence) << "overwritten";
}

TEST(ZmqSharedRing, IsPrivateAndGoesWithItsWriter) {
  std::string name;
  {
    const auto ring = SharedRing::create(1 << 20);
    ASSERT_TRUE(ring.ok());
    name = (*ring)->name();
    struct stat about = {};
    ASSERT_EQ(stat(("/dev/shm" + name).c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777, 0600u);
    remove_stale_rings();
    EXPECT_TRUE(exists(name)) << "its writer lives";
  }
  EXPECT_FALSE(exists(name));
}

TEST(ZmqSharedRing, OfAKilledWriterIsRemovedAtTheNextStart) {
  int pipes[2];
  ASSERT_EQ(pipe(pipes), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto ring = SharedRing::create(100);
    const std::string name = ring.ok() ? (*ring)->name() : "";
    (void)!write(pipes[1], name.data(), name.size());
    close(pipes[1]);
    pause();
    _exit(0);
  }
  close(pipes[1]);
  char name[128] = {};
  ASSERT_GT(read(pipes[0], name, sizeof name - 1), 0);
  close(pipes[0]);
  EXPECT_TRUE(exists(name));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(exists(name));
  EXPECT_GE(remove_stale_rings(), 1);
  EXPECT_FALSE(exists(name));
}

TEST(ZmqSharedRing, OfMoreThanThereIsIsAnError) {
  EXPECT_FALSE(SharedRing::create(size_t{1} << 40).ok());
}

}  // namespace
}  // namespace gloam::bridge::zeromq
