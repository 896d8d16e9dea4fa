#include "base/cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "base/files.h"
#include "gloam/program.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;
using ::testing::HasSubstr;

class Cache : public ::testing::Test {
 protected:
  Cache() {
    char name[] = "/tmp/gloam_cache_XXXXXX";
    folder_ = ::mkdtemp(name);
    ::setenv("GLOAM_CACHE", (folder_ / "cache").c_str(), 1);
    ::unsetenv("GLOAM_CACHE_SIZE");
  }
  ~Cache() override {
    ::unsetenv("GLOAM_CACHE_SIZE");
    fs::remove_all(folder_);
  }
  static fs::path write(const fs::path& path, const std::string& text, hours age = hours(0)) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    fs::last_write_time(path, fs::file_time_type::clock::now() - age);
    return path;
  }
  static fs::path entry(const CacheFormat& format, uint64_t key) {
    return cache_folder(format) / cache_entry_name(format, key);
  }
  static std::string content(size_t size, char c = 'x') {
    return std::string(kCacheMagic) + std::string(size - kCacheMagic.size(), c);
  }
  static void keep(const fs::path& path, const std::string& text) {
    keep_in_cache(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  }
  fs::path folder_;
};

TEST_F(Cache, OneLimitHoldsForAllKinds) {
  const fs::path a = write(entry(kModelCache, 1), content(1000), hours(4));
  const fs::path b = write(entry(kVisualCache, 2), content(1000), hours(3));
  const fs::path c = write(entry(kModelCache, 3), content(1000), hours(2));
  const fs::path d = write(entry(kVisualCache, 4), content(1000), hours(1));
  trim_cache(4000);
  EXPECT_TRUE(fs::exists(a));
  mark_cache_use(a);
  trim_cache(2500);
  EXPECT_TRUE(fs::exists(a));
  EXPECT_FALSE(fs::exists(b));
  EXPECT_FALSE(fs::exists(c));
  EXPECT_TRUE(fs::exists(d));
  ::setenv("GLOAM_CACHE_SIZE", "2K", 1);
  keep(entry(kVisualCache, 5), content(1000));
  EXPECT_TRUE(fs::exists(entry(kVisualCache, 5)));
  EXPECT_TRUE(fs::exists(a));
  EXPECT_FALSE(fs::exists(d));
  keep(entry(kVisualCache, 6), content(2049));  // more than all may be
  EXPECT_FALSE(fs::exists(entry(kVisualCache, 6)));
  EXPECT_TRUE(fs::exists(a));
  ::setenv("GLOAM_CACHE_SIZE", "0", 1);
  keep(entry(kVisualCache, 7), content(10));
  EXPECT_FALSE(fs::exists(entry(kVisualCache, 7)));
}

TEST_F(Cache, TheLimitIsReadAsASize) {
  const auto limit = [](const char* text) {
    ::setenv("GLOAM_CACHE_SIZE", text, 1);
    return cache_limit();
  };
  EXPECT_EQ(*limit(""), uint64_t{10} << 30);
  EXPECT_EQ(*limit("0"), 0u);
  EXPECT_EQ(*limit("1000"), 1000u);
  EXPECT_EQ(*limit("3K"), 3u << 10);
  EXPECT_EQ(*limit("500M"), 500u << 20);
  EXPECT_EQ(*limit("2T"), uint64_t{2} << 40);
  for (const char* bad :
       {"G", "-1", "1.5G", "10 G", "10GB", "big", "16777216T", "1e9", "99999999999999999999999"}) {
    const Result<uint64_t> result = limit(bad);
    ASSERT_FALSE(result.ok()) << bad;
    EXPECT_THAT(result.error().to_string(), HasSubstr("GLOAM_CACHE_SIZE"));
    EXPECT_FALSE(cache_info().ok());
  }
  keep(entry(kModelCache, 1), content(10));  // the usual limit holds
  EXPECT_TRUE(fs::exists(entry(kModelCache, 1)));
}

TEST_F(Cache, ListsAndClears) {
  const Result<CacheInfo> none = cache_info();
  ASSERT_TRUE(none.ok());
  ASSERT_EQ(none->kinds.size(), 7u);  // models, visuals, bvhs, patterns, light, hulls, scenes
  EXPECT_EQ(none->kinds[0].entries, 0);
  EXPECT_FALSE(none->kinds[0].oldest_use.has_value());
  write(entry(kModelCache, 1), content(1000), hours(5));
  write(entry(kModelCache, 2), content(500), hours(1));
  const fs::path visual = write(entry(kVisualCache, 1), content(70));
  const Result<CacheInfo> info = cache_info();
  ASSERT_TRUE(info.ok());
  EXPECT_EQ(info->folder, folder_ / "cache");
  EXPECT_EQ(info->limit_bytes, uint64_t{10} << 30);
  EXPECT_EQ(info->kinds[0].name, "models");
  EXPECT_EQ(info->kinds[0].entries, 2);
  EXPECT_EQ(info->kinds[0].bytes, 1500u);
  EXPECT_EQ(std::chrono::round<hours>(*info->kinds[0].newest_use - *info->kinds[0].oldest_use),
            hours(4));
  const auto removed = clear_cache("models");
  ASSERT_TRUE(removed.ok());
  ASSERT_EQ(removed->size(), 1u);
  EXPECT_EQ((*removed)[0].entries, 2);
  EXPECT_TRUE(fs::is_empty(cache_folder(kModelCache)));
  EXPECT_TRUE(fs::exists(visual));
  EXPECT_TRUE(clear_cache().ok());
  EXPECT_FALSE(fs::exists(visual));
  const auto wrong = clear_cache("modles");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(wrong.error().to_string(), HasSubstr("did you mean 'models'?"));
}

