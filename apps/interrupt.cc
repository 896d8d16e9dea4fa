#include "interrupt.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "command.h"
#include "gloam/drive/teleop.h"

namespace gloam::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// Work left for the running command after the first signal.
enum class Phase { kNothing, kStopping, kFinishing };

constexpr std::chrono::milliseconds kTimeToStop{1500};
constexpr std::chrono::seconds kTimeToFinish{20};
constexpr std::chrono::milliseconds kPollPeriod{20};  // a signal handler cannot wake a thread

std::atomic<bool> stop_requested{false};
std::atomic<Phase> phase{Phase::kNothing};
std::atomic<int> end_scopes{0};

/// Never destroyed: the watcher uses it until the process ends.
struct CleanUps {
  std::mutex mutex;
  std::vector<std::function<void()>> list;
};
CleanUps& clean_ups() {
  static auto& made = *new CleanUps;
  return made;
}

void on_signal(int signal) {
  // The second one does not wait for files. SIGXCPU comes every second from then on.
  if (!stop_requested.exchange(true) || signal == SIGXCPU) return;
  restore_terminal();
  ::_exit(128 + signal);
}

void end_process(const Error& error) {
  {
    const std::lock_guard lock(clean_ups().mutex);
    for (const auto& clean_up : clean_ups().list)
      if (clean_up) clean_up();
  }
  restore_terminal();
  ::_exit(fail(error));
}

void watch() {
  while (!stop_requested) std::this_thread::sleep_for(kPollPeriod);
  const Clock::time_point signalled = Clock::now();
  for (;; std::this_thread::sleep_for(kPollPeriod)) {
    const auto since = Clock::now() - signalled;
    if (end_scopes > 0 || phase == Phase::kNothing)
      end_process({ErrorKind::kInterrupted, "interrupted"});
    if (phase == Phase::kStopping && since > kTimeToStop)
      end_process({ErrorKind::kInterrupted,
                   "interrupted: the job did not stop in time and its files are incomplete",
                   {},
                   "gloam recover repairs a log; other files are complete up to their last entry"});
    if (since > kTimeToFinish)
      end_process({ErrorKind::kInterrupted, "interrupted: finishing the files took too long"});
  }
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGXCPU, on_signal);  // ulimit -t: seconds are left
  // The terminal is gone. nohup has it ignored, and so it stays.
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error where it is written
  clean_ups();
  std::thread(watch).detach();
}

bool interrupted() { return stop_requested; }

void stop_on_interrupt() {
  Phase nothing = Phase::kNothing;
  phase.compare_exchange_strong(nothing, Phase::kStopping);
}

void finish_on_interrupt() { phase = Phase::kFinishing; }

EndOnInterrupt::EndOnInterrupt(std::function<void()> clean_up) {
  const std::lock_guard lock(clean_ups().mutex);
  clean_ups().list.push_back(std::move(clean_up));
  ++end_scopes;
}

void EndOnInterrupt::release() {
  if (!std::exchange(is_live_, false)) return;
  const std::lock_guard lock(clean_ups().mutex);
  --end_scopes;
  clean_ups().list.pop_back();  // scopes nest
}

}  // namespace gloam::cli
