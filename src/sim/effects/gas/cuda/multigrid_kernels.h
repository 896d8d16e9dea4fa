#pragma once
// The steps of a cycle as launches.

#include <cuda_runtime_api.h>

#include "sim/effects/gas/kernel/poisson.h"

namespace gloam::gas {

/// A step of a cycle; kForth and kBack with the first or second damping.
enum class CycleStep : uint8_t { kBegin, kForth0, kForth1, kBack0, kBack1, kRestrict, kProlong };

struct CycleWork {
  CycleStep step;
  uint8_t level;
};

/// Levels that one block keeps in its own memory.
struct SmallLevels {
  static constexpr int kArrays = 7;  ///< of a level there: weights, inverse, x, b, scratch
  static constexpr int kMost = 12;
  struct Level {
    Shape shape;
    const float* weight[3];
    const float* inverse;
    const int* start[3];
    const int* parent[3];
    int place;  ///< of its values in the block's memory
  };
  Level levels[kMost];
  int first, count, values;
  const CycleWork* works;
  const float* b;  ///< of the first
  float* x;
};

struct Dampings {
  float of[2];
};

/// Integers along each axis.
struct Axes {
  const int* of[3];
};

/// The finest level's weights and inverse of its cells' open faces.
void spread_open_faces(const Shape& s, const uint8_t* open, const Faces<float>& weight,
                       float* inverse, cudaStream_t stream);
/// t = a damped step from 0.
void begin_level(const PoissonView& v, const float* b, float* t, float damping,
                 cudaStream_t stream);
/// to = a damped step from `from`. open: of the finest level, else null.
void smooth(const PoissonView& v, const uint8_t* open, const float* b, const float* from, float* to,
            float damping, cudaStream_t stream);
void restrict_to(const PoissonView& v, const uint8_t* open, const float* x, const float* b,
                 const Shape& coarse, const Axes& start, float* to, cudaStream_t stream);
void prolong_from(const PoissonView& v, const Shape& coarse, const Axes& parent, const float* from,
                  float* x, cudaStream_t stream);
/// Once, before the first of work_on_small_levels().
void allow_small_levels(const SmallLevels& s);
/// Does works [from, to), which begin with x = 0 on the first small level.
void work_on_small_levels(const SmallLevels& s, int from, int to, cudaStream_t stream);

}  // namespace gloam::gas
