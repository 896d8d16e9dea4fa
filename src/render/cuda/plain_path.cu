// Kernel of the path stage, for plain scenes (ARCHITECTURE.md, kPlainScenes).
#define GLOAM_PLAIN_KERNELS
#include "render/cuda/path_kernel.cuh"

namespace gloam::cuda {

void launch_plain_path(const DevicePicture& p, Stream stream) {
  path_kernel<<<blocks_for(p, p.split), kBlock, 0, stream>>>(p);
}

}  // namespace gloam::cuda
