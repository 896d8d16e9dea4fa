#pragma once
// The C functions of Open Image Denoise, declared from its public documentation
// (https://www.openimagedenoise.org/documentation.html, version 2): no headers are needed to build.

#include <cstddef>

#include "gloam/result.h"

struct CUstream_st;

namespace gloam::oidn {

using Device = void*;
using Filter = void*;
using Buffer = void*;

inline constexpr int kDeviceCpu = 1, kDeviceCuda = 3, kFormatFloat3 = 3, kErrorNone = 0;
inline constexpr int kQuality[] = {4, 5, 6};  ///< by DenoiseQuality

/// Width of the mirrored border beyond which the network's padding no longer shows [px]. Roughness
/// of a noisy wall's outermost row over that of the eighth: 5.4 without, 1.5 with 4 pixels, 1.3
/// with 8 and with 16.
inline constexpr int kBorder = 8;

struct Api {
  Device (*new_device)(int type) = nullptr;
  Device (*new_cuda_device)(const int* ids, CUstream_st* const* streams, int count) = nullptr;
  void (*set_device_int)(Device, const char* name, int value) = nullptr;
  void (*set_device_bool)(Device, const char* name, bool value) = nullptr;
  void (*commit_device)(Device) = nullptr;
  void (*release_device)(Device) = nullptr;
  int (*get_device_error)(Device, const char** message) = nullptr;
  Filter (*new_filter)(Device, const char* type) = nullptr;
  void (*set_image)(Filter, const char* name, void* data, int format, size_t width, size_t height,
                    size_t offset, size_t pixel_stride, size_t row_stride) = nullptr;
  void (*set_buffer_image)(Filter, const char* name, Buffer, int format, size_t width,
                           size_t height, size_t offset, size_t pixel_stride,
                           size_t row_stride) = nullptr;
  void (*unset_image)(Filter, const char* name) = nullptr;
  Buffer (*new_buffer)(Device, size_t bytes) = nullptr;
  void (*write_buffer)(Buffer, size_t offset, size_t bytes, const void* from) = nullptr;
  void (*read_buffer)(Buffer, size_t offset, size_t bytes, void* to) = nullptr;
  void (*release_buffer)(Buffer) = nullptr;
  void (*set_bool)(Filter, const char* name, bool value) = nullptr;
  void (*set_int)(Filter, const char* name, int value) = nullptr;
  void (*commit_filter)(Filter) = nullptr;
  void (*execute_filter)(Filter) = nullptr;
  void (*execute_filter_async)(Filter) = nullptr;
  void (*set_monitor)(Filter, bool (*progress)(void* user, double done), void* user) = nullptr;
  void (*release_filter)(Filter) = nullptr;
};

/// Loads the library at run time from $GLOAM_OIDN (its file or folder), Gloam's .venv, an
/// installation or bundle, or the system; it is never unloaded. Errors: not found, too old.
Result<Api> load_api();

/// Commits a device, which may be null, and returns it. Error: it does not run; it is released.
Result<Device> commit(const Api& api, Device device, const char* where);

}  // namespace gloam::oidn
