#pragma once
// Forces of the air of gases on bodies, on the sim thread: drag by the air's velocity at the body.
//
// The law is that of the drag which acts outside of gases (body_drag.h): by the shapes of
// colliders, or in a model with a fluid of its own that of MuJoCo's, rho/2 A |v| v along each axis
// of the box of equal inertia and Stokes' drag. Each body gets the difference between the drag in
// its gas and in the fluid or wind outside, so that nothing changes where the two are the same. The
// air is that of the last tick, up to an interval old; hot air is thinner by T0/T. Left out:
// torques, and bodies to which air can give less than kLeastPush.

#include <mujoco/mujoco.h>

#include <vector>

#include "instant/medium_field.h"
#include "sim/effects/bodies/body_drag.h"
#include "sim/loop/step_schedule.h"
#include "world/world.h"

namespace gloam {

class GasForces {
 public:
  /// A thousandth of what weight does [m/s²].
  static constexpr double kLeastPush = 0.01;

  GasForces(const CompiledWorld& world, Rational timestep);

  /// Forgets the air: the next step looks at it.
  void reset() { next_look_ = 0; }
  /// Adds the forces of step `step` to data.qfrc_applied; poses and velocities in `data` are of its
  /// state. `air(row)`: the field of a gas. The air around a body is looked at 50 times a second.
  template <class Air>
  void begin_step(int64_t step, const mjModel& model, mjData& data, Air&& air) {
    if (step >= next_look_) {
      for (ExposedBody& exposed : exposed_) exposed.gas = -1;
      for (size_t row = 0; row < gases_.size(); ++row)
        look(static_cast<int>(row), model, data, air(row));
      next_look_ = looks_.step_of(looks_.first_at_or_after(step + 1));
    }
    push(model, data);
  }

 private:
  // A body that moves, and the air around it.
  struct ExposedBody {
    int body = 0;
    double half[3] = {};      // half sides of the box of equal inertia [m]
    size_t from = 0, to = 0;  // parts of it; none in a fluid of the model's own
    // Reach of the rotors of its tree around the tree's centre, 0 = it has none [m]
    double reach = 0;
    double area = 0;      // area of the largest side of the box [m²]
    int gas = -1;         // gas that pushes it; -1 = none
    double wind[3] = {};  // [m/s]
    double thinness = 1;  // T0 / T
  };
  void look(int row, const mjModel& model, const mjData& data, const MediumField& field);
  double most_push(const mjModel& model, const mjData& data, const ExposedBody& exposed) const;
  void push(const mjModel& model, mjData& data) const;
  void push_box(const mjModel& model, mjData& data, const ExposedBody& exposed) const;
  void push_part(const mjModel& model, mjData& data, const ExposedBody& exposed,
                 const DragPart& part) const;
  Fluid outside(const mjModel& model) const;

  const std::vector<GasDescription>& gases_;
  const mjModel& model_;
  const bool blows_;       // wind does, outside
  const bool is_mujocos_;  // law of MuJoCo's own fluid
  std::vector<DragPart> parts_;
  StepSchedule looks_;
  int64_t next_look_ = 0;
  std::vector<ExposedBody> exposed_;
};

}  // namespace gloam
