#include "world/compile/progress/long_wait.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/log.h"

namespace gloam {

LongWait::LongWait(std::string what, double expected)
    : what_(std::move(what)), expected_(expected), thread_([this] { run(); }) {}

LongWait::~LongWait() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LongWait::run() {
  using Seconds = std::chrono::duration<double>;
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  for (double pause = 2; !changed_.wait_for(lock, Seconds(pause), [this] { return done_; });
       pause = std::min(pause * 2, 10.0)) {
    const double passed = Seconds(std::chrono::steady_clock::now() - start).count();
    const double left = expected_ - passed;
    log_info("{}: {:.0f} s{}", what_, passed,
             left > 0 ? fmt::format(", about {:.0f} s left", left) : "");
  }
}

}  // namespace gloam
