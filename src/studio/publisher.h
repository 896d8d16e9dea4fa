#pragma once
// Turns the newest frame into bytes on a thread of its own and keeps a beat for the state messages,
// so that neither the renderer nor the network waits for either.

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "base/threads/bounded_queue.h"
#include "gloam/camera.h"

namespace gloam::studio {

class Publisher {
 public:
  /// Callbacks, always on its own thread.
  struct Outputs {
    std::function<void(std::shared_ptr<const CameraFrame>, uint64_t sequence)> picture;
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
  struct Offer {
    std::shared_ptr<const CameraFrame> frame;
    uint64_t sequence = 0;
  };
  void run();

  Outputs outputs_;
  BoundedQueue<Offer> waiting_{{.items = 1}, Overflow::kDropOldest};
  mutable std::mutex mutex_;
  Offer newest_;
  std::thread thread_;
};

}  // namespace gloam::studio
