#pragma once
// Ripples: waves on a grid that bodies make where they enter, leave and cross a water's surface.
//
// h'' = c² (h_xx + h_yy) + b'' - losses, with the height h and the column b of what bodies
// displace: the linear equation of shallow water with bodies in it (continuity of h - b; Lamb 1932,
// article 189), with the speed c of waves 1 m long. What lies deep displaces less of the surface,
// by exp(-k depth) of those waves. They are reflected at the sides of the box.

#include <memory>
#include <vector>

#include "instant/surface_heights.h"
#include "sim/effects/bodies/immersed_shape.h"
#include "world/effects/water_description.h"

namespace gloam {

class WaterRipples {
 public:
  /// `interval`: the longest between two ticks [s].
  WaterRipples(const WaterDescription& water, double interval);

  void reset();
  /// Goes on with the waves of another of the same grid.
  void take_over(const WaterRipples& before);

  /// Adds the displacement of a body at this tick: call for each, then advance(). `p`, `R` = X_WG,
  /// `surface` = height at rest there, in the world [m].
  void displace(const ImmersedShape& shape, const double* p, const double* R, double surface);
  /// To the next tick, `interval` later [s].
  void advance(double interval);

  /// Digest of all state that decides the future; 0 where the water is calm.
  uint64_t digest() const;
  /// Heights for Snapshots and forces; null where the water is calm. The object stays as it is when
  /// advance() makes a new one.
  const std::shared_ptr<const SurfaceHeights>& field() const { return shown_; }
  /// Energy that the wave equation keeps: half the integral of h_t² + c² |grad h|² [m⁴/s²].
  double energy() const;

 private:
  void substep(float dt);
  bool settle();
  void publish();

  const WaterDescription& water_;
  const WaterGrid grid_;
  const int substeps_;
  bool calm_ = true, displaced_ = false;
  std::vector<float> height_, rate_;    // [m], [m/s]
  std::vector<float> column_, before_;  // displaced, of this tick and of the last [m]
  std::vector<float> next_;             // scratch
  std::vector<float> tent_;             // scratch, along x
  std::vector<std::shared_ptr<SurfaceHeights>> pool_;
  std::shared_ptr<const SurfaceHeights> shown_;
};

}  // namespace gloam
