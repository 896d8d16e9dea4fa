#pragma once
// Tells of work that takes long and cannot say how far it is, such as MuJoCo's parser.

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace gloam {

/// From 2 s on logs that `what` goes on, for how long it has and about how long it still will,
/// until it is destroyed.
class LongWait {
 public:
  /// `expected` = its whole time, nearly [s]; 0 = not known.
  LongWait(std::string what, double expected);
  ~LongWait();
  LongWait(const LongWait&) = delete;
  LongWait& operator=(const LongWait&) = delete;

 private:
  void run();

  const std::string what_;
  const double expected_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread thread_;
};

}  // namespace gloam
