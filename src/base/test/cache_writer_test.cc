#include "base/cache_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "base/cache.h"
#include "base/files.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMagic = 0x30545345544F4C47ull;

std::vector<uint8_t> entry_of(uint8_t content) {
  std::vector<uint8_t> entry;
  begin_cache_entry(&entry);
  entry.insert(entry.end(), 1000, content);
  return entry;
}

class CacheWriterTest : public ::testing::Test {
 protected:
  CacheWriterTest() {
    char name[] = "/tmp/gloam_writer_XXXXXX";
    folder_ = ::mkdtemp(name);
    ::setenv("GLOAM_CACHE", folder_.c_str(), 1);
  }
  ~CacheWriterTest() override {
    finish_cache_writes();
    fs::remove_all(folder_);
    ::unsetenv("GLOAM_CACHE");
  }
  fs::path path(uint64_t key) const {
    return cache_folder(kVisualCache) / cache_entry_name(kVisualCache, key);
  }
  bool holds(uint64_t key, uint8_t content) const {
    const auto bytes = read_file(path(key));
    if (!bytes.ok()) return false;
    const auto rest = unseal_cache_entry(kMagic, *bytes);
    return rest.size() == 1000 && rest[0] == content && rest[999] == content;
  }
  fs::path folder_;
};

TEST_F(CacheWriterTest, WritesWhatManyThreadsKeep) {
  std::vector<std::thread> threads;
  for (uint8_t t = 0; t < 4; ++t) {
    threads.emplace_back([this, t] {
      for (uint8_t i = 0; i < 10; ++i)
        keep_in_cache_later(path(t * 10u + i), kMagic, entry_of(static_cast<uint8_t>(t + i)));
      finish_cache_writes();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (uint8_t t = 0; t < 4; ++t)
    for (uint8_t i = 0; i < 10; ++i)
      EXPECT_TRUE(holds(t * 10u + i, static_cast<uint8_t>(t + i))) << t << " " << i;
}

TEST_F(CacheWriterTest, TheLastOfOneNameStays) {
  for (const uint8_t content : {1, 2, 3}) keep_in_cache_later(path(7), kMagic, entry_of(content));
  finish_cache_writes();
  EXPECT_TRUE(holds(7, 3));
}

TEST_F(CacheWriterTest, ACallerWritesWhereTooMuchWaits) {
  const auto caller = std::this_thread::get_id();
  std::thread::id large, small;
  keep_in_cache_later(path(1), kMagic, uint64_t{2} << 30, [&] {
    large = std::this_thread::get_id();
    return entry_of(1);
  });
  EXPECT_EQ(large, caller);
  EXPECT_TRUE(holds(1, 1));
  keep_in_cache_later(path(2), kMagic, uint64_t{1} << 20, [&] {
    small = std::this_thread::get_id();
    return entry_of(2);
  });
  finish_cache_writes();
  EXPECT_NE(small, caller);
  EXPECT_TRUE(holds(2, 2));
}

TEST_F(CacheWriterTest, NothingIsKeptOfNothingNorWhereNothingCanBe) {
  keep_in_cache_later(path(1), kMagic, 0, [] { return std::vector<uint8_t>(); });
  std::ofstream(folder_ / "file") << "no folder";
  keep_in_cache_later(folder_ / "file" / "x", kMagic, entry_of(1));
  finish_cache_writes();
  EXPECT_FALSE(fs::exists(path(1)));
  EXPECT_EQ(fs::file_size(folder_ / "file"), 9u);
}

}  // namespace
}  // namespace gloam
