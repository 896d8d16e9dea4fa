#pragma once
// Progress of a compilation, for the caller, who may also cancel it.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "gloam/world.h"

namespace gloam {

/// Weights of the stages: they take about as long.
inline constexpr double kReadWeight = 1, kSampleWeight = 1, kConvertWeight = 3, kModelWeight = 1;

/// Calls the callback from a thread of its own, at once and then ten times a second. All but
/// finish() may be called from any thread.
class CompileProgress {
 public:
  /// `weights` = sum of what begin() will be given. An empty callback is told nothing and stops
  /// nothing.
  CompileProgress(const ProgressCallback& callback, double weights);
  ~CompileProgress();
  CompileProgress(const CompileProgress&) = delete;
  CompileProgress& operator=(const CompileProgress&) = delete;

  bool is_watched() const { return static_cast<bool>(callback_); }
  /// Outlived by nothing that is given it.
  const std::atomic<bool>& is_cancelled() const { return cancelled_; }
  /// kInterrupted from when the callback has returned false.
  Status check() const;

  /// Begins the next stage; the one before is done. `expected` = time that it takes [s], 0 = not
  /// known.
  void begin(std::string what, double weight, double expected = 0);
  /// Reports the progress of the stage, 0 … 1.
  void report(double share);
  /// The same, when it has another name by now.
  void report(double share, std::string what);

  /// All is done: tells so and calls no more.
  void finish();

 private:
  Progress state(bool is_all = false) const;
  void run();
  void stop();

  const ProgressCallback& callback_;
  const double weights_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<bool> cancelled_{false};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  std::string what_ = "reading the scene";
  std::chrono::steady_clock::time_point begun_ = start_;
  double before_ = 0, weight_ = 0, share_ = 0, expected_ = 0;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace gloam