// GLOAM_CACHE may be set to a folder in which people keep their own "models".
TEST_F(Cache, OnlyEntriesAreEverRemoved) {
  const fs::path models = cache_folder(kModelCache);
  const std::string theirs = content(5000);
  const fs::path outside = write(folder_ / "outside.world", theirs);
  std::vector<fs::path> kept = {
      write(models / "net.pt", theirs),
      write(models / "0123456789abcdef", theirs),
      write(models / "0123456789abcdef.model", theirs),  // of the other kind
      write(models / "0123456789ABCDEF.world", theirs),
      write(models / "0123456789abcdef0.world", theirs),
      write(models / "0123456789abcdef.world.bak", theirs, hours(100)),
      write(models / "0123456789abcdef.world.notes.tmp", theirs, hours(100)),
      write(models / "00000000000000aa.world", "their own bytes"),
      write(models / "deeper/0123456789abcdef.world", theirs),
      write(folder_ / "cache/0123456789abcdef.world", theirs),
      outside};
  fs::create_symlink(outside, models / "1111111111111111.world");
  fs::create_directory(models / "2222222222222222.world");
  const fs::path own = write(models / "0123456789abcdef.world", theirs);
  const fs::path empty = write(models / "0123456789abcd00.world", "");
  const fs::path left = write(models / "00000000000000bb.world.89ab.tmp", theirs, hours(2));
  const fs::path writing = write(models / "00000000000000cc.world.89ab.tmp", theirs);
  EXPECT_EQ(cache_info()->kinds[0].entries, 2);
  trim_cache(10000);
  EXPECT_TRUE(fs::exists(own));
  EXPECT_FALSE(fs::exists(left));  // by a writer that died
  EXPECT_TRUE(fs::exists(writing));
  trim_cache(0);
  EXPECT_TRUE(fs::exists(writing));
  EXPECT_FALSE(fs::exists(own));
  write(own, theirs);
  write(empty, "");
  EXPECT_TRUE(clear_cache().ok());
  for (const fs::path& gone : {own, empty, writing}) EXPECT_FALSE(fs::exists(gone)) << gone;
  for (const fs::path& file : kept) EXPECT_TRUE(fs::exists(file)) << file;
  EXPECT_TRUE(fs::is_symlink(models / "1111111111111111.world"));
  EXPECT_TRUE(fs::is_directory(models / "2222222222222222.world"));
}

TEST_F(Cache, FoldersThatCannotBeUsedAreSaid) {
  write(folder_ / "cache/models", "a file");
  const Result<CacheInfo> info = cache_info();
  ASSERT_FALSE(info.ok());
  EXPECT_THAT(info.error().to_string(), HasSubstr("cannot read the cache"));
  EXPECT_FALSE(clear_cache().ok());
  keep(entry(kModelCache, 1), content(10));  // no error
  trim_cache(0);
  if (::geteuid() == 0) return;  // may write everywhere
  fs::remove(folder_ / "cache/models");
  write(entry(kModelCache, 1), content(10));
  fs::permissions(cache_folder(kModelCache), fs::perms::owner_read | fs::perms::owner_exec);
  const auto removed = clear_cache();
  fs::permissions(cache_folder(kModelCache), fs::perms::owner_all);
  ASSERT_FALSE(removed.ok());
  EXPECT_THAT(removed.error().to_string(), HasSubstr("cannot remove"));
}

// Every content that a reader sees is one that some writer wrote, whole; nothing is left behind.
TEST_F(Cache, ThreadsAndProcessesMayRace) {
#ifdef __has_feature
#if __has_feature(thread_sanitizer)
  GTEST_SKIP() << "the thread sanitizer has no threads in a forked process";
#endif
#endif
  constexpr int kProcesses = 3, kThreads = 2, kRounds = 150;
  constexpr size_t kSize = 200'000;
  const fs::path shared = entry(kModelCache, 7);
  const auto work = [&](int who) {
    bool good = true;
    for (int i = 0; i < kRounds; ++i) {
      const std::string text =
          content(kSize + static_cast<size_t>(who), static_cast<char>('a' + who));
      keep(shared, text);
      keep(entry(kVisualCache, static_cast<uint64_t>(i % 5)), text);
      if (i % 10 == who) trim_cache(3 * kSize);
      const Result<std::string> read = read_text_file(shared);
      if (!read.ok()) continue;  // dropped
      const size_t other = read->size() - kSize;
      good = good && other < kProcesses * kThreads &&
             *read == content(read->size(), static_cast<char>('a' + other));
    }
    return good;
  };
  std::vector<pid_t> children;
  for (int p = 0; p < kProcesses; ++p) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      bool good[kThreads] = {};
      {
        std::vector<std::jthread> threads;
        for (int t = 0; t < kThreads; ++t)
          threads.emplace_back([&, t] { good[t] = work(p * kThreads + t); });
      }
      ::_exit(good[0] && good[1] ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  for (const CacheFormat& format : {kModelCache, kVisualCache})
    for (const auto& file : fs::directory_iterator(cache_folder(format)))
      EXPECT_EQ(file.path().extension(), format.ending);
  keep(shared, content(100));
  mark_cache_use(shared);  // the file system's own clock is coarse
  trim_cache(100);
  EXPECT_EQ(cache_info()->kinds[0].bytes + cache_info()->kinds[1].bytes, 100u);
}

}  // namespace
}  // namespace gloam
