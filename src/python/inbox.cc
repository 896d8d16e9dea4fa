#include "inbox.h"

namespace gloam::python {

void Inbox::close() {
  if (stream_ == nullptr) return;
  std::unique_ptr<Stream> stream = std::move(stream_);
  const nb::gil_scoped_release released;  // its last callback may wait for the interpreter
  stream.reset();
}

Stream& Inbox::stream() {
  if (stream_ == nullptr) raise("ClosedError", "the stream is closed");
  return *stream_;
}

void Inbox::put(Waiting message) {
  if (!has_callback_) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(message));
    if (static_cast<int>(waiting_.size()) <= capacity_) return;
    waiting_.pop_front();
    ++lost_;
    return;
  }
  const nb::gil_scoped_acquire acquired;
  const nb::object callback = callback_;  // kept for as long as it runs
  if (!callback.is_valid() || callback.is_none()) return;
  const CallbackScope inside;
  try {
    callback(message.make());
  } catch (nb::python_error& error) {
    error_.keep(std::move(error));
  }
}

std::optional<Waiting> Inbox::pop() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty()) return {};
  std::optional<Waiting> first = std::move(waiting_.front());
  waiting_.pop_front();
  return first;
}

void Inbox::clear() {
  const std::lock_guard lock(mutex_);
  waiting_.clear();
}

}  // namespace gloam::python
