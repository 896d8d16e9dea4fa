#pragma once
// Turns the newest frame into bytes on a thread of its own and keeps a beat for the state messages,
// so that neither the renderer nor the network waits for either.

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "gloam/camera.h"

namespace gloam::studio {

class Publisher {
 public:
  /// Callbacks, always on its own thread.
  struct Outputs {
    std::function<void(const CameraFrame&, uint64_t sequence)> picture;
    std::function<void()> beat;  ///< ten times a second
  };
  explicit Publisher(Outputs outputs);
  ~Publisher();

  void start();
  /// Takes the place of a frame that has not been encoded yet. Any thread; does not block.
  void offer(std::shared_ptr<const CameraFrame> frame);
  /// The frame offered last; null before the first and after forget().
  std::shared_ptr<const CameraFrame> newest() const;
  /// Frames offered so far.
  uint64_t sequence() const;
  /// Drops the newest frame: the camera has changed.
  void forget();
  void stop();

 private:
  void run();

  Outputs outputs_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::shared_ptr<const CameraFrame> newest_;
  uint64_t sequence_ = 0;  // of newest_
  uint64_t encoded_ = 0;   // sequence of the last one encoded
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace gloam::studio
