#pragma once
// What happens to the air of a World, solved for on threads of its own at rates of its own.
//
// At its tick k, at the step of t_k, an effect hands out the field of t_k, reads the poses of t_k
// and begins to solve for the field of t_{k+1}: Snapshots in between hold both, and whoever looks
// at one waits for the second if it is not there yet. The simulation itself waits at t_{k+1} alone.

#include <memory>
#include <span>
#include <vector>

#include "sim/effects/gas/gas_forces.h"
#include "sim/effects/soil/soil_reaction.h"
#include "sim/loop/step_schedule.h"
#include "sim/snapshots/snapshot.h"

namespace gloam {

class Agents;
class GasEffect;

class Effects {
 public:
  /// Null where the World has none. Errors: of memory, MuJoCo's, rates above the step rate.
  static Result<std::unique_ptr<Effects>> create(std::shared_ptr<const CompiledWorld> world,
                                                 Rational timestep);
  ~Effects();

  /// Back to the beginning: the air is clear and at rest.
  void reset();
  /// At a step in the middle of a run: goes on with the air that gases of the same name and grid
  /// had in `before`, null = none; the others begin.
  void take_over(int64_t step, Effects* before);

  /// Step of the earliest tick to come.
  int64_t next_tick() const;
  /// The simulation stands at `step` = next_tick(). Waits for the fields of this instant; the hash
  /// of the simulation's state goes in and comes out with theirs.
  uint64_t tick(int64_t step, uint64_t hash);
  /// After each tick(): solves for the next fields, with the poses of this instant.
  void start(const Snapshot& now);

  /// Adds what the air does to bodies in step `step` to data.qfrc_applied.
  void begin_step(int64_t step, const mjModel& model, mjData& data);
  /// Before tick() of the step it has led to, while `data` has its contacts. `soil`: of that step.
  /// `agents`: null = none.
  void gather(const mjModel& model, const mjData& data, std::span<const SoilReaction> soil,
              const Agents* agents);

  void fill(int64_t step, std::vector<FieldWindow>* fields) const;

 private:
  Effects(const CompiledWorld& world, Rational timestep);
  std::vector<std::unique_ptr<GasEffect>> gases_;
  std::vector<GasEffect*> ticked_;  // not yet started
  GasForces forces_;
};

}  // namespace gloam
