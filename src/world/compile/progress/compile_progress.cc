#include "world/compile/progress/compile_progress.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gloam {
namespace {

using Seconds = std::chrono::duration<double>;
constexpr Seconds kInterval{0.1};
// Progress by the clock of a stage that was expected to take `expected`: as expected at first, then
// ever slower, so that it never stops and never reaches the end by itself.
double expected_share(double passed, double expected) {
  constexpr double kAsExpected = 0.8;
  const double x = passed / expected;
  if (x <= kAsExpected) return x;
  return 1 - (1 - kAsExpected) * std::exp((kAsExpected - x) / (1 - kAsExpected));
}

constexpr double kMinFractionForEstimate =
    0.02;  // fraction after which the remaining time is estimated

double passed_since(std::chrono::steady_clock::time_point start) {
  return Seconds(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

CompileProgress::CompileProgress(const ProgressCallback& callback, double weights)
    : callback_(callback), weights_(weights) {
  if (callback_) thread_ = std::thread([this] { run(); });
}

CompileProgress::~CompileProgress() { stop(); }

Status CompileProgress::check() const {
  if (!cancelled_) return {};
  return Error{ErrorKind::kInterrupted, "the compilation was cancelled"};
}

void CompileProgress::begin(std::string what, double weight, double expected) {
  const std::lock_guard lock(mutex_);
  before_ += weight_;
  weight_ = weight;
  share_ = 0;
  what_ = std::move(what);
  expected_ = expected;
  begun_ = std::chrono::steady_clock::now();
}

void CompileProgress::report(double share) {
  const std::lock_guard lock(mutex_);
  share_ = std::max(share_, std::min(share, 1.0));
}

void CompileProgress::report(double share, std::string what) {
  report(share);
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
}

Progress CompileProgress::state(bool is_all) const {
  const std::lock_guard lock(mutex_);
  Progress out{what_, 0, passed_since(start_), -1};
  const double passed = passed_since(begun_);
  double share = share_;
  if (share > kMinFractionForEstimate) out.left = passed * (1 - share) / share;
  if (expected_ > 0) {
    const double by_clock = expected_share(passed, expected_);
    if (by_clock > share) {
      share = by_clock;
      out.left = passed < expected_ ? expected_ - passed : -1;  // late stage: unknown
    }
  }
  out.done = std::min((before_ + weight_ * share) / weights_, 1.0);
  if (is_all) out.done = 1, out.left = 0;
  return out;
}

void CompileProgress::run() {
  double done = 0;
  std::unique_lock lock(mutex_);
  do {
    lock.unlock();
    Progress now = state();
    done = now.done = std::max(done, now.done);
    if (!callback_(now)) cancelled_ = true;
    lock.lock();
  } while (!changed_.wait_for(lock, kInterval, [this] { return stopped_; }) && !cancelled_);
}

void CompileProgress::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void CompileProgress::finish() {
  stop();
  if (callback_) callback_(state(true));
}

}  // namespace gloam
