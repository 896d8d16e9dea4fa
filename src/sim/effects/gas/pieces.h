#pragma once
// Values of fields around a piece of a row of places. Where air moves little, those around
// neighbours are neighbours: then they are read side by side, which takes a processor a fraction of
// the time that gathering them takes.

#include <algorithm>

#include "sim/effects/gas/kernel/carry.h"

namespace gloam::gas {

inline constexpr int kPiece = 16;  ///< places of a piece

/// Calls f(i, n) for pieces of n places from i on, n of them in all.
template <class F>
void for_pieces(int n, F&& f) {
  for (int i = 0; i < n; i += kPiece) f(i, std::min(kPiece, n - i));
}

/// Ways of a piece, in arrays: lanes write them.
class Ways {
 public:
  void set(int l, const Way& way) {
    c_[l] = way.at.c, x_[l] = way.at.x, y_[l] = way.at.y, z_[l] = way.at.z, past_[l] = way.past;
  }
  Way get(int l) const { return {{c_[l], x_[l], y_[l], z_[l]}, past_[l]}; }

  /// Are the lowest corners of n places side by side?
  bool are_even(int n) const {
    int differ = 0;
    for (int l = 0; l < n; ++l) differ |= c_[l] - l - c_[0];
    return differ == 0;
  }
  /// corners() of the l-th place of those.
  Corners even_corners(const Shape& s, const float* field, int l) const {
    const float *f = field + c_[0] + l, *f2 = f + s.sy, *f4 = f + s.sz, *f6 = f4 + s.sy;
    return {f[0], f[1], f2[0], f2[1], f4[0], f4[1], f6[0], f6[1]};
  }

 private:
  int c_[kPiece];
  float x_[kPiece], y_[kPiece], z_[kPiece], past_[kPiece];
};

/// Calls set(c, values of `field` around the way, way) for the ways way_of(i) of a row of n faces.
template <class WayOf, class Set>
void for_ways(const CarryView& view, const float* field, int j, int k, int n, const WayOf& way_of,
              const Set& set) {
  const Shape s = view.shape;
  for_pieces(n, [&](int from, int width) {
    const int begin = s.at(from, j, k);
    Ways ways;
    GLOAM_IVDEP
    for (int l = 0; l < width; ++l) ways.set(l, way_of(from + l));
    if (ways.are_even(width)) {
      GLOAM_IVDEP
      for (int l = 0; l < width; ++l) set(begin + l, ways.even_corners(s, field, l), ways.get(l));
    } else {
      GLOAM_IVDEP
      for (int l = 0; l < width; ++l) {
        const Way way = ways.get(l);
        set(begin + l, corners(s, field, way.at.c), way);
      }
    }
  });
}

}  // namespace gloam::gas
