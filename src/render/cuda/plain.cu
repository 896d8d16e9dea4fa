// Kernels of the direct stage and the exact channels, for plain scenes (ARCHITECTURE.md,
// kPlainScenes).
#define GLOAM_PLAIN_KERNELS
#include "render/cuda/direct_kernels.cuh"

namespace gloam::cuda {

void launch_plain_direct(const DevicePicture& p, Stream stream) {
  direct_kernel<<<blocks_for(p, 1), kBlock, 0, stream>>>(p);
}
void launch_plain_channels(const DevicePicture& p, ChannelRays rays, Stream stream) {
  channels_kernel<<<blocks_for(p, 1), kBlock, 0, stream>>>(p, rays);
}

}  // namespace gloam::cuda
