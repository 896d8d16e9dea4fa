#pragma once
// The steps of a cycle as launches.

#include <cuda_runtime_api.h>

#include "sim/effects/gas/kernel/poisson.h"

namespace gloam::gas {

struct Dampings {
  float of[2];
};

/// Integers along each axis.
struct Axes {
  const int* of[3];
};

/// A step of a cycle; kForth and kBack with the first or second damping.
enum class CycleStep : uint8_t { kBegin, kForth0, kForth1, kBack0, kBack1, kRestrict, kProlong };

struct CycleWork {
  CycleStep step;
  uint8_t level;
  uint8_t run;  ///< smoothing steps on this level from here on, 0 for others
};

/// Levels that one block keeps in its own memory.
struct SmallLevels {
  static constexpr int kArrays = 7;  ///< arrays of a level there: weights, inverse, x, b, scratch
  static constexpr int kMaxLevels = 12;
  static constexpr int kMostCells = 2048;  ///< limit of one level
  struct Level {
    Shape shape;
    const float* weight[3];
    const float* inverse;
    const int* start[3];
    const int* parent[3];
    int place;  ///< offset of its values in the block's memory
  };
  Level levels[kMaxLevels];
  int first, count, values;
  const CycleWork* works;
  const float* b;  ///< right side of the first level
  float* x;
};

/// The finest level's weights and inverse of its cells' open faces.
void spread_open_faces(const Shape& s, const uint8_t* open, const Faces<float>& weight,
                       float* inverse, cudaStream_t stream);
/// x = two damped steps from 0: kBegin, kBack1.
void smooth_from_nothing(const PoissonView& v, const uint8_t* open, const float* b, float* x,
                         Dampings damping, cudaStream_t stream);
/// to = a damped step from `from`. open: of the finest level, else null.
void smooth(const PoissonView& v, const uint8_t* open, const float* b, const float* from, float* to,
            float damping, cudaStream_t stream);
void restrict_to(const PoissonView& v, const uint8_t* open, const float* x, const float* b,
                 const Shape& coarse, const Axes& start, float* to, cudaStream_t stream);
/// to = a damped step from x and what the coarse level adds to it: kProlong, kForth1. `parent`:
/// with an entry before the first and one behind the last.
void prolong_and_smooth(const PoissonView& v, const uint8_t* open, const float* b, const float* x,
                        const Shape& coarse, const Axes& parent, const float* from, float* to,
                        float damping, cudaStream_t stream);
/// Once, before the first of work_on_small_levels().
void allow_small_levels(const SmallLevels& s);
/// Does works [from, to), which begin with x = 0 on the first small level.
void work_on_small_levels(const SmallLevels& s, int from, int to, cudaStream_t stream);

}  // namespace gloam::gas
