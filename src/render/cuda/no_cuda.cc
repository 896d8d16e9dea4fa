#include "render/cuda/cuda_stages.h"

namespace gloam {

Result<std::unique_ptr<CudaStages>> CudaStages::make() {
  return Error{ErrorKind::kUnsupported,
               "this build does not include CUDA",
               {},
               "rebuild with GLOAM_PRESET=cuda ./gloam setup, or use --device cpu"};
}

}  // namespace gloam
