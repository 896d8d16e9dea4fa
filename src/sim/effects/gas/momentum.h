#pragma once
// Velocity between two projections: carried by itself, then driven by heat and wind.

#include "sim/effects/gas/openings.h"

namespace gloam::gas {

class Momentum {
 public:
  static uint64_t bytes(uint64_t cells) { return cells * (12 * 4); }

  explicit Momentum(const Shape& shape);

  /// Finds the ways that air takes in `dt`.
  void trace(const Openings& openings, const Faces<const float>& open,
             const Faces<const float>& velocity, float voxel, float dt);
  /// Smoothness of cells and ghosts: 1 where flow changes little over a voxel, 0 where the grid
  /// does not resolve it; there, pressure that is carried along would feed eddies.
  const Field& smoothness() const { return smooth_; }
  /// Carries `velocity` along them; closed faces stay as they are. `wind` [m/s]: of the air
  /// outside.
  void carry(const Openings& openings, const Faces<const float>& open, Field (&velocity)[3],
             float voxel, float dt, Vec3f wind);
  /// heat, smoke: of cells, ghosts 0. Where flow is not smooth, heat fluctuates, by `count`.
  void lift(const Faces<const float>& open, const Faces<float>& velocity, const float* heat,
            const float* smoke, float ambient_density, float dt, uint32_t count);
  /// Vorticity confinement where flow is not smooth: what the grid resolves keeps its eddies
  /// itself.
  void confine(const Faces<const float>& open, const Faces<float>& velocity, float strength,
               float dt);

 private:
  /// Times `scale`, each component at most `limit`.
  void find_centres(const Faces<const float>& velocity, float scale, float limit);
  void find_smoothness();
  void find_paths(const Openings& openings, const Faces<const float>& open);
  void carry_axis(const Openings& openings, int axis, const float* open, Field* velocity,
                  Vec3f wind, float drift);

  Shape shape_;
  Field centre_[3];  ///< velocities of cells' centres [voxels per step]
  Field moved_[3];   ///< displacement of their air in the step [voxels]
  Field smooth_;
  Field trusted_;  ///< 0 where something was in the way: no correction there
  Field carried_, least_, most_, corrected_;
};

}  // namespace gloam::gas
