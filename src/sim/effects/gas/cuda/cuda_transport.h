#pragma once
// Transport on the card: as transport.h, fluxes of all faces across an axis first, then the cells.

#include "sim/effects/gas/cuda/device_array.h"
#include "sim/effects/gas/cuda/summing.h"
#include "sim/effects/gas/transport.h"

namespace gloam::gas {

class CudaTransport {
 public:
  CudaTransport(const Shape& shape, const Summing& summing);

  /// For each face its speed times `scale`, 0 where closed; numbers->most of what leaves a cell.
  void set_courant(const Faces<const float>& open, const Faces<const float>& velocity, float scale);
  /// One substep; the axes' order depends on `parity`. numbers->escaped grows.
  void carry(const Faces<const float>& open, const ScalarFields& scalars, uint64_t parity);

 private:
  Shape shape_;
  Summing summing_;
  DeviceArray<float> courant_[3], flux_[kScalars];
};

}  // namespace gloam::gas
