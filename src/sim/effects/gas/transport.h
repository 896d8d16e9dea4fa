#pragma once
// Carries the scalars by a velocity that stays for the step, in as many substeps as it takes.

#include "sim/effects/gas/kernel/transport.h"
#include "sim/effects/gas/openings.h"

namespace gloam::gas {

/// Share of its air that may leave a cell in a sweep.
inline constexpr float kMostOutflow = 0.95f;
/// Orders of the axes, in turn from substep to substep.
inline constexpr int kOrders[6][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0},
                                      {0, 2, 1}, {2, 0, 1}, {1, 0, 2}};

class Transport {
 public:
  static uint64_t bytes(uint64_t cells) { return cells * 4 * 3; }

  explicit Transport(const Shape& shape);

  /// Carries all scalars for `dt`; the axes' order depends on `parity`, which counts substeps.
  /// Adds what left through open sides to `escaped`, in cells' volumes. Returns the substeps.
  int carry(const Faces<const float>& open, const Faces<const float>& velocity, Field* scalars,
            float voxel, float dt, uint64_t* parity, double (&escaped)[kScalars]);

 private:
  struct Sweep;
  float set_courant(const Faces<const float>& open, const Faces<const float>& velocity,
                    float scale);
  void sweep_x(const Sweep& sweep);
  void sweep_across(const Sweep& sweep);
  void sweep_block(const Sweep& sweep, int first, int width, double* escaped);

  Shape shape_;
  Field courant_[3];  ///< Courant numbers of faces: speed dt / voxel, 0 where closed
  std::vector<float> row_most_;
  std::vector<double> row_escaped_;
};

}  // namespace gloam::gas
