#pragma once
// Memory on the card and pinned memory beside it, freed with their owners.

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "base/check.h"

namespace gloam::cuda {

/// Failures here are bugs, a broken driver or a full card: no user can mend them.
inline void check(cudaError_t error, const char* what) {
  if (error != cudaSuccess) check_failed("CUDA", 0, cudaGetErrorString(error), what);
}

/// Grows, never shrinks; growing loses the contents.
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;
  ~DeviceBuffer() { cudaFree(data_); }

  void* reserve(size_t bytes) {
    if (bytes > size_) {
      check(cudaFree(data_), "cannot free GPU memory");
      data_ = nullptr;
      check(cudaMalloc(&data_, bytes), "out of GPU memory");
      size_ = bytes;
    }
    return data_;
  }
  template <class T>
  T* reserve_of(size_t count) {
    return static_cast<T*>(reserve(count * sizeof(T)));
  }
  void* data() const { return data_; }

 private:
  void* data_ = nullptr;
  size_t size_ = 0;
};

/// Arrays in one piece of memory on the card: measured without a base, then placed.
class DeviceLayout {
 public:
  explicit DeviceLayout(void* base = nullptr) : base_(reinterpret_cast<uintptr_t>(base)) {}
  template <class T>
  void put(T** array, size_t count) {
    *array = reinterpret_cast<T*>(base_ + used_);
    used_ += (count * sizeof(T) + kAlign - 1) / kAlign * kAlign;
  }
  size_t bytes() const { return used_; }

 private:
  static constexpr size_t kAlign = 256;
  uintptr_t base_;
  size_t used_ = 0;
};

/// Host memory that the card copies from and to at full speed.
class PinnedBuffer {
 public:
  PinnedBuffer() = default;
  PinnedBuffer(const PinnedBuffer&) = delete;
  PinnedBuffer& operator=(const PinnedBuffer&) = delete;
  ~PinnedBuffer() { cudaFreeHost(data_); }

  char* reserve(size_t bytes) {
    if (bytes > size_) {
      check(cudaFreeHost(data_), "cannot free pinned memory");
      data_ = nullptr;
      check(cudaMallocHost(&data_, bytes), "out of pinned memory");
      size_ = bytes;
    }
    return static_cast<char*>(data_);
  }

 private:
  void* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace gloam::cuda
