#include "inbox.h"

namespace gloam::python {

void Inbox::close() {
  if (is_in_callback_ && callback_thread_.load() == std::this_thread::get_id())
    raise("UsageError", "a callback cannot close its own stream", "close it from another thread");
  if (!try_close())
    raise("StuckError",
          "the callback of " + name_ + " has not returned within " +
              std::to_string(kPatience.count()) + " s: its stream is left behind",
          "callbacks have to return; give long work to a thread of your own");
}

void Inbox::leave_behind() {
  static_cast<void>(stream_.release());
  is_left_behind_ = true;
}

bool Inbox::try_close() {
  if (stream_ == nullptr) return !is_left_behind_;
  refuse_callbacks();
  if (!wait_patiently([this] { return !is_in_callback_; })) {
    leave_behind();
    return false;
  }
  std::unique_ptr<Stream> stream = std::move(stream_);
  const nb::gil_scoped_release released;  // its last callback may wait for the interpreter
  stream.reset();
  return true;
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
  if (is_closing_ || !callback.is_valid() || callback.is_none()) return;
  const CallbackScope inside;
  callback_thread_ = std::this_thread::get_id();
  is_in_callback_ = true;
  try {
    callback(message.make());
  } catch (nb::python_error& error) {
    error_.keep(std::move(error));
  }
  is_in_callback_ = false;
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
