// Ends of segments in scenes without media.
#define GLOAM_KERNELS_WITHOUT_MEDIA
#include "render/cuda/wave_arrive.cuh"

namespace gloam::cuda {

void launch_wave_arrive(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  arrive_kernel<<<w.blocks, kBlock, 0, stream>>>(p, w);
}

}  // namespace gloam::cuda
