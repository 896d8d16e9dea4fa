#pragma once
// Memory and results of kernels that sum over a grid.

#include <cuda_runtime_api.h>

#include "sim/effects/gas/kernel/transport.h"

namespace gloam::gas {

/// Numbers that kernels leave for the host and for each other: one struct in the card's memory.
struct CardNumbers {
  double reaction[4], escaped[4];
  double before, norm, rz, after;  ///< sums of the projection: norms, residual times preconditioned
  float alpha, beta;               ///< factors of the conjugate gradients' iteration
  int fresh;                       ///< 1: no direction to go on from
  int positive;                    ///< 0: the curvature is none, nothing is left but rounding
  int most;                        ///< bits of a float that is at least 0
  unsigned finished;               ///< slabs of the sum that is on its way
};

/// Memory that sums need: `slabs`, N for each.
struct Summing {
  double* slabs;
  CardNumbers* numbers;
  cudaStream_t stream;
};

struct ScalarFields {
  float* of[kScalars];
};

}  // namespace gloam::gas
