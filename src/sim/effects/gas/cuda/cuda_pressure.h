#pragma once
// Pressure on the card: the conjugate gradients of pressure.h, whose iteration is one graph of
// launches; the host looks at the residual's norm after each.

#include "sim/effects/gas/cuda/cuda_multigrid.h"
#include "sim/effects/gas/cuda/pressure_kernels.h"
#include "sim/effects/gas/pressure.h"

namespace gloam::gas {

class CudaPressure {
 public:
  /// `host`: pinned, gets the numbers when the host looks.
  CudaPressure(const Multigrid& multigrid, const Summing& summing, CardNumbers* host);
  CudaPressure(const CudaPressure&) = delete;
  CudaPressure& operator=(const CudaPressure&) = delete;
  ~CudaPressure();

  /// Copies walls that take_walls() changed on the host.
  void take_walls(const Openings& openings, const Multigrid& multigrid);
  Faces<const float> open() const { return multigrid_.finest().weight; }
  float* solution() { return x_.get(); }
  /// For a step of another length.
  void rescale(float factor);
  /// As Pressure::push(), Pressure::project().
  void push(const Faces<float>& velocity, const float* share);
  Projection project(const Faces<float>& velocity, const float* wanted, float voxel, float dt);

 private:
  void take_spaces(const Openings& openings);
  void look();  ///< the numbers come to the host

  Shape shape_;
  Summing summing_;
  CardNumbers* host_;
  CudaMultigrid multigrid_;
  DeviceArray<float> x_, target_, residual_, z_, p_, ap_, ones_;
  cudaGraphExec_t iteration_ = nullptr;

  EnclosedView enclosed_ = {};
  DeviceArray<int> cell_, space_of_, moving_, piece_begin_, space_begin_;
  DeviceArray<double> space_cells_, space_moving_, piece_sum_, space_sum_;
};

}  // namespace gloam::gas
