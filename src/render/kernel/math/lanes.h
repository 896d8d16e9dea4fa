#pragma once
// Numbers that the kernel computes with: one float, or several side by side. Code that is generic
// over F
// takes no branch that differs between lanes: it computes both sides and selects, and skips what no
// lane needs with any(). A lane gives the same bits as the float: same operations, same order.
//   F     float     FloatLanes
//   Mask  bool      MaskLanes
//   Uint  uint32_t  UintLanes
// Device-safe; nvcc sees the float side alone.

#include "base/vec.h"

namespace gloam {

GLOAM_HD bool any(bool mask) { return mask; }
GLOAM_HD bool all(bool mask) { return mask; }
GLOAM_HD uint32_t select(bool condition, uint32_t a, uint32_t b) { return condition ? a : b; }
GLOAM_HD bool select(bool condition, bool a, bool b) { return condition ? a : b; }
GLOAM_HD float floor_of(float x) { return floorf(x); }
GLOAM_HD float magnitude(float x) { return fabsf(x); }
/// x in [0, 2^31).
GLOAM_HD uint32_t to_uint(float x) { return static_cast<uint32_t>(static_cast<int32_t>(x)); }
/// x in [0, 2^31).
GLOAM_HD float to_float(uint32_t x) { return static_cast<float>(static_cast<int32_t>(x)); }
GLOAM_HD float gather(const float* table, uint32_t index) { return table[index]; }
GLOAM_HD uint32_t gather(const uint32_t* table, uint32_t index) { return table[index]; }
/// The bits of a float, and back.
GLOAM_HD uint32_t to_bits(float x) {
  uint32_t bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  return bits;
}
GLOAM_HD float from_bits(uint32_t bits) {
  float x;
  __builtin_memcpy(&x, &bits, sizeof x);
  return x;
}
GLOAM_HD float lane(float x, int) { return x; }
GLOAM_HD uint32_t lane(uint32_t x, int) { return x; }
GLOAM_HD bool lane(bool x, int) { return x; }
GLOAM_HD void set_lane(float* x, int, float value) { *x = value; }
GLOAM_HD void set_lane(uint32_t* x, int, uint32_t value) { *x = value; }
GLOAM_HD void set_lane(bool* x, int, bool value) { *x = value; }
/// Copies lane i of `from` into lane k of `to`.
template <class T>
GLOAM_HD void copy_lane(const T& from, int i, T* to, int k) {
  set_lane(to, k, lane(from, i));
}
/// Calls visit(i) for every lane i of the mask.
template <class Visit>
GLOAM_HD void each_lane(bool mask, const Visit& visit) {
  if (mask) visit(0);
}

/// Calls visit(lanes, value) for every value that `key` has in the lanes of the mask.
template <class Visit>
GLOAM_HD void each_value(bool mask, uint32_t key, const Visit& visit) {
  if (mask) visit(true, key);
}

template <class F>
struct Lanes {  // float
  static constexpr int kCount = 1;
  using Mask = bool;
  using Uint = uint32_t;
};
template <class F>
using MaskOf = typename Lanes<F>::Mask;
template <class F>
using UintOf = typename Lanes<F>::Uint;

}  // namespace gloam

#ifdef __CUDACC__
#define GLOAM_HD_LARGE GLOAM_HD
#else
#include "render/kernel/math/simd_lanes.h"
/// Large templates: calls on the CPU, so that one file compiles them for all that use them. In the
/// path stage, where a call costs 4 % of the time, they are compiled in place.
#ifdef GLOAM_LARGE_IN_PLACE
#define GLOAM_HD_LARGE
#else
#define GLOAM_HD_LARGE [[gnu::noinline]]
#endif
#endif

namespace gloam {

// Lanes of types over F are read, set, copied and selected by one list: Of<F>::Members.
namespace lane_copies {

template <class To, class From, auto... kTo, auto... kFrom>
GLOAM_HD void get(To* to, const From& from, int i, MemberList<kTo...>, MemberList<kFrom...>) {
  ((to->*kTo = lane(from.*kFrom, i)), ...);
}
template <class To, class From, auto... kTo, auto... kFrom>
GLOAM_HD void set(To* to, int i, const From& from, MemberList<kTo...>, MemberList<kFrom...>) {
  (set_lane(&(to->*kTo), i, from.*kFrom), ...);
}
template <class Mask, class T, auto... kMembers>
GLOAM_HD void select_each(T* to, Mask m, const T& a, const T& b, MemberList<kMembers...>) {
  ((to->*kMembers = select(m, a.*kMembers, b.*kMembers)), ...);
}
template <class T, auto... kMembers>
GLOAM_HD void copy(const T& from, int i, T* to, int k, MemberList<kMembers...>) {
  (copy_lane(from.*kMembers, i, &(to->*kMembers), k), ...);
}

}  // namespace lane_copies

template <template <class> class Of, class F>
GLOAM_HD Of<float> lane(const Of<F>& x, int i) {
  Of<float> out;
  lane_copies::get(&out, x, i, MembersOf<Of<float>>{}, typename Of<F>::Members{});
  return out;
}
template <template <class> class Of, class F>
GLOAM_HD void set_lane(Of<F>* x, int i, const Of<float>& value) {
  lane_copies::set(x, i, value, typename Of<F>::Members{}, MembersOf<Of<float>>{});
}
template <template <class> class Of, class F>
GLOAM_HD void copy_lane(const Of<F>& from, int i, Of<F>* to, int k) {
  static_assert(MembersOf<Of<float>>::kCount > 0);  // checks the list
  lane_copies::copy(from, i, to, k, typename Of<F>::Members{});
}
template <class F, template <class> class Of>
GLOAM_HD Of<F> select(MaskOf<F> m, const Of<F>& a, const Of<F>& b) {
  Of<F> out;
  lane_copies::select_each(&out, m, a, b, typename Of<F>::Members{});
  return out;
}

/// The same vector in every lane.
template <class F>
GLOAM_HD Vec3Of<F> in_all_lanes(Vec3f v) {
  return {F(v.x), F(v.y), F(v.z)};
}
template <class F>
GLOAM_HD AffineOf<F> pose_in_all_lanes(const Affine3f& X) {
  return {in_all_lanes<F>(X.x), in_all_lanes<F>(X.y), in_all_lanes<F>(X.z), in_all_lanes<F>(X.p)};
}

}  // namespace gloam
