#include "sim/effects/gas/cuda/cuda_gas.h"

namespace gloam::gas {

Result<std::unique_ptr<CudaGas>> CudaGas::make(const GasGrid&, const Openings&, const Multigrid&,
                                               const HostFields&) {
  return Error{ErrorKind::kUnsupported,
               "this build does not include CUDA",
               {},
               "rebuild with GLOAM_PRESET=cuda ./gloam setup, or simulate the gas on the CPU"};
}

}  // namespace gloam::gas
