#pragma once
// Pixels two by two, where lanes are blocks of pixels four wide: i ^ 1 is beside lane i, i ^ 4
// above or below it. Device-safe; one float is alone.

#include "render/kernel/math/lanes.h"

namespace gloam {

template <int kFlip>
GLOAM_HD float flip(float x) {
  return x;
}
#ifndef __CUDACC__
/// Lane i ^ kFlip in lane i.
template <int kFlip>
FloatLanes flip(FloatLanes x) {
#ifdef __AVX512F__
  return __builtin_shufflevector(x.v, x.v, 0 ^ kFlip, 1 ^ kFlip, 2 ^ kFlip, 3 ^ kFlip, 4 ^ kFlip,
                                 5 ^ kFlip, 6 ^ kFlip, 7 ^ kFlip, 8 ^ kFlip, 9 ^ kFlip, 10 ^ kFlip,
                                 11 ^ kFlip, 12 ^ kFlip, 13 ^ kFlip, 14 ^ kFlip, 15 ^ kFlip);
#else
  return __builtin_shufflevector(x.v, x.v, 0 ^ kFlip, 1 ^ kFlip, 2 ^ kFlip, 3 ^ kFlip, 4 ^ kFlip,
                                 5 ^ kFlip, 6 ^ kFlip, 7 ^ kFlip);
#endif
}
#endif
template <int kFlip, class F>
GLOAM_HD Vec3Of<F> flip(const Vec3Of<F>& v) {
  return {flip<kFlip>(v.x), flip<kFlip>(v.y), flip<kFlip>(v.z)};
}

namespace quads {

/// Lanes of the mask on the same instance as lane i ^ kFlip, with nearly its normal.
template <int kFlip, class F>
GLOAM_HD MaskOf<F> is_like(F instance, const Vec3Of<F>& normal) {
  constexpr float kCosine = 0.95f;
  return (instance == flip<kFlip>(instance)) & (dot(normal, flip<kFlip>(normal)) > kCosine);
}

}  // namespace quads

/// Lanes of the mask in quads all of which are of the mask and on one even surface.
template <class F>
GLOAM_HD MaskOf<F> even_quads(MaskOf<F> mask, UintOf<F> instance, const Vec3Of<F>& normal) {
  const F id = select(mask, to_float(instance), F(-1.0f));
  const MaskOf<F> alike = mask & quads::is_like<1>(id, normal) & quads::is_like<4>(id, normal);
  F all = select(alike, F(1.0f), F(0.0f));
  all *= flip<1>(all);
  all *= flip<4>(all);
  return all > 0.0f;
}

/// Sum over its quad, in each lane.
template <class F>
GLOAM_HD Vec3Of<F> quad_sums(Vec3Of<F> v) {
  v += flip<1>(v);
  return v + flip<4>(v);
}

}  // namespace gloam
