#pragma once
// A camera's earlier pictures on the card, for the interactive tier.

#include "render/cuda/cuda_stages.h"
#include "render/cuda/device_memory.h"
#include "render/cuda/interactive_kernels.h"
#include "render/cuda/kernels.h"

namespace gloam::cuda {

/// How a picture of the interactive tier is sampled.
struct InteractiveSamples {
  int first = 0, count = 1;
  uint32_t frame = 0, log2_samples = 0;
};

class CudaHistory final : public ViewHistory {
 public:
  /// Forgets what does not lead to this picture: another size, a camera that was elsewhere than the
  /// picture's motion says. Returns the samples of the picture.
  InteractiveSamples begin(const CameraView32& camera, int width, int height);
  /// Queues the accumulation of the picture, whose light before the denoiser is `noisy`;
  /// film->radiance is then the mean of all.
  void add(const CameraView32& camera, const Vec3f* noisy, DeviceFilm* film, Stream stream);

 private:
  TemporalPlanes place(DeviceBuffer* buffer) const;

  int width_ = 0, height_ = 0;
  float weight_ = 1;        ///< of the picture that has begun
  uint32_t pictures_ = 0;   ///< before it
  Affine3f X_WC_;           ///< of the last one
  DeviceBuffer planes_[2];  ///< the last picture's at the index pictures_ % 2
  DeviceBuffer color_, shown_, blocks_;
};

}  // namespace gloam::cuda
