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

}  // namespace gloam::gas
