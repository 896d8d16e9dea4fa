#pragma once
// Contacts of people: springs of the body's regions, as ISO/TS 15066:2016, annex A, has them for
// collaborating robots, in place of MuJoCo's constraint, whose stiffness grows with the mass of
// what touches.

#include <mujoco/mujoco.h>

#include <vector>

#include "world/world.h"

namespace gloam {

/// Spring of a region of the body.
struct BodySpring {
  double stiffness = 0;  ///< [N/m]; 0 = no person's
  double depth = 0;      ///< indentation from which it is much stiffer: bones [m]
};

/// Effective spring constants of ISO/TS 15066:2016, table A.3 [N/m].
inline constexpr double kSkullStiffness = 150e3, kChestStiffness = 25e3, kThighStiffness = 50e3,
                        kShankStiffness = 60e3;

class BodyContacts {
 public:
  BodyContacts(const CompiledWorld& world, const mjModel& model);
  /// True if there are people.
  bool any() const { return any_; }
  /// After the first half of a step: makes the normal force of contacts with people that of their
  /// springs, implicit in time as far as light things need it. A body presses harder on the way in
  /// than on the way out: of the energy 40 % comes back. Friction is viscous within its cone.
  void soften(const mjModel& model, mjData* data) const;

 private:
  struct Side {
    int geom = -1, other_body = -1;  ///< the person's geom; -1 = none
  };
  Side side_of(const mjModel& model, const mjContact& contact) const;
  void soften(const mjModel& model, const mjContact& contact, const BodySpring& spring,
              mjData* data) const;

  std::vector<BodySpring> springs_;  ///< by geom
  bool any_ = false;
};

}  // namespace gloam
