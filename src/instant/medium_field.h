#pragma once
// A field that an effect solves for on a thread of its own: one version of it, which whoever has a
// Snapshot may hold before it is done.

#include <atomic>
#include <cstdint>
#include <memory>

#include "world/media/medium_description.h"

namespace gloam {

/// Written once, then read by any number of threads.
class MediumField {
 public:
  /// `digest`: of all that decides what the solver does next.
  void finish(VolumeGrid density, VolumeGrid temperature, VolumeGrid flame, VolumeGrid velocity,
              uint64_t digest) {
    density_ = std::move(density);
    temperature_ = std::move(temperature);
    flame_ = std::move(flame);
    velocity_ = std::move(velocity);
    digest_ = digest;
    done_.store(true, std::memory_order_release);
    done_.notify_all();
  }
  /// To be called before the others, by each thread.
  void wait() const { done_.wait(false, std::memory_order_acquire); }

  /// Density outside of flames [kg/m³]; null = clear.
  const VolumeGrid& density() const { return density_; }
  const VolumeGrid& temperature() const { return temperature_; }  ///< [K]
  /// Absorption by flames [1/m]; null = nothing burns.
  const VolumeGrid& flame() const { return flame_; }
  /// Velocities of cells' centres [m/s], world, (nz, ny, nx, 3); null = no moving thing is
  /// affected.
  const VolumeGrid& velocity() const { return velocity_; }
  uint64_t digest() const { return digest_; }

 private:
  VolumeGrid density_, temperature_, flame_, velocity_;
  uint64_t digest_ = 0;
  std::atomic<bool> done_{false};
};

/// The two versions between which an instant lies. No `before`: the effect has not begun.
struct FieldWindow {
  std::shared_ptr<const MediumField> before, after;
  float share = 0;  ///< weight of `after`, 0 <= … < 1

  /// The grids at the instant; waits for what is not yet done.
  void read(VolumeGrid* density, VolumeGrid* temperature, VolumeGrid* flame) const;
};

}  // namespace gloam
