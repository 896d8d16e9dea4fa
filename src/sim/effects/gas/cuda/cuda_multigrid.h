#pragma once
// Multigrid's cycle on the card: a launch for each step on large levels, one block that stays for
// all of the small ones, where launches would take longer than their work.

#include <vector>

#include "sim/effects/gas/cuda/device_array.h"
#include "sim/effects/gas/cuda/multigrid_kernels.h"
#include "sim/effects/gas/multigrid.h"

namespace gloam::gas {

struct CudaLevel {
  Shape shape;
  DeviceArray<float> weight[3], inverse, x, b, scratch;
  DeviceArray<int> start[3];   ///< as Multigrid::start(), of levels but the finest
  DeviceArray<int> parent[3];  ///< parents of the finer level's cells and ghosts

  PoissonView view() const {
    return {shape, {weight[0].get(), weight[1].get(), weight[2].get()}, inverse.get()};
  }
};

class CudaMultigrid {
 public:
  explicit CudaMultigrid(const Multigrid& multigrid);

  /// After the host's update().
  void take(const Multigrid& multigrid, cudaStream_t stream);
  PoissonView finest() const { return levels_[0].view(); }
  const uint8_t* open_faces() const { return open_.get(); }
  /// z = about A⁻¹ r; only launches.
  void precondition(const float* r, float* z, cudaStream_t stream) const;

 private:
  void launch_step(CycleWork work, const float* r, float* z, cudaStream_t stream) const;

  std::vector<CudaLevel> levels_;
  DeviceArray<uint8_t> open_;
  std::vector<CycleWork> works_;
  DeviceArray<CycleWork> works_on_card_;
  SmallLevels small_ = {};
};

}  // namespace gloam::gas
