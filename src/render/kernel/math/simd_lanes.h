#pragma once
// Lanes by GCC's and Clang's vector extensions: sixteen in AVX-512 registers, else eight, with the
// same results in each lane whatever the machine. Masks and what has no operator are in lanes16.h
// and lanes8.h.

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "base/vec.h"

namespace gloam {

#ifdef __AVX512F__
inline constexpr int kLaneCount = 16;
#else
inline constexpr int kLaneCount = 8;
#endif

struct UintLanes {
  using Native = uint32_t __attribute__((vector_size(4 * kLaneCount)));
  Native v{};

  UintLanes() = default;
  UintLanes(Native native) : v(native) {}
  UintLanes(uint32_t x) : v(Native{} + x) {}
  friend UintLanes operator+(UintLanes a, UintLanes b) { return a.v + b.v; }
  friend UintLanes operator*(UintLanes a, UintLanes b) { return a.v * b.v; }
  friend UintLanes operator&(UintLanes a, UintLanes b) { return a.v & b.v; }
  friend UintLanes operator|(UintLanes a, UintLanes b) { return a.v | b.v; }
  friend UintLanes operator^(UintLanes a, UintLanes b) { return a.v ^ b.v; }
  friend UintLanes operator<<(UintLanes a, int n) { return a.v << n; }
  friend UintLanes operator>>(UintLanes a, int n) { return a.v >> n; }
  friend UintLanes& operator+=(UintLanes& a, UintLanes b) { return a = a + b; }
  friend UintLanes& operator^=(UintLanes& a, UintLanes b) { return a = a ^ b; }
  friend UintLanes& operator&=(UintLanes& a, UintLanes b) { return a = a & b; }
};
inline uint32_t lane(const UintLanes& x, int i) { return x.v[i]; }
inline void set_lane(UintLanes* x, int i, uint32_t value) { x->v[i] = value; }

struct FloatLanes {
  using Native = float __attribute__((vector_size(4 * kLaneCount)));
  Native v{};

  FloatLanes() = default;
  FloatLanes(Native native) : v(native) {}
  FloatLanes(float x) : v(x - Native{}) {}  // x + 0 would turn -0 into 0
  friend FloatLanes operator+(FloatLanes a, FloatLanes b) { return a.v + b.v; }
  friend FloatLanes operator-(FloatLanes a, FloatLanes b) { return a.v - b.v; }
  friend FloatLanes operator-(FloatLanes a) { return -a.v; }
  friend FloatLanes operator*(FloatLanes a, FloatLanes b) { return a.v * b.v; }
  friend FloatLanes operator/(FloatLanes a, FloatLanes b) { return a.v / b.v; }
  friend FloatLanes& operator+=(FloatLanes& a, FloatLanes b) { return a = a + b; }
  friend FloatLanes& operator-=(FloatLanes& a, FloatLanes b) { return a = a - b; }
  friend FloatLanes& operator*=(FloatLanes& a, FloatLanes b) { return a = a * b; }
};
inline float lane(const FloatLanes& x, int i) { return x.v[i]; }
inline void set_lane(FloatLanes* x, int i, float value) { x->v[i] = value; }
inline UintLanes to_bits(FloatLanes x) { return reinterpret_cast<UintLanes::Native>(x.v); }
inline FloatLanes from_bits(UintLanes x) { return reinterpret_cast<FloatLanes::Native>(x.v); }

}  // namespace gloam

#ifdef __AVX512F__
#include "render/kernel/math/lanes16.h"
#else
#include "render/kernel/math/lanes8.h"
#endif

namespace gloam {

inline bool all(MaskLanes m) { return !any(!m); }
template <class Visit>
void each_lane(MaskLanes mask, const Visit& visit) {
  for (uint32_t left = bits_of(mask); left != 0; left &= left - 1) visit(__builtin_ctz(left));
}
template <class Visit>
void each_value(MaskLanes mask, UintLanes key, const Visit& visit) {
  for (MaskLanes left = mask; any(left);) {
    const uint32_t value = lane(key, __builtin_ctz(bits_of(left)));
    const MaskLanes same = left & (key == value);
    visit(same, value);
    left = left & !same;
  }
}
inline FloatLanes clamp(FloatLanes x, FloatLanes lo, FloatLanes hi) { return min(max(x, lo), hi); }
inline FloatLanes lerp(FloatLanes a, FloatLanes b, FloatLanes t) { return a + (b - a) * t; }
inline FloatLanes sqr(FloatLanes x) { return x * x; }
inline FloatLanes safe_sqrt(FloatLanes x) { return square_root(max(x, 0.0f)); }
inline FloatLanes magnitude(FloatLanes x) {
  return reinterpret_cast<FloatLanes::Native>(reinterpret_cast<UintLanes::Native>(x.v) &
                                              0x7FFFFFFFu);
}
using IntNative = int32_t __attribute__((vector_size(4 * kLaneCount)));
inline UintLanes to_uint(FloatLanes x) {
  return reinterpret_cast<UintLanes::Native>(__builtin_convertvector(x.v, IntNative));
}
inline FloatLanes to_float(UintLanes x) {
  return __builtin_convertvector(reinterpret_cast<IntNative>(x.v), FloatLanes::Native);
}

template <class F>
struct Lanes;
template <>
struct Lanes<FloatLanes> {
  static constexpr int kCount = kLaneCount;
  using Mask = MaskLanes;
  using Uint = UintLanes;
};

}  // namespace gloam
