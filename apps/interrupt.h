#pragma once
// Handling of Ctrl-C, SIGTERM, SIGHUP and SIGXCPU: the first one acts within two seconds, whatever
// the program does at that moment.

#include <functional>

namespace gloam::cli {

/// From now on Ctrl-C, SIGTERM, SIGHUP and SIGXCPU end the process at once with exit code 130, or,
/// after stop_on_interrupt(), once the job has stopped; a second one ends it immediately.
void catch_interrupts();
bool interrupted();

/// The job checks interrupted() from now on and has files to finish. It gets a moment to stop; if
/// it does not react, the process ends with an error.
void stop_on_interrupt();
/// The job has stopped and finishes its files, which may take longer.
void finish_on_interrupt();

/// While it lives, the first signal ends the process at once even after stop_on_interrupt(): for
/// work that cannot stop midway and has nothing to finish, such as MuJoCo's compiler.
class EndOnInterrupt {
 public:
  /// `clean_up` runs before the end, on another thread, while the work goes on.
  explicit EndOnInterrupt(std::function<void()> clean_up = {});
  ~EndOnInterrupt() { release(); }
  EndOnInterrupt(const EndOnInterrupt&) = delete;
  EndOnInterrupt& operator=(const EndOnInterrupt&) = delete;
  /// Ends the scope early.
  void release();

 private:
  bool is_live_ = true;
};

}  // namespace gloam::cli
