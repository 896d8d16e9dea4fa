#pragma once
// Momentum on the card: as momentum.h.

#include "sim/effects/gas/cuda/device_array.h"
#include "sim/effects/gas/kernel/trace.h"
#include "sim/effects/gas/openings.h"

namespace gloam::gas {

class CudaMomentum {
 public:
  CudaMomentum(const Openings& openings, cudaStream_t stream);

  void take_walls(const Openings& openings);
  void trace(const Faces<const float>& open, const Faces<const float>& velocity, float voxel,
             float dt);
  const float* smoothness() const { return smooth_.get(); }
  void carry(const Faces<const float>& open, DeviceArray<float> (&velocity)[3], float voxel,
             float dt, Vec3f wind);
  void lift(const Faces<const float>& open, const Faces<float>& velocity, const float* heat,
            const float* smoke, float ambient_density, float dt, uint32_t count);
  void confine(const Faces<const float>& open, const Faces<float>& velocity, float strength,
               float dt);

 private:
  Shape shape_;
  cudaStream_t stream_;
  float side_open_[6];
  DeviceArray<uint8_t> clearance_, solid_;
  DeviceArray<float> centre_[3], moved_[3], smooth_, trusted_, carried_, least_, most_, corrected_;
};

}  // namespace gloam::gas
