#pragma once
// Drag of the wind on all bodies of a model at once (body_drag.h), summed up along the trees to
// joints: a Jacobian for each body would take five times as long.

#include <mujoco/mujoco.h>

#include <vector>

#include "sim/effects/bodies/body_drag.h"

namespace gloam {

class AirDrag {
 public:
  explicit AirDrag(const mjModel& model);
  /// Takes masses anew once they have changed.
  void measure(const mjModel& model) { weigh_parts(model, &parts_); }
  /// Adds the forces of air that moves at model.opt.wind to data.qfrc_applied; poses and velocities
  /// in `data` are of the present.
  void push(const mjModel& model, mjData& data);

 private:
  // A body that joints move: parts of it, up to `parts`, and those of bodies before it.
  struct Body {
    int id = 0, parent = 0;  // row of the parent; -1: joints do not move it
    size_t parts = 0;
  };
  std::vector<DragPart> parts_;
  std::vector<Body> bodies_;
  std::vector<int> row_of_dof_;
  std::vector<double> wrenches_;  // torque, then force, about the tree's centre of mass
};

}  // namespace gloam
