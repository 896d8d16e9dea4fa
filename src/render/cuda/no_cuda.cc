#include "render/cuda/cuda_stages.h"

namespace gloam {

Result<std::unique_ptr<CudaStages>> CudaStages::make() {
  return Error{ErrorKind::kUnsupported,
               "this build has no CUDA",
               {},
               "build it with GLOAM_PRESET=cuda ./gloam setup, or use --device cpu"};
}

}  // namespace gloam
