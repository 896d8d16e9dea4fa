#pragma once
// Sines, cosines, exponentials and logarithms without branches or tables, so that compilers make
// vector code of loops over them; the same bits from every machine.

#include <bit>
#include <cstdint>

namespace gloam {

struct SinCos {
  double sin = 0, cos = 0;
};

namespace wave_math {
// Added and taken off again it rounds to a whole number, ties to even.
inline constexpr double kRoundingMagic = 0x1.8p52;
inline double whole(double x) { return (x + kRoundingMagic) - kRoundingMagic; }
}  // namespace wave_math

/// Sine and cosine for |x| < 1e6, within 1e-9 of the exact ones; near 0 within 1e-13.
inline SinCos sin_cos(double x) {
  using wave_math::whole;
  // pi in two parts, of which the first has zeros enough for exact products.
  constexpr double kPi = 0x1.921fb544p+1, kPiRest = 0x1.0b4611a626331p-33;
  const double n = whole(x * 0.31830988618379067), half = 0.5 * n;
  const double r = (x - n * kPi) - n * kPiRest, u = r * r;
  const double sign = whole(half) == half ? 1.0 : -1.0;
  // Taylor's series on (-pi/2, pi/2).
  double s = 1.0 / 355687428096000, c = -1.0 / 6402373705728000;
  s = s * u - 1.0 / 1307674368000;
  s = s * u + 1.0 / 6227020800;
  s = s * u - 1.0 / 39916800;
  s = s * u + 1.0 / 362880;
  s = s * u - 1.0 / 5040;
  s = s * u + 1.0 / 120;
  s = s * u - 1.0 / 6;
  s = s * u + 1;
  c = c * u + 1.0 / 20922789888000;
  c = c * u - 1.0 / 87178291200;
  c = c * u + 1.0 / 479001600;
  c = c * u - 1.0 / 3628800;
  c = c * u + 1.0 / 40320;
  c = c * u - 1.0 / 720;
  c = c * u + 1.0 / 24;
  c = c * u - 0.5;
  c = c * u + 1;
  return {sign * s * r, sign * c};
}

/// Exponential for x from -700 to 700, within 1e-13 of the exact one; beyond as at the ends.
inline double exponential(double x) {
  constexpr double kLn2 = 0x1.62e42feep-1, kLn2Rest = 0x1.a39ef35793c76p-33;
  x = x < -700 ? -700 : x;
  x = x > 700 ? 700 : x;
  const double shifted = x * 1.4426950408889634 + wave_math::kRoundingMagic;
  const double n = shifted - wave_math::kRoundingMagic;
  const double r = (x - n * kLn2) - n * kLn2Rest;
  double p = 1.0 / 479001600;
  p = p * r + 1.0 / 39916800;
  p = p * r + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  p = p * r + 0.5;
  p = p * r + 1;
  p = p * r + 1;
  // The lowest bits of `shifted` are n: they become the exponent of a power of two.
  const auto bits = std::bit_cast<uint64_t>(shifted);
  return p * std::bit_cast<double>((bits + 1023) << 52);
}

/// Logarithm for x from 1e-300 to 1e300, within 1e-14 of the exact one, absolute or relative.
inline double logarithm(double x) {
  // x = m 2^n with m in [0.7, 1.42): n from the highest bits, as a whole number in those of 2^52.
  constexpr uint64_t kBase = 0x3FE6A09E00000000u;
  const uint64_t high = std::bit_cast<uint64_t>(x) - kBase + (uint64_t{1024} << 52);
  const double n = std::bit_cast<double>((high >> 52) | 0x4330000000000000u) - (0x1p52 + 1024);
  const auto m = std::bit_cast<double>((high & 0x000FFFFFFFFFFFFFu) + kBase);
  const double t = (m - 1) / (m + 1), u = t * t;  // log m = 2 artanh t
  double p = 2.0 / 17;
  p = p * u + 2.0 / 15;
  p = p * u + 2.0 / 13;
  p = p * u + 2.0 / 11;
  p = p * u + 2.0 / 9;
  p = p * u + 2.0 / 7;
  p = p * u + 2.0 / 5;
  p = p * u + 2.0 / 3;
  p = p * u + 2;
  return n * 0.69314718055994531 + p * t;
}

/// x^n of x from 1e-300 to 1e300 where that is within e^-700 and e^700, within 1e-12 of it.
inline double power(double x, double n) { return exponential(n * logarithm(x)); }

}  // namespace gloam
