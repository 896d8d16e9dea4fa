#pragma once
// Handling of Ctrl-C, SIGTERM, SIGHUP and SIGXCPU.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace gloam::cli {

/// From now on Ctrl-C, SIGTERM, SIGHUP and SIGXCPU set a flag; a second one ends the process.
void catch_interrupts();
bool interrupted();

/// While it lives, the first one ends the process, too: for work that cannot be stopped midway and
/// has nothing to finish, such as MuJoCo's compiler.
class EndOnInterrupt {
 public:
  /// `clean_up` runs before the end, on another thread, while the work goes on.
  explicit EndOnInterrupt(std::function<void()> clean_up = {});
  ~EndOnInterrupt() { release(); }
  EndOnInterrupt(const EndOnInterrupt&) = delete;
  EndOnInterrupt& operator=(const EndOnInterrupt&) = delete;
  /// From now on there is something to finish.
  void release();

 private:
  void watch();

  const std::function<void()> clean_up_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool released_ = false;
  std::thread watcher_;
};

}  // namespace gloam::cli
