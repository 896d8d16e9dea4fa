#pragma once
// Launches of kernels for the cells of a gas, and copies of a few cells.

#include "sim/effects/gas/cuda/gift.h"
#include "sim/effects/gas/cuda/summing.h"
#include "sim/effects/gas/kernel/reaction.h"

namespace gloam::gas {

inline constexpr int kCellValues = kScalars + 1;  ///< values of a cell: scalars, heat release
struct CellValues {
  float* of[kCellValues];
};

/// numbers->reaction = sums of heat made, heat lost, fuel burnt, smoke settled.
void react_all(const Shape& s, const ReactionRates& rates, float power, const ScalarFields& f,
               float* heated, float* burning, const Summing& to);
void give(const Gift& gift, const int* cells, const ScalarFields& f, float* heated,
          cudaStream_t stream);
void blow(const Gift& gift, const int* cells, const Shape& s, const Faces<const float>& open,
          const Faces<float>& u, cudaStream_t stream);
/// Closed faces stand still.
void stop_closed_faces(const Shape& s, const Faces<const float>& open, const Faces<float>& u,
                       cudaStream_t stream);
/// to[at[n]] = values[n].
void set_values(float* to, const int* at, const float* values, int count, cudaStream_t stream);
/// to[at[n]] += values[n].
void add_values(float* to, const int* at, const float* values, int count, cudaStream_t stream);
/// Between fields and a list of these cells' values: those of each field one after the other.
void copy_cells(const CellValues& fields, const int* cells, int count, float* values, bool to_field,
                cudaStream_t stream);
/// numbers->most of squares of speed.
void find_speed(const Shape& s, const Faces<const float>& u, const Summing& to);

}  // namespace gloam::gas
