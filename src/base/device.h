#pragma once
// Device-safe code is compiled by the host compiler and by nvcc: no std containers, exceptions,
// virtuals, globals or I/O. Functions that run in kernels are marked GLOAM_HD.

#include <cstddef>
#include <cstdint>

#ifdef __CUDACC__
#define GLOAM_HD __host__ __device__ GLOAM_INLINE
#else
#define GLOAM_HD inline
#endif

namespace gloam {

/// Non-owning view of contiguous elements in memory of the side that runs the code.
template <class T>
struct DeviceSpan {
  T* data = nullptr;
  uint32_t size = 0;
  GLOAM_HD T& operator[](uint32_t i) const { return data[i]; }
  GLOAM_HD bool empty() const { return size == 0; }
};

}  // namespace gloam
