#pragma once
// Threads of a recording, and the failure that ends all of them.

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "base/check.h"
#include "base/threads/worker.h"
#include "gloam/result.h"
#include "record/recorder.h"
#include "record/run_files.h"

namespace gloam {

/// The failure that ended a recording: what was written before it is complete, so its kind is
/// kPartial. Others that follow from it are of no interest.
class FirstFailure {
 public:
  void report(const Status& status) {
    if (status.ok()) return;
    const std::lock_guard lock(mutex_);
    if (error_) return;
    error_ = status.error();
    error_->kind = ErrorKind::kPartial;
    error_->message = "recording stopped: " + error_->message;
    failed_ = true;
  }
  /// Does `write`, whose failure or want of memory ends the recording.
  template <class F>
  void attempt(F&& write) {
    try {
      report(write());
    } catch (const std::bad_alloc&) {
      report(Error{ErrorKind::kIo, "out of memory", {}, "lower the resolution"});
    }
  }
  bool failed() const { return failed_; }
  Status status() const {
    const std::lock_guard lock(mutex_);
    return error_ ? Status(*error_) : Status();
  }

 private:
  mutable std::mutex mutex_;
  std::atomic<bool> failed_{false};
  std::optional<Error> error_;
};

/// A batch run waits for slow disks; otherwise the oldest items are dropped and counted.
inline Overflow overflow_of(const RecorderOptions& options) {
  return options.wait ? Overflow::kWait : Overflow::kDropOldest;
}

/// The files of each camera, or of each LiDAR, and a thread for each that writes them.
template <class LaneRecorder>
class Lanes {
 public:
  /// Makes the first files.
  Status open(const std::string& name, LaneRecorder recorder, const RecorderOptions& options) {
    GLOAM_TRY_STATUS(recorder.start());
    lanes_[name] = std::make_unique<Lane>(std::move(recorder), options);
    return {};
  }
  /// `item`: a frame or scan, written on the lane's thread unless something has failed before.
  template <class Item>
  void add(const std::string& name, std::shared_ptr<const Item> item, FirstFailure* failure) {
    const auto lane = lanes_.find(name);
    GLOAM_CHECK(lane != lanes_.end(), "a frame or scan of a sensor that is not recorded");
    if (failure->failed()) return;
    const bool is_open = lane->second->worker.post(
        [failure, recorder = &lane->second->recorder, item = std::move(item)] {
          if (!failure->failed()) failure->attempt([&] { return recorder->add(*item); });
        });
    GLOAM_CHECK(is_open, "a frame or scan after the end of the recording");
  }
  /// Writes all queued items and ends the threads.
  void close() {
    for (auto& [name, lane] : lanes_) lane->worker.close();
  }
  void finish(FirstFailure* failure) {
    for (auto& [name, lane] : lanes_) failure->report(lane->recorder.finish());
  }
  const LaneRecorder& recorder(const std::string& name) const { return lanes_.at(name)->recorder; }
  /// For the summary; a lane that is not open yet has written nothing.
  CameraCounts counts(const std::string& name, const std::string& file_name) const {
    const auto lane = lanes_.find(name);
    if (lane == lanes_.end()) return {name, file_name, 0, 0};
    return {name, file_name, lane->second->recorder.count(), lane->second->worker.dropped()};
  }

 private:
  struct Lane {
    Lane(LaneRecorder lane_recorder, const RecorderOptions& options)
        : recorder(std::move(lane_recorder)),
          worker(static_cast<size_t>(options.queue_frames), overflow_of(options)) {}
    ~Lane() { worker.close(); }
    LaneRecorder recorder;
    Worker worker;  // after what it uses: it is destroyed, and so ends, first
  };
  std::map<std::string, std::unique_ptr<Lane>> lanes_;
};

}  // namespace gloam
