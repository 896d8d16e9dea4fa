#pragma once

#include <vector>

#include "base/device.h"

namespace gloam {

/// What kernels read of a vector, until it changes.
template <class T>
DeviceSpan<const T> span_of(const std::vector<T>& v) {
  return {v.data(), static_cast<uint32_t>(v.size())};
}

}  // namespace gloam
