#pragma once
// Eight lanes by GCC's and Clang's vector extensions: AVX registers where the compiler may use
// them, whatever else elsewhere, with the same results.

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "base/vec.h"

namespace gloam {

inline constexpr int kLaneCount = 8;

struct MaskLanes {
  using Native = int32_t __attribute__((vector_size(32)));
  Native v{};  ///< all bits or none

  MaskLanes() = default;
  MaskLanes(Native native) : v(native) {}
  MaskLanes(bool x) : v(Native{} - static_cast<int32_t>(x)) {}
  friend MaskLanes operator&(MaskLanes a, MaskLanes b) { return a.v & b.v; }
  friend MaskLanes operator|(MaskLanes a, MaskLanes b) { return a.v | b.v; }
  friend MaskLanes operator!(MaskLanes a) { return ~a.v; }
};

inline bool any(MaskLanes m) {
#ifdef __AVX__
  return _mm256_testz_si256(reinterpret_cast<__m256i>(m.v), reinterpret_cast<__m256i>(m.v)) == 0;
#else
  int32_t bits = 0;
  for (int i = 0; i < kLaneCount; ++i) bits |= m.v[i];
  return bits != 0;
#endif
}
inline bool all(MaskLanes m) { return !any(!m); }
/// Bit i = lane i.
inline uint32_t bits_of(MaskLanes m) {
#ifdef __AVX__
  return static_cast<uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(m.v)));
#else
  uint32_t bits = 0;
  for (int i = 0; i < kLaneCount; ++i) bits |= (m.v[i] != 0 ? 1u : 0u) << i;
  return bits;
#endif
}
inline bool lane(MaskLanes m, int i) { return m.v[i] != 0; }
inline void set_lane(MaskLanes* m, int i, bool value) { m->v[i] = value ? -1 : 0; }

struct UintLanes {
  using Native = uint32_t __attribute__((vector_size(32)));
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
  friend MaskLanes operator==(UintLanes a, UintLanes b) { return a.v == b.v; }
  friend MaskLanes operator!=(UintLanes a, UintLanes b) { return a.v != b.v; }
  friend MaskLanes operator>(UintLanes a, UintLanes b) { return a.v > b.v; }
  friend MaskLanes operator>=(UintLanes a, UintLanes b) { return a.v >= b.v; }
};
inline uint32_t lane(const UintLanes& x, int i) { return x.v[i]; }
inline void set_lane(UintLanes* x, int i, uint32_t value) { x->v[i] = value; }

struct FloatLanes {
  using Native = float __attribute__((vector_size(32)));
  Native v{};

  FloatLanes() = default;
  FloatLanes(Native native) : v(native) {}
  FloatLanes(float x) : v{x, x, x, x, x, x, x, x} {}
  friend FloatLanes operator+(FloatLanes a, FloatLanes b) { return a.v + b.v; }
  friend FloatLanes operator-(FloatLanes a, FloatLanes b) { return a.v - b.v; }
  friend FloatLanes operator-(FloatLanes a) { return -a.v; }
  friend FloatLanes operator*(FloatLanes a, FloatLanes b) { return a.v * b.v; }
  friend FloatLanes operator/(FloatLanes a, FloatLanes b) { return a.v / b.v; }
  friend FloatLanes& operator+=(FloatLanes& a, FloatLanes b) { return a = a + b; }
  friend FloatLanes& operator-=(FloatLanes& a, FloatLanes b) { return a = a - b; }
  friend FloatLanes& operator*=(FloatLanes& a, FloatLanes b) { return a = a * b; }
  friend MaskLanes operator<(FloatLanes a, FloatLanes b) { return a.v < b.v; }
  friend MaskLanes operator<=(FloatLanes a, FloatLanes b) { return a.v <= b.v; }
  friend MaskLanes operator>(FloatLanes a, FloatLanes b) { return a.v > b.v; }
  friend MaskLanes operator>=(FloatLanes a, FloatLanes b) { return a.v >= b.v; }
  friend MaskLanes operator==(FloatLanes a, FloatLanes b) { return a.v == b.v; }
};
inline float lane(const FloatLanes& x, int i) { return x.v[i]; }
inline void set_lane(FloatLanes* x, int i, float value) { x->v[i] = value; }

inline FloatLanes select(MaskLanes m, FloatLanes a, FloatLanes b) { return m.v ? a.v : b.v; }
inline UintLanes select(MaskLanes m, UintLanes a, UintLanes b) { return m.v ? a.v : b.v; }
inline MaskLanes select(MaskLanes m, MaskLanes a, MaskLanes b) { return m.v ? a.v : b.v; }
inline FloatLanes min(FloatLanes a, FloatLanes b) { return a.v < b.v ? a.v : b.v; }
inline FloatLanes max(FloatLanes a, FloatLanes b) { return a.v > b.v ? a.v : b.v; }
inline FloatLanes clamp(FloatLanes x, FloatLanes lo, FloatLanes hi) { return min(max(x, lo), hi); }
inline FloatLanes lerp(FloatLanes a, FloatLanes b, FloatLanes t) { return a + (b - a) * t; }
inline FloatLanes sqr(FloatLanes x) { return x * x; }
inline FloatLanes square_root(FloatLanes x) {
#ifdef __AVX__
  return reinterpret_cast<FloatLanes::Native>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x.v)));
#else
  FloatLanes out;
  for (int i = 0; i < kLaneCount; ++i) out.v[i] = sqrtf(x.v[i]);
  return out;
#endif
}
inline FloatLanes safe_sqrt(FloatLanes x) { return square_root(max(x, 0.0f)); }
inline FloatLanes floor_of(FloatLanes x) {
#ifdef __AVX__
  return reinterpret_cast<FloatLanes::Native>(_mm256_floor_ps(reinterpret_cast<__m256>(x.v)));
#else
  FloatLanes out;
  for (int i = 0; i < kLaneCount; ++i) out.v[i] = floorf(x.v[i]);
  return out;
#endif
}
inline FloatLanes magnitude(FloatLanes x) {
  return reinterpret_cast<FloatLanes::Native>(reinterpret_cast<UintLanes::Native>(x.v) &
                                              0x7FFFFFFFu);
}
inline UintLanes to_uint(FloatLanes x) {
  return reinterpret_cast<UintLanes::Native>(__builtin_convertvector(x.v, MaskLanes::Native));
}
inline FloatLanes to_float(UintLanes x) {
  return __builtin_convertvector(reinterpret_cast<MaskLanes::Native>(x.v), FloatLanes::Native);
}
inline FloatLanes gather(const float* table, UintLanes index) {
#ifdef __AVX2__
  return reinterpret_cast<FloatLanes::Native>(
      _mm256_i32gather_ps(table, reinterpret_cast<__m256i>(index.v), 4));
#else
  FloatLanes out;
  for (int i = 0; i < kLaneCount; ++i) out.v[i] = table[index.v[i]];
  return out;
#endif
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
