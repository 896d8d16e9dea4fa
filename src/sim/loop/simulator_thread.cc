// The threads of a Simulator: its own, and callers' threads that take its place for a moment.

#include <optional>

#include "base/check.h"
#include "scene/files/mujoco_guard.h"
#include "sim/loop/simulator.h"

namespace gloam {
namespace {

// By the wall clock.
bool is_paced(Pace pace) { return pace == Pace::kRealTime || pace == Pace::kSensors; }

}  // namespace

Error Simulator::no_call_from_a_step() {
  return {ErrorKind::kUsage,
          "a controller or step hook cannot step, wait for or change its own simulation",
          {},
          "call it from another thread, or post a Command"};
}

class Simulator::Turn {
 public:
  explicit Turn(Simulator& of) : of_(of), lock_(of.turn_mutex_) { begin(); }
  Turn(Simulator& of, std::try_to_lock_t) : of_(of), lock_(of.turn_mutex_, std::try_to_lock) {
    if (lock_.owns_lock()) begin();
  }
  ~Turn() { end(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  bool is_mine() const { return lock_.owns_lock(); }
  void take() {
    lock_.lock();
    begin();
  }
  void end() {
    if (!lock_.owns_lock()) return;
    of_.sim_thread_.store({}, std::memory_order_relaxed);
    lock_.unlock();
  }

 private:
  void begin() { of_.sim_thread_.store(std::this_thread::get_id(), std::memory_order_relaxed); }

  Simulator& of_;
  std::unique_lock<std::mutex> lock_;
};

// ---- the sim thread ----

void Simulator::run_thread() {
  Turn turn(*this);
  MujocoWarningCapture warnings;  // they are counted by type in mjData
  const auto wait = [&](uint32_t ticket) {
    turn.end();
    signal_->wait(ticket);
    turn.take();
  };
  while (!quit_) {
    const uint32_t ticket = signal_->ticket();
    const bool published = loop_.publish_due();
    if (called_.load(std::memory_order_acquire)) {
      answer_calls();
    } else if (!published) {
      wait(ticket);
    } else if (loop_.stepper().failed() || !wants_step()) {
      report_idle();
      wait(ticket);
    } else if (!is_paced(pace_) || pacer_.ready(loop_.stepper().step_count())) {
      take_step();
    }
  }
  const std::lock_guard lock(mutex_);
  for (const std::function<void()>* f : calls_) (*f)();
  calls_answered_ += static_cast<int64_t>(calls_.size());
  calls_.clear();
  loop_.close_queues();
  running_ = false;  // from here on, calls run where they are made
  idle_ = true;
  changed_.notify_all();
}

void Simulator::take_step() {
  const int64_t run = loop_.run();
  const bool ok = loop_.advance();
  if (loop_.run() != run) {
    pacer_.restart();
  } else if (ok) {
    ++total_steps_;
    if (remaining_ != kForever) --remaining_;
  } else if (remaining_ != kForever) {
    remaining_ = 0;  // a failed step(n) is over: a reset must not take up the rest of it
  }
  step_count_.store(loop_.stepper().step_count(), std::memory_order_relaxed);
}

void Simulator::answer_calls() {
  const std::lock_guard lock(mutex_);
  called_.store(false, std::memory_order_relaxed);
  for (const std::function<void()>* f : calls_) (*f)();
  loop_.publish_due();
  calls_answered_ += static_cast<int64_t>(calls_.size());
  calls_.clear();
  idle_ = false;
  step_count_.store(loop_.stepper().step_count(), std::memory_order_relaxed);
  changed_.notify_all();
}

// False when it is not idle: somebody wants something.
bool Simulator::report_idle() {
  loop_.flush_queues();
  const std::lock_guard lock(mutex_);
  if (called_.load(std::memory_order_relaxed)) return false;
  idle_ = true;
  changed_.notify_all();
  return true;
}

// ---- callers' threads ----

// Runs f between two steps: here if the sim thread stands still, else on the sim thread. Snapshots
// that are due after it are published before it returns, so that a reader that has just subscribed
// can wait for them with flush().
void Simulator::call(const std::function<void()>& f, Wake wake) {
  if (is_on_sim_thread()) return f();  // in the middle of a step: f only looks, or sets a wish
  Turn turn(*this, std::try_to_lock);
  if (!turn.is_mine()) {
    std::unique_lock lock(mutex_);
    if (running_) {
      calls_.push_back(&f);
      const int64_t mine = ++calls_made_;
      called_.store(true, std::memory_order_release);
      signal_->raise();
      changed_.wait(lock, [&] { return calls_answered_ >= mine; });
      return;
    }
    lock.unlock();
    turn.take();
  }
  MujocoWarningCapture warnings;  // as on the sim thread
  f();
  step_count_.store(loop_.stepper().step_count(), std::memory_order_relaxed);
  if (wake == Wake::kYes && this->wake()) loop_.publish_due();
}

bool Simulator::wake() {
  bool is_running = false;
  {
    const std::lock_guard lock(mutex_);
    is_running = running_;
    if (running_) idle_ = false;
  }
  signal_->raise();
  return is_running;
}

bool Simulator::is_idle() {
  const std::lock_guard lock(mutex_);
  return idle_;
}

void Simulator::start(int64_t until) {
  const Turn turn(*this);
  const std::lock_guard lock(mutex_);
  GLOAM_CHECK(!running_ && !quit_, "a Simulator can be started only once");
  until_ = pace_ == Pace::kLockstep ? loop_.stepper().step_count() : until;
  running_ = true;
  idle_ = false;
  thread_ = std::thread([this] { run_thread(); });
}

void Simulator::stop() {
  call([this] {
    quit_ = true;
    loop_.close_queues();
  });
  const std::lock_guard lock(join_mutex_);
  if (thread_.joinable()) thread_.join();
}

Status Simulator::step(int64_t n) {
  if (const std::optional<Status> taken = begin_steps(n)) return *taken;
  return wait();
}

std::optional<Status> Simulator::begin_steps(int64_t n) {
  if (is_on_sim_thread()) return no_call_from_a_step();
  const auto begin = [this, n] {
    if (loop_.stepper().failed()) return;  // nothing to take up after a reset
    paused_ = halted_ = false;
    until_ = kForever;
    remaining_ = n;
    pacer_.restart();
  };
  Turn turn(*this, std::try_to_lock);
  if (!turn.is_mine() || n > kShortRun || is_paced(pace_)) {
    turn.end();
    call(begin);
    return {};
  }
  {
    const std::lock_guard lock(mutex_);
    if (!running_) return Status();
    idle_ = false;
  }
  begin();
  const bool is_done = take_steps_here();
  if (!is_done) {
    signal_->raise();
    return {};
  }
  return loop_.stepper().failed() ? Status(loop_.stepper().error()) : Status();
}

// False when the sim thread has to go on: a required reader is full, or another thread has changed
// what is to be done.
bool Simulator::take_steps_here() {
  MujocoWarningCapture warnings;  // as on the sim thread
  for (;;) {
    const bool published = loop_.publish_due();
    if (called_.load(std::memory_order_acquire)) {
      answer_calls();
    } else if (!published || quit_ || remaining_ == kForever || is_paced(pace_)) {
      return false;
    } else if (!loop_.stepper().failed() && wants_step()) {
      take_step();
    } else if (report_idle()) {
      return true;
    }
  }
}

Status Simulator::wait() {
  if (is_on_sim_thread()) return no_call_from_a_step();
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return idle_ || !running_; });
  }
  return status();
}

bool Simulator::wait_for(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, time, [this] { return idle_ || !running_; });
}

}  // namespace gloam
