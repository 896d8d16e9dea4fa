#pragma once

#include <vector>

#include "base/device.h"

namespace gloam {

/// Span of a vector's elements for kernels, valid until the vector changes.
template <class T>
DeviceSpan<const T> span_of(const std::vector<T>& v) {
  return {v.data(), static_cast<uint32_t>(v.size())};
}

}  // namespace gloam
