#pragma once
// Arrays in the card's memory, and in host memory that it copies from and to at full speed.

#include <cuda_runtime_api.h>

#include <cstddef>
#include <span>
#include <utility>

#include "base/check.h"

namespace gloam::gas {

/// Failures here are bugs, a broken driver or a full card: the user can mend none of them.
inline void must(cudaError_t error, const char* what) {
  if (error != cudaSuccess) check_failed("CUDA", 0, cudaGetErrorString(error), what);
}

template <class T>
class DeviceArray {
 public:
  DeviceArray() = default;
  explicit DeviceArray(size_t size) { reserve(size); }
  DeviceArray(DeviceArray&& other) noexcept { swap(other); }
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~DeviceArray() { cudaFree(data_); }

  /// Grows, never shrinks; growing sets all to 0.
  void reserve(size_t size) {
    if (size <= size_) return;
    must(cudaFree(data_), "cannot free GPU memory");
    data_ = nullptr;
    must(cudaMalloc(reinterpret_cast<void**>(&data_), size * sizeof(T)), "out of GPU memory");
    must(cudaMemset(data_, 0, size * sizeof(T)), "cannot set GPU memory");
    must(cudaDeviceSynchronize(), "cannot set GPU memory");  // whatever stream comes next
    size_ = size;
  }
  /// A copy of host memory; the stream is waited for where that is not pinned.
  void assign(std::span<const T> from, cudaStream_t stream) {
    if (from.empty()) return;
    reserve(from.size());
    must(cudaMemcpyAsync(data_, from.data(), from.size_bytes(), cudaMemcpyHostToDevice, stream),
         "cannot copy to the GPU");
  }
  void swap(DeviceArray& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  T* get() const { return data_; }

 private:
  T* data_ = nullptr;
  size_t size_ = 0;
};

template <class T>
class PinnedArray {
 public:
  PinnedArray() = default;
  PinnedArray(const PinnedArray&) = delete;
  PinnedArray& operator=(const PinnedArray&) = delete;
  ~PinnedArray() { cudaFreeHost(data_); }

  /// Grows, never shrinks; growing loses what it held.
  T* reserve(size_t size) {
    if (size > size_) {
      must(cudaFreeHost(data_), "cannot free pinned memory");
      data_ = nullptr;
      must(cudaMallocHost(reinterpret_cast<void**>(&data_), size * sizeof(T)),
           "out of pinned memory");
      size_ = size;
    }
    return data_;
  }
  T* get() const { return data_; }

 private:
  T* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace gloam::gas
