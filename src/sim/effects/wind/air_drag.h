#pragma once
// The drag of MuJoCo's own model of a fluid on boxes of equal inertia, for all bodies of a model at
// once: a force of rho/2 A |v| v + 3 pi mu D v and a torque likewise on each, summed up along the
// trees to joints. MuJoCo makes a Jacobian for each body, which takes five times as long.

#include <mujoco/mujoco.h>

#include <vector>

namespace gloam {

class AirDrag {
 public:
  /// True if it can take MuJoCo's place in a step whose forces are explicit: nothing in the model
  /// is an ellipsoid to the fluid, and no integrator wants derivatives.
  static bool can_be(const mjModel& model);

  /// Takes the bodies' masses and inertias, and the option's fluid.
  explicit AirDrag(const mjModel& model) { measure(model); }
  /// The same once they have changed.
  void measure(const mjModel& model);
  /// Adds the forces of model.opt.wind to data.qfrc_applied; velocities in `data` are of the
  /// present.
  void push(const mjModel& model, mjData& data);

 private:
  // A body that joints move. In the axes of its inertia:
  struct Body {
    int id = 0, parent = 0;             // rows of wrenches_; the parent's -1: joints do not move it
    double drag[3] = {}, spin[3] = {};  // over |v| v [kg/m] and |w| w [kg m²]
    double viscous = 0, viscous_spin = 0;  // over v [kg/s] and w [kg m²/s]
  };
  std::vector<Body> bodies_;
  std::vector<int> row_of_dof_;
  std::vector<double> wrenches_;  // torque, then force, about the tree's centre of mass
};

}  // namespace gloam
