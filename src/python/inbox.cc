#include "inbox.h"

namespace gloam::python {

void Inbox::close() {
  if (is_in_callback_ && callback_thread_.load() == std::this_thread::get_id())
    raise("UsageError", "a callback cannot close its own stream", "close it from another thread");
  if (!try_close())
    raise("StuckError",
          "the callback of " + name_ + " has not returned within " +
              std::to_string(kCallbackTimeout.count()) + " s: its stream is abandoned",
          "callbacks must return; do long work in a thread of your own");
}

bool Inbox::is_stuck() const {
  return is_in_callback_ && std::chrono::steady_clock::now() - began_.load() > kCallbackTimeout;
}

// The stream ends on a thread of its own: it waits for the callbacks of what has come, of which one
// may never return.
bool Inbox::try_close() {
  if (stream_ == nullptr) return !is_left_behind_;
  const auto has_ended = std::make_shared<std::atomic<bool>>(false);
  std::thread closer([stream = std::exchange(stream_, nullptr).release(), has_ended] {
    delete stream;
    *has_ended = true;
  });
  std::exception_ptr interrupted;  // Ctrl-C
  try {
    wait_patiently([&] { return *has_ended || is_stuck(); }, std::chrono::years(1));
  } catch (...) {
    interrupted = std::current_exception();
  }
  if (!*has_ended) {
    is_closing_ = is_left_behind_ = true;
    closer.detach();
    if (interrupted) std::rethrow_exception(interrupted);
    return false;
  }
  const nb::gil_scoped_release released;
  closer.join();
  if (interrupted) std::rethrow_exception(interrupted);
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
  const CallbackScope inside;             // outlives `callback`, whose end may end the simulation
  const nb::object callback = callback_;  // kept for as long as it runs
  if (is_closing_ || !callback.is_valid() || callback.is_none()) return;
  callback_thread_ = std::this_thread::get_id();
  began_ = std::chrono::steady_clock::now();
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
