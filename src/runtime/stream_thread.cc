#include "runtime/stream_thread.h"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "base/log.h"

namespace gloam {

void StreamThread::start(std::shared_ptr<SnapshotQueue> queue, std::string what,
                         std::string memory_hint, std::function<Status(const Snapshot&)> take) {
  queue_ = std::move(queue);
  what_ = std::move(what);
  thread_ = std::thread(
      [this, hint = std::move(memory_hint), take = std::move(take)] { run(hint, take); });
}

void StreamThread::run(const std::string& memory_hint,
                       const std::function<Status(const Snapshot&)>& take) {
  try {
    while (const Snapshot snapshot = queue_->next())
      if (const Status status = take(snapshot); !status.ok()) return end(status.error());
  } catch (const std::bad_alloc&) {
    end({ErrorKind::kPartial, fmt::format("out of memory for {}", what_), {}, memory_hint});
  }
}

void StreamThread::end(Error why) {
  const std::lock_guard lock(mutex_);
  log_error("{} stopped: {}", what_, why.to_string());
  status_ = std::move(why);
  queue_->close();  // the simulation must not wait for it
}

void StreamThread::close() {
  if (queue_ != nullptr) queue_->close();
  drain();
}

void StreamThread::drain() {
  if (thread_.joinable()) thread_.join();
}

Status StreamThread::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace gloam
