#pragma once
// Forces of water on moving bodies: buoyancy, drag, and the mass of the water that moves along.
//
// Each collider is many small elements of volume (immersed_shape.h); those below the surface
// displace.
//   buoyancy and waves  rho V (a - g): the pressure of still water and of the waves (Froude and
//                       Krylov), with the water's acceleration a
//   drag                of each element by its own velocity, rho/2 Cd A |v| v by axis, as of air
//                       (body_drag.h), and Stokes'
//   added mass          rho V Ca (a - x''), as armature of the joints that move the collider, with
//                       which MuJoCo solves; a body that enters takes it up with its momentum kept
//                       (von Karman 1929)
// After Morison et al. 1950 and Newman 1977, "Marine Hydrodynamics". Bodies do not shelter each
// other, and colliders that overlap displace twice.

#include <mujoco/mujoco.h>

#include <span>
#include <vector>

#include "instant/surface_heights.h"
#include "sim/effects/bodies/immersed_shape.h"
#include "sim/effects/water/water_surface.h"
#include "world/effects/water_description.h"

namespace gloam {

class WaterForces {
 public:
  WaterForces(const mjModel& model, const std::vector<WaterDescription>& waters,
              const std::vector<ImmersedShape>& shapes);

  /// Adds forces to data.qfrc_applied and gives `model` added masses, for one step. Poses,
  /// subtree centres of mass and body velocities in `data` are of the present state. `ripples`: of
  /// each water. False: nothing is in a water.
  bool begin(mjModel& model, mjData& data, std::span<const HeightChange> ripples);
  /// Instead of having MuJoCo make all inertias of `model` anew: adds those masses to data.M and
  /// factors what has changed.
  void add_masses(const mjModel& model, mjData& data) const;
  /// Takes back the added masses. Does nothing without a begin().
  void end(mjModel& model);

  /// Does the box around a collider reach into a water?
  bool is_near(size_t water, const ImmersedShape& shape, const mjData& data) const;

 private:
  struct Wet;
  void carry_nothing(mjModel& model);
  void push(const mjModel& model, mjData& data, const ImmersedShape& shape,
            const WaterDescription& water, const HeightChange& ripples);
  static bool sum_elements(const SurfacePatch& surface, Wet* wet);
  static void sum_whole(Wet* wet);
  void carry(const mjModel& model, mjData& data, const Wet& wet);

  const std::vector<WaterDescription>& waters_;
  const std::vector<ImmersedShape>& shapes_;
  std::vector<double> crests_;              // greatest height of each water's waves above rest [m]
  std::vector<double> armature_, inertia_;  // the model's dof_armature and dof_M0, for a step (nv)
  mjtNum *model_armature_ = nullptr, *model_inertia_ = nullptr;  // null: no step has begun
};

}  // namespace gloam
