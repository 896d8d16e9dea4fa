#include "sim/effects/gas/cuda/cuda_transport.h"
#include "sim/effects/gas/cuda/launch.cuh"

namespace gloam::gas {
namespace {

constexpr int kBorderThreads = 1024;

struct SweepView {
  Shape shape;
  int axis, stride, n;
  int before[2];  ///< axes swept before in this substep, -1 = none
  Faces<const float> courant;
  const float* open;
  ScalarFields scalars, flux;
};

/// Fluxes of all scalars through the face at c, the `m`th along the axis.
__device__ void find_flux(const SweepView& v, int c, int m) {
  // Two cells before it and two beyond; outside is ambient air.
  float air[4], amount[kScalars][4], any = 0;
  for (int t = 0; t < 4; ++t) {
    const int cell = c + (t - 2) * v.stride;
    const bool inside = m + t - 2 >= 0 && m + t - 2 < v.n;
    air[t] = inside ? air_left(v.shape, v.courant, v.before, cell) : 1.0f;
    for (int f = 0; f < kScalars; ++f) {
      amount[f][t] = inside ? v.scalars.of[f][cell] : 0.0f;
      any = max(any, amount[f][t]);
    }
  }
  if (any == 0.0f) {
    for (int f = 0; f < kScalars; ++f) v.flux.of[f][c] = 0.0f;
    return;
  }
  const float here = v.open[c], before = m > 0 ? v.open[c - v.stride] : 0.0f,
              beyond = m < v.n ? v.open[c + v.stride] : 0.0f;
  const float courant = v.courant[v.axis][c];
  for (int f = 0; f < kScalars; ++f) {
    float q[4];
    for (int t = 0; t < 4; ++t) q[t] = amount[f][t] / air[t];
    v.flux.of[f][c] = face_flux(courant, q[1], q[2], before * (q[1] - q[0]), here * (q[2] - q[1]),
                                beyond * (q[3] - q[2]), air[1], air[2]);
  }
}

/// Amounts that left through both sides of the box along the axis: a block for each scalar.
__global__ void __launch_bounds__(kBorderThreads) border_kernel(SweepView v, CardNumbers* numbers) {
  __shared__ double sums[kBorderThreads];
  const float* flux = v.flux.of[blockIdx.x];
  const Shape& s = v.shape;
  const int width = v.axis == 0 ? s.ny : s.nx, height = v.axis == 2 ? s.ny : s.nz;
  double sum = 0;
  for (int n = int(threadIdx.x); n < width * height; n += kBorderThreads) {
    const int d = n % width, e = n / width;
    const int c = v.axis == 0 ? s.at(0, d, e) : (v.axis == 1 ? s.at(d, 0, e) : s.at(d, e, 0));
    sum += double(flux[c + v.n * v.stride]) - double(flux[c]);
  }
  sums[threadIdx.x] = sum;
  for (int half = kBorderThreads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (int(threadIdx.x) < half) sums[threadIdx.x] += sums[int(threadIdx.x) + half];
  }
  if (threadIdx.x == 0) numbers->escaped[blockIdx.x] += sums[0];
}

void sweep(const SweepView& v, const Summing& to) {
  const Shape s = v.shape;
  for_cells(s.faces(v.axis), to.stream, [v] __device__(int i, int j, int k) {
    find_flux(v, v.shape.at(i, j, k), v.axis == 0 ? i : (v.axis == 1 ? j : k));
  });
  for_cells(s, to.stream, [v] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    for (int f = 0; f < kScalars; ++f) {
      const float* flux = v.flux.of[f];
      float* field = v.scalars.of[f];
      field[c] = max(field[c] - (flux[c + v.stride] - flux[c]), 0.0f);
    }
  });
  border_kernel<<<kScalars, kBorderThreads, 0, to.stream>>>(v, to.numbers);
}

void set_courant_of_faces(const Shape& s, const Faces<const float>& open,
                          const Faces<const float>& velocity, const Faces<float>& to, float scale,
                          cudaStream_t stream) {
  for_faces(s, stream, [open, velocity, to, scale] __device__(int axis, int c) {
    to[axis][c] = open[axis][c] * velocity[axis][c] * scale;
  });
}

void find_most_outflow(const Shape& s, const Faces<const float>& courant, const Summing& to) {
  find_most(s, to, [s, courant] __device__(int c) { return most_outflow(s, courant, c); });
}

}  // namespace

CudaTransport::CudaTransport(const Shape& shape, const Summing& summing)
    : shape_(shape), summing_(summing) {
  for (auto& f : courant_) f.reserve(size_t(shape.size()));
  for (auto& f : flux_) f.reserve(size_t(shape.size()));
}

void CudaTransport::set_courant(const Faces<const float>& open, const Faces<const float>& velocity,
                                float scale) {
  const Faces<float> courant{courant_[0].get(), courant_[1].get(), courant_[2].get()};
  set_courant_of_faces(shape_, open, velocity, courant, scale, summing_.stream);
  find_most_outflow(shape_, courant.read(), summing_);
}

void CudaTransport::carry(const Faces<const float>& open, const ScalarFields& scalars,
                          uint64_t parity) {
  const int* order = kOrders[parity % 6];
  SweepView v;
  v.shape = shape_;
  v.courant = {courant_[0].get(), courant_[1].get(), courant_[2].get()};
  v.scalars = scalars;
  for (int f = 0; f < kScalars; ++f) v.flux.of[f] = flux_[f].get();
  for (int m = 0; m < 3; ++m) {
    v.axis = order[m];
    v.stride = shape_.stride(v.axis);
    v.n = shape_.n(v.axis);
    v.before[0] = m > 0 ? order[0] : -1;
    v.before[1] = m > 1 ? order[1] : -1;
    v.open = open[v.axis];
    sweep(v, summing_);
  }
}

}  // namespace gloam::gas
