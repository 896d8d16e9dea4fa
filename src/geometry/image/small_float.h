#pragma once
// Floats of fewer bits, as pictures store them.

#include <cmath>
#include <cstdint>
#include <limits>

namespace gloam {

/// An unsigned float of 5 bits of exponent (biased by 15) above `mantissa_bits` of mantissa: halves
/// without their sign, and the parts of R11F_G11F_B10F.
inline float small_float(uint32_t bits, int mantissa_bits) {
  const int exponent = static_cast<int>(bits >> mantissa_bits) & 31;
  const int one = 1 << mantissa_bits, mantissa = static_cast<int>(bits) & (one - 1);
  if (exponent == 31)
    return mantissa != 0 ? std::numeric_limits<float>::quiet_NaN()
                         : std::numeric_limits<float>::infinity();
  return exponent == 0
             ? std::ldexp(static_cast<float>(mantissa), -14 - mantissa_bits)
             : std::ldexp(static_cast<float>(mantissa + one), exponent - 15 - mantissa_bits);
}

/// IEEE 754 binary16.
inline float half_to_float(uint16_t h) {
  const float magnitude = small_float(h & 0x7fffu, 10);
  return (h & 0x8000) != 0 ? -magnitude : magnitude;
}

}  // namespace gloam
