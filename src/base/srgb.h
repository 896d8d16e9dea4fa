#pragma once
// The transfer functions of sRGB (IEC 61966-2-1), of one channel, 0 … 1 on both sides.

#include <cmath>

#include "base/device.h"

namespace gloam {

/// Display value of linear light.
template <class F>
GLOAM_HD F srgb_encode(F linear) {
  return linear <= F(0.0031308) ? F(12.92) * linear
                                : F(1.055) * std::pow(linear, F(1) / F(2.4)) - F(0.055);
}

/// Linear light of a display value.
template <class F>
GLOAM_HD F srgb_decode(F encoded) {
  return encoded <= F(0.04045) ? encoded / F(12.92)
                               : std::pow((encoded + F(0.055)) / F(1.055), F(2.4));
}

}  // namespace gloam
