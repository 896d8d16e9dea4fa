#include "interrupt.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <utility>

#include "command.h"

namespace gloam::cli {
namespace {

std::atomic<bool> stop_requested{false};

void on_signal(int signal) {
  // The second one does not wait for files. SIGXCPU comes every second from then on.
  if (stop_requested.exchange(true) && signal != SIGXCPU) ::_exit(128 + signal);
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
}

bool interrupted() { return stop_requested; }

EndOnInterrupt::EndOnInterrupt(std::function<void()> clean_up)
    : clean_up_(std::move(clean_up)), watcher_([this] { watch(); }) {}

void EndOnInterrupt::release() {
  {
    const std::lock_guard lock(mutex_);
    released_ = true;
  }
  changed_.notify_all();
  if (watcher_.joinable()) watcher_.join();
}

void EndOnInterrupt::watch() {
  constexpr std::chrono::milliseconds kPoll{50};  // a signal's handler can wake nobody
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kPoll, [this] { return released_; })) {
    if (!interrupted()) continue;
    if (clean_up_) clean_up_();
    ::_exit(fail({ErrorKind::kInterrupted, "interrupted"}));
  }
}

}  // namespace gloam::cli
