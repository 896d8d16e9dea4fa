#include "base/cache_writer.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "base/cache.h"
#include "base/log.h"

namespace gloam {
namespace {

using Clock = std::chrono::steady_clock;

// A program that has just read a scene goes on to start up; entries can wait for that.
constexpr std::chrono::seconds kStartUp{2};
constexpr uint64_t kMostHeld = uint64_t{1} << 30;

struct CacheWrite {
  std::filesystem::path path;
  uint64_t magic;
  uint64_t held;  // [bytes]
  std::function<std::vector<uint8_t>()> make;
  Clock::time_point due;
};

// Without memory there is no entry: the program needs none.
void write(const CacheWrite& job) {
  try {
    std::vector<uint8_t> entry = job.make();
    if (entry.empty()) return;
    seal_cache_entry(job.magic, &entry);
    keep_in_cache(job.path, entry);
  } catch (const std::bad_alloc&) {
    log_debug("not enough memory to cache {}", job.path.string());
  }
}

class CacheWriter {
 public:
  ~CacheWriter() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  void add(CacheWrite job) {
    {
      const std::lock_guard lock(mutex_);
      if (held_ + job.held <= kMostHeld) {
        held_ += job.held;
        jobs_.push_back(std::move(job));
        if (start_thread()) return;
        held_ -= jobs_.back().held;
        job = std::move(jobs_.back());
        jobs_.pop_back();
      }
    }
    write(job);
  }

  void finish() {
    std::unique_lock lock(mutex_);
    ++waiting_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return jobs_.empty(); });
    --waiting_;
  }

 private:
  /// False: there is no room for its stack, so that nobody would ever write.
  bool start_thread() {
    try {
      if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    } catch (const std::system_error&) {
      return false;
    }
    changed_.notify_all();
    return true;
  }

  void run() {
    std::unique_lock lock(mutex_);
    const auto is_hurried = [this] { return ends_ || waiting_ > 0; };
    while (true) {
      changed_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
      if (jobs_.empty()) return;
      changed_.wait_until(lock, jobs_.front().due, is_hurried);
      const CacheWrite& job = jobs_.front();  // stays in its place while others are added
      lock.unlock();
      write(job);
      lock.lock();
      held_ -= job.held;
      jobs_.pop_front();
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<CacheWrite> jobs_;  // the first is being written, or about to be
  uint64_t held_ = 0;            // by all jobs [bytes]
  int waiting_ = 0;              // calls of finish()
  bool ends_ = false;
  std::thread thread_;
};

CacheWriter& cache_writer() {
  static CacheWriter writer;
  return writer;
}

}  // namespace

void keep_in_cache_later(const std::filesystem::path& path, uint64_t magic, uint64_t held,
                         std::function<std::vector<uint8_t>()> make) {
  cache_writer().add({path, magic, held, std::move(make), Clock::now() + kStartUp});
}

void keep_in_cache_later(const std::filesystem::path& path, uint64_t magic,
                         std::vector<uint8_t> entry) {
  const uint64_t held = entry.capacity();
  auto kept = std::make_shared<std::vector<uint8_t>>(std::move(entry));
  keep_in_cache_later(path, magic, held, [kept] { return std::move(*kept); });
}

void finish_cache_writes() { cache_writer().finish(); }

}  // namespace gloam
