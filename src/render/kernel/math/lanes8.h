#pragma once
// Eight lanes: masks are vectors of all bits or none. AVX registers where the compiler may use
// them, whatever else elsewhere. Part of simd_lanes.h.

namespace gloam {

struct MaskLanes {
  using Native = int32_t __attribute__((vector_size(32)));
  Native v{};

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

inline MaskLanes operator==(UintLanes a, UintLanes b) { return a.v == b.v; }
inline MaskLanes operator!=(UintLanes a, UintLanes b) { return a.v != b.v; }
inline MaskLanes operator>(UintLanes a, UintLanes b) { return a.v > b.v; }
inline MaskLanes operator>=(UintLanes a, UintLanes b) { return a.v >= b.v; }
inline MaskLanes operator<(FloatLanes a, FloatLanes b) { return a.v < b.v; }
inline MaskLanes operator<=(FloatLanes a, FloatLanes b) { return a.v <= b.v; }
inline MaskLanes operator>(FloatLanes a, FloatLanes b) { return a.v > b.v; }
inline MaskLanes operator>=(FloatLanes a, FloatLanes b) { return a.v >= b.v; }
inline MaskLanes operator==(FloatLanes a, FloatLanes b) { return a.v == b.v; }

inline FloatLanes select(MaskLanes m, FloatLanes a, FloatLanes b) { return m.v ? a.v : b.v; }
inline UintLanes select(MaskLanes m, UintLanes a, UintLanes b) { return m.v ? a.v : b.v; }
inline MaskLanes select(MaskLanes m, MaskLanes a, MaskLanes b) { return m.v ? a.v : b.v; }
#ifdef __AVX__
// Minimum and maximum as a < b ? a : b and a > b ? a : b, for not-a-number too.
inline FloatLanes min(FloatLanes a, FloatLanes b) {
  return reinterpret_cast<FloatLanes::Native>(
      _mm256_min_ps(reinterpret_cast<__m256>(a.v), reinterpret_cast<__m256>(b.v)));
}
inline FloatLanes max(FloatLanes a, FloatLanes b) {
  return reinterpret_cast<FloatLanes::Native>(
      _mm256_max_ps(reinterpret_cast<__m256>(a.v), reinterpret_cast<__m256>(b.v)));
}
#else
inline FloatLanes min(FloatLanes a, FloatLanes b) { return a.v < b.v ? a.v : b.v; }
inline FloatLanes max(FloatLanes a, FloatLanes b) { return a.v > b.v ? a.v : b.v; }
#endif
inline FloatLanes square_root(FloatLanes x) {
#ifdef __AVX__
  return reinterpret_cast<FloatLanes::Native>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x.v)));
#else
  FloatLanes out;
  for (int i = 0; i < kLaneCount; ++i) out.v[i] = sqrtf(x.v[i]);
  return out;
#endif
}
inline FloatLanes floor_of(FloatLanes x) {
#ifdef __AVX__
  return reinterpret_cast<FloatLanes::Native>(_mm256_floor_ps(reinterpret_cast<__m256>(x.v)));
#else
  FloatLanes out;
  for (int i = 0; i < kLaneCount; ++i) out.v[i] = floorf(x.v[i]);
  return out;
#endif
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
inline UintLanes gather(const uint32_t* table, UintLanes index) {
  UintLanes out;
  for (int i = 0; i < kLaneCount; ++i) out.v[i] = table[index.v[i]];
  return out;
}

}  // namespace gloam
