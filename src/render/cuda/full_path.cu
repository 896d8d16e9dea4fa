// Kernel of the path stage, for any scene.
#include "render/cuda/path_kernel.cuh"

namespace gloam::cuda {

void launch_full_path(const DevicePicture& p, Stream stream) {
  path_kernel<<<blocks_for(p, p.split), kBlock, 0, stream>>>(p);
}

}  // namespace gloam::cuda
