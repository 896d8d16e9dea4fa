#include "runtime/streams/stream_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "base/log.h"

namespace gloam {

void StreamThread::start(std::shared_ptr<SnapshotQueue> queue, StreamJob job) {
  queue_ = std::move(queue);
  job_ = std::move(job);
  if (!job_.next) job_.next = [this] { return queue_->next_window(); };
  thread_ = std::thread([this] { run(); });
}

void StreamThread::run() {
  if (const Status status = take_all(); !status.ok()) end(status.error());
  if (job_.finish) job_.finish();
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
  changed_.notify_all();
}

Status StreamThread::take_all() {
  try {
    while (const SnapshotWindow window = job_.next()) {
      if (is_abandoned()) break;
      GLOAM_TRY_STATUS(take_timed(window));
      const std::lock_guard lock(mutex_);
      ++taken_;
      changed_.notify_all();
    }
  } catch (const std::bad_alloc&) {
    return Error{
        ErrorKind::kPartial, fmt::format("out of memory for {}", job_.what), {}, job_.memory_hint};
  }
  return {};
}

Status StreamThread::take_timed(const SnapshotWindow& window) {
  using Clock = std::chrono::steady_clock;
  if (job_.account == nullptr) return job_.take(window);
  const auto waited = [this] { return job_.waited ? job_.waited() : 0.0; };
  const double waited_before = waited();
  const auto begin = Clock::now();
  const Status status = job_.take(window);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  // A sensor that was created again for another World counts from zero.
  const double waited_now = waited();
  job_.account->add_time(seconds,
                         waited_now >= waited_before ? waited_now - waited_before : waited_now);
  job_.account->set_dropped(queue_->dropped());
  return status;
}

void StreamThread::end(Error why) {
  // Calls the callback if there is one; the owner of a required stream reads its status.
  if (job_.on_end) {
    job_.on_end(why);
  } else if (!queue_->options().required) {
    log_error("{} stopped: {}", job_.what, why.to_string());
  }
  const std::lock_guard lock(mutex_);
  status_ = std::move(why);
  queue_->close();  // the simulation must not wait for it
}

void StreamThread::close() {
  if (queue_ != nullptr) queue_->close();
  drain();
}

void StreamThread::flush() {
  const int64_t wanted = queue_->handed_out();
  queue_->flush();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return taken_ >= std::min(wanted, queue_->handed_out()) || has_ended_ || !status_.ok();
  });
}

void StreamThread::drain() {
  if (thread_.joinable()) thread_.join();
}

bool StreamThread::drain_for(std::chrono::milliseconds time) {
  if (!thread_.joinable()) return true;
  {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, time, [this] { return has_ended_; })) return false;
  }
  drain();
  return true;
}

void StreamThread::abandon() {
  is_abandoned_ = true;
  if (queue_ != nullptr) queue_->close();
}

int64_t StreamThread::taken() const {
  const std::lock_guard lock(mutex_);
  return taken_;
}

bool StreamThread::is_idle() const { return taken() >= queue_->handed_out(); }

Status StreamThread::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace gloam
