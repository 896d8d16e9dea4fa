#include "sim/effects/gas/cuda/gas_kernels.h"

#include "sim/effects/gas/cuda/launch.cuh"

namespace gloam::gas {

void react_all(const Shape& s, const ReactionRates& rates, float power, const ScalarFields& f,
               float* heated, float* burning, const Summing& to) {
  sum_cells<4>(
      s, to,
      [rates, power, f, heated, burning] __device__(int c, float(&sum)[4]) {
        const Reaction out = react(rates, f.of[kHeat] + c, f.of[kSmoke] + c, f.of[kFuel] + c,
                                   f.of[kSpent] + c, heated + c);
        burning[c] = out.burnt * power;
        sum[0] += out.heat_made, sum[1] += out.heat_lost;
        sum[2] += out.burnt, sum[3] += out.settled;
      },
      [] __device__(CardNumbers * n, const double(&sum)[4]) {
        for (int i = 0; i < 4; ++i) n->reaction[i] = sum[i];
      });
}

void give(const Gift& gift, const int* cells, const ScalarFields& f, float* heated,
          cudaStream_t stream) {
  for_range(gift.cells, stream, [gift, cells, f, heated] __device__(int n) {
    const int c = cells[n];
    heated[c] += gift.heat;
    f.of[kSmoke][c] += gift.smoke;
    f.of[kFuel][c] += gift.fuel;
  });
}

void blow(const Gift& gift, const int* cells, const Shape& s, const Faces<const float>& open,
          const Faces<float>& u, cudaStream_t stream) {
  for_range(gift.cells, stream, [gift, cells, s, open, u] __device__(int n) {
    for (int a = 0; a < 3; ++a) {
      for (int side = 0; side < 2; ++side) {
        const int face = cells[n] + side * s.stride(a);
        if (open[a][face] > 0.0f) u[a][face] = gift.velocity[a];
      }
    }
  });
}

void stop_closed_faces(const Shape& s, const Faces<const float>& open, const Faces<float>& u,
                       cudaStream_t stream) {
  for_faces(s, stream, [open, u] __device__(int axis, int c) {
    if (!(open[axis][c] > 0.0f)) u[axis][c] = 0.0f;
  });
}

void set_values(float* to, const int* at, const float* values, int count, cudaStream_t stream) {
  for_range(count, stream, [to, at, values] __device__(int n) { to[at[n]] = values[n]; });
}

void add_values(float* to, const int* at, const float* values, int count, cudaStream_t stream) {
  for_range(count, stream, [to, at, values] __device__(int n) { to[at[n]] += values[n]; });
}

void copy_cells(const CellValues& fields, const int* cells, int count, float* values, bool to_field,
                cudaStream_t stream) {
  for_range(count, stream, [fields, cells, count, values, to_field] __device__(int n) {
    for (int f = 0; f < kCellValues; ++f) {
      float &in_field = fields.of[f][cells[n]], &in_list = values[f * count + n];
      (to_field ? in_field : in_list) = to_field ? in_list : in_field;
    }
  });
}

void find_speed(const Shape& s, const Faces<const float>& u, const Summing& to) {
  find_most(s, to, [s, u] __device__(int c) { return speed_squared(s, u, c); });
}

}  // namespace gloam::gas
