#include "base/memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr uint64_t kMiB = 1 << 20;

/// A made-up proc/ and sys/.
class MemoryTest : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() / ("gloam_memory_test_" + std::to_string(::getpid()));
    fs::remove_all(root_);
    write("proc/meminfo", "MemTotal:  9000000 kB\nMemFree:  100 kB\nMemAvailable:  4096000 kB\n");
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  fs::path root_;
};

TEST_F(MemoryTest, IsWhatTheMachineHas) {
  const MemoryRoom room = memory_room(root_);
  EXPECT_EQ(room.bytes, 4000 * kMiB);
  EXPECT_EQ(room.limit, "the machine's free memory");
}

TEST_F(MemoryTest, GroupsOfVersion2BoundItAndTheirParentsToo) {
  write("proc/self/cgroup", "0::/user/job\n");
  write("sys/fs/cgroup/user/job/memory.max", "max\n");
  write("sys/fs/cgroup/user/job/memory.current", "1048576\n");
  EXPECT_EQ(memory_room(root_).bytes, 4000 * kMiB);
  write("sys/fs/cgroup/user/memory.max", "1073741824\n");                                // 1024 MiB
  write("sys/fs/cgroup/user/memory.current", "524288000\n");                             // 500 MiB
  write("sys/fs/cgroup/user/memory.stat", "anon 1\nfile 2\ninactive_file 104857600\n");  // 100 MiB
  const MemoryRoom room = memory_room(root_);
  EXPECT_EQ(room.bytes, 624 * kMiB) << "files that can be dropped are no use of memory";
  EXPECT_EQ(room.limit, "the memory limit of its control group");
  write("sys/fs/cgroup/user/job/memory.max", "2097152\n");
  EXPECT_EQ(memory_room(root_).bytes, 1 * kMiB);
  write("sys/fs/cgroup/user/job/memory.current", "3145728\n");
  EXPECT_EQ(memory_room(root_).bytes, 0u) << "more in use than allowed";
}

TEST_F(MemoryTest, GroupsOfVersion1BoundIt) {
  write("proc/self/cgroup", "9:cpu,cpuacct:/docker/abc\n4:memory:/docker/abc\n0::/\n");
  // Inside a container: the path is the host's, the files are at the root.
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "2147483648\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "1073741824\n");
  EXPECT_EQ(memory_room(root_).bytes, 1024 * kMiB);
}

TEST_F(MemoryTest, TheProcessesOwnLimitsBoundIt) {
  write("proc/self/status", "Name: x\nVmSize:   1024000 kB\nVmData:  10240 kB\n");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_DATA, &before), 0);
  if (before.rlim_cur != RLIM_INFINITY) GTEST_SKIP() << "there is a limit already";
  rlimit tight = before;
  tight.rlim_cur = rlim_t{1} << 50;  // takes nothing from this process
  ASSERT_EQ(::setrlimit(RLIMIT_DATA, &tight), 0);
  write("proc/meminfo", "MemAvailable: 9007199254740991 kB\n");
  const MemoryRoom room = memory_room(root_);
  ASSERT_EQ(::setrlimit(RLIMIT_DATA, &before), 0);
  EXPECT_EQ(room.bytes, (uint64_t{1} << 50) - 10 * kMiB);
  EXPECT_EQ(room.limit, "its data limit (ulimit -d)");
}

TEST_F(MemoryTest, NothingKnownIsNoBound) {
  fs::remove_all(root_);
  EXPECT_EQ(memory_room(root_).bytes, UINT64_MAX);
}

TEST(CheckMemory, NamesTheNeedTheRoomAndTheHint) {
  EXPECT_TRUE(check_memory(100 * kMiB, "a picture", "").ok());
  const Status status = check_memory(uint64_t{1} << 60, "a picture", "make it smaller");
  ASSERT_FALSE(status.ok());
  const std::string text = status.error().to_string();
  EXPECT_EQ(text.find("a picture needs about 1073741824.0 GiB of memory; the process can use "), 0u)
      << text;
  EXPECT_NE(text.find("(make it smaller)"), std::string::npos) << text;
}

}  // namespace
}  // namespace gloam
