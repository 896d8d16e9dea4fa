#include "inbox.h"

#include <algorithm>

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
    waiting_.push(std::move(message));
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

void Inbox::check_kept() const {
  if (has_callback_)
    raise("UsageError", "messages of " + name_ + " go to its callback",
          "open another stream to read them");
}

std::optional<Waiting> Inbox::wait(std::optional<double> timeout) {
  using Clock = std::chrono::steady_clock;
  constexpr double kLongest = 1e9;  // [s], which a clock can add
  check_kept();
  if (timeout && !(*timeout >= 0)) raise("UsageError", "timeout must be at least 0 s");
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                         std::min(timeout.value_or(kLongest), kLongest)));
  for (;;) {
    const auto until = std::min(end, Clock::now() + kSignalPollPeriod);
    if (auto first = without_gil([&] { return waiting_.pop_until(until); })) return first;
    check(stream().status());
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (Clock::now() >= end) return {};
  }
}

void Inbox::flush() {
  if (is_in_callback_ && callback_thread_.load() == std::this_thread::get_id())
    raise("UsageError", "a callback cannot wait for its own stream", "read it in another thread");
  Stream& here = stream();
  without_gil([&] { here.flush(); });
  rethrow();
}

}  // namespace gloam::python
