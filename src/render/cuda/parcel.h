#pragma once
// Data that the host sends to the card for one picture or scan: laid out in pinned memory and sent
// in one copy.

#include <cstring>
#include <type_traits>
#include <vector>

#include "base/device.h"
#include "base/parallel.h"
#include "render/cuda/device_memory.h"

namespace gloam::cuda {

/// Data that does not fit is counted, not stored.
class Parcel {
 public:
  Parcel(char* host, char* device, size_t size) : host_(host), device_(device), size_(size) {}

  /// Where the data will be on the card.
  const void* put(const void* data, size_t bytes) {
    constexpr size_t kAlign = 256;
    if (bytes == 0) return nullptr;
    const size_t at = used_;
    used_ += (bytes + kAlign - 1) / kAlign * kAlign;
    if (used_ > size_) return nullptr;
    char* const to = host_ + at;
    const char* const from = static_cast<const char*>(data);
    parallel_for_range("copy to the card", static_cast<int64_t>(bytes), 1 << 20,
                       [&](int64_t begin, int64_t end) {
                         std::memcpy(to + begin, from + begin, static_cast<size_t>(end - begin));
                       });
    return device_ + at;
  }
  template <class T>
  DeviceSpan<const T> put(DeviceSpan<const T> span) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {static_cast<const T*>(put(span.data, span.size * sizeof(T))), span.size};
  }
  template <class T>
  DeviceSpan<const T> put(const std::vector<T>& v) {
    return put(DeviceSpan<const T>{v.data(), static_cast<uint32_t>(v.size())});
  }
  size_t used() const { return used_; }

 private:
  char *host_, *device_;
  size_t size_, used_ = 0;
};

/// Memory of the card that parcels are copied to, one after the other.
class ParcelPlace {
 public:
  /// Lays a parcel out with fill(&parcel) in `staging`, and queues its copy; once the stream has
  /// come so far, `staging` is free again.
  template <class Fill>
  void send(const Fill& fill, PinnedBuffer* staging, cudaStream_t stream) {
    for (;;) {
      Parcel parcel(staging->reserve(size_), static_cast<char*>(device_.reserve(size_)), size_);
      fill(&parcel);
      if (parcel.used() <= size_) {
        if (parcel.used() == 0) return;
        return check(cudaMemcpyAsync(device_.data(), staging->reserve(0), parcel.used(),
                                     cudaMemcpyHostToDevice, stream),
                     "cannot copy the scene to the GPU");
      }
      size_ = parcel.used() + parcel.used() / 4;  // with a little room, to be filled once
    }
  }

 private:
  DeviceBuffer device_;
  size_t size_ = 0;
};

}  // namespace gloam::cuda
