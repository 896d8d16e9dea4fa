#pragma once
// A stream of the card, and marks in it.

#include "render/cuda/device_memory.h"
#include "render/cuda/kernels.h"

namespace gloam::cuda {

class Event {
 public:
  Event() { check(cudaEventCreate(&event_), "cannot create a CUDA event"); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event() { cudaEventDestroy(event_); }
  void record(Stream stream) { check(cudaEventRecord(event_, stream), "a CUDA event failed"); }
  void wait() const { check(cudaEventSynchronize(event_), "a CUDA kernel failed"); }
  /// [s]; both have happened.
  double since(const Event& start) const {
    float ms = 0;
    check(cudaEventElapsedTime(&ms, start.event_, event_), "a CUDA event failed");
    return 1e-3 * ms;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

/// A stream and its end.
class OwnStream {
 public:
  OwnStream() { check(cudaStreamCreate(&stream_), "cannot create a CUDA stream"); }
  OwnStream(const OwnStream&) = delete;
  OwnStream& operator=(const OwnStream&) = delete;
  ~OwnStream() { cudaStreamDestroy(stream_); }
  Stream get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

}  // namespace gloam::cuda
