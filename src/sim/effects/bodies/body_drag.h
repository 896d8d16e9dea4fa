#pragma once
// Drag of air on bodies where Gloam adds it: each collider by its own shape, with the coefficients
// and areas that water has for it (immersed_shape.h, after Hoerner 1965); a body that has mass and
// no collider as the box of equal inertia. The force is rho/2 Cd A |v| v along each axis, with the
// speed |v| of the whole flow; across a cylinder or capsule that of the flow across it alone (cross
// flow principle: Hoerner, chapter 3). To it comes Stokes' drag of the sphere of the same volume.

#include <mujoco/mujoco.h>

#include <vector>

namespace gloam {

/// Density [kg/m³] and dynamic viscosity [Pa s].
struct Fluid {
  double density = 0, viscosity = 0;
  bool fills_space() const { return density > 0 || viscosity > 0; }
};

/// Whether drag is left to MuJoCo's own model of a fluid: where the model has a fluid, asks for one
/// by `fluidshape`, or lets bodies sleep, which forces from outside would keep awake.
bool has_own_drag(const mjModel& model);

/// One rigid part of a body that moves, in the axes of its frame.
struct DragPart {
  int body = 0;
  int geom = -1;          ///< its frame; -1: that of the body's inertia
  double centre[3] = {};  ///< centre of the force [m]
  double face[3] = {};    ///< coefficient times area, for flow along each axis [m²]
  double spin[3] = {};    ///< torque over rho/2 |w| w [m⁵]
  double radius = 0;      ///< radius of the sphere of the same volume [m]
  bool is_round = false;  ///< about its z axis
  double mass = 0;        ///< its share of what is welded to it [kg]
  double inertia = 0;     ///< its share of the body's least moment [kg m²]

  const double* rotation(const mjData& data) const {
    return geom >= 0 ? data.geom_xmat + 9 * geom : data.ximat + 9 * body;
  }
  /// Centre of the force in the world [m].
  void place(const mjData& data, double* p) const;
  /// Drag at velocity `v` through the fluid [m/s], both in the world. In a step of `timestep` [s]
  /// it takes at most half of that velocity: what is very light would swing with more.
  void add_force(const mjData& data, const double* v, Fluid fluid, double timestep,
                 double* force) const;
  /// Likewise the torque at an angular velocity [rad/s].
  void add_torque(const mjData& data, const double* w, Fluid fluid, double timestep,
                  double* torque) const;
};

/// Parts of all bodies that joints move, by body.
std::vector<DragPart> drag_parts(const mjModel& model);
/// Takes masses anew.
void weigh_parts(const mjModel& model, std::vector<DragPart>* parts);

}  // namespace gloam
