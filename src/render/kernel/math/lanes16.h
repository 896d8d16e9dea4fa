#pragma once
// Sixteen lanes of AVX-512: masks are bits. Part of simd_lanes.h.

namespace gloam {

struct MaskLanes {
  __mmask16 v = 0;  ///< bit i = lane i

  MaskLanes() = default;
  MaskLanes(__mmask16 native) : v(native) {}
  MaskLanes(bool x) : v(x ? 0xFFFF : 0) {}
  friend MaskLanes operator&(MaskLanes a, MaskLanes b) { return narrow(a.v & b.v); }
  friend MaskLanes operator|(MaskLanes a, MaskLanes b) { return narrow(a.v | b.v); }
  friend MaskLanes operator!(MaskLanes a) { return narrow(~a.v); }

 private:
  static __mmask16 narrow(int bits) { return static_cast<__mmask16>(bits); }
};

inline bool any(MaskLanes m) { return m.v != 0; }
/// Bit i = lane i.
inline uint32_t bits_of(MaskLanes m) { return m.v; }
inline bool lane(MaskLanes m, int i) { return (m.v >> i & 1) != 0; }
inline void set_lane(MaskLanes* m, int i, bool value) {
  m->v = static_cast<__mmask16>((m->v & ~(1 << i)) | (value ? 1 << i : 0));
}

namespace lanes {
// Intrinsics with a mask: GCC 12 warns of its own header in those without.
inline constexpr __mmask16 kAll = 0xFFFF;
inline __m512 native(FloatLanes x) { return reinterpret_cast<__m512>(x.v); }
inline __m512i native(UintLanes x) { return reinterpret_cast<__m512i>(x.v); }
inline FloatLanes of(__m512 x) { return reinterpret_cast<FloatLanes::Native>(x); }
inline UintLanes of(__m512i x) { return reinterpret_cast<UintLanes::Native>(x); }
template <int kOrder>
MaskLanes compare(FloatLanes a, FloatLanes b) {
  return _mm512_cmp_ps_mask(native(a), native(b), kOrder);
}
}  // namespace lanes

inline MaskLanes operator==(UintLanes a, UintLanes b) {
  return _mm512_cmpeq_epu32_mask(lanes::native(a), lanes::native(b));
}
inline MaskLanes operator!=(UintLanes a, UintLanes b) {
  return _mm512_cmpneq_epu32_mask(lanes::native(a), lanes::native(b));
}
inline MaskLanes operator>(UintLanes a, UintLanes b) {
  return _mm512_cmpgt_epu32_mask(lanes::native(a), lanes::native(b));
}
inline MaskLanes operator>=(UintLanes a, UintLanes b) {
  return _mm512_cmpge_epu32_mask(lanes::native(a), lanes::native(b));
}
inline MaskLanes operator<(FloatLanes a, FloatLanes b) { return lanes::compare<_CMP_LT_OQ>(a, b); }
inline MaskLanes operator<=(FloatLanes a, FloatLanes b) { return lanes::compare<_CMP_LE_OQ>(a, b); }
inline MaskLanes operator>(FloatLanes a, FloatLanes b) { return lanes::compare<_CMP_GT_OQ>(a, b); }
inline MaskLanes operator>=(FloatLanes a, FloatLanes b) { return lanes::compare<_CMP_GE_OQ>(a, b); }
inline MaskLanes operator==(FloatLanes a, FloatLanes b) { return lanes::compare<_CMP_EQ_OQ>(a, b); }

inline FloatLanes select(MaskLanes m, FloatLanes a, FloatLanes b) {
  return lanes::of(_mm512_mask_blend_ps(m.v, lanes::native(b), lanes::native(a)));
}
inline UintLanes select(MaskLanes m, UintLanes a, UintLanes b) {
  return lanes::of(_mm512_mask_blend_epi32(m.v, lanes::native(b), lanes::native(a)));
}
inline MaskLanes select(MaskLanes m, MaskLanes a, MaskLanes b) { return (m & a) | (b & !m); }
// Minimum and maximum as a < b ? a : b and a > b ? a : b, for not-a-number too.
inline FloatLanes min(FloatLanes a, FloatLanes b) {
  return lanes::of(_mm512_maskz_min_ps(lanes::kAll, lanes::native(a), lanes::native(b)));
}
inline FloatLanes max(FloatLanes a, FloatLanes b) {
  return lanes::of(_mm512_maskz_max_ps(lanes::kAll, lanes::native(a), lanes::native(b)));
}
inline FloatLanes square_root(FloatLanes x) {
  return lanes::of(_mm512_maskz_sqrt_ps(lanes::kAll, lanes::native(x)));
}
inline FloatLanes floor_of(FloatLanes x) {
  return lanes::of(_mm512_maskz_roundscale_ps(lanes::kAll, lanes::native(x),
                                              _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
}
inline FloatLanes gather(const float* table, UintLanes index) {
  return lanes::of(
      _mm512_mask_i32gather_ps(_mm512_setzero_ps(), lanes::kAll, lanes::native(index), table, 4));
}
inline UintLanes gather(const uint32_t* table, UintLanes index) {
  return lanes::of(_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), lanes::kAll,
                                               lanes::native(index), table, 4));
}

}  // namespace gloam
