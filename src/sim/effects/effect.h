#pragma once
// Effect: what happens in a World beside MuJoCo's physics (wind, gases, waters, soft ground,
// people). The step loop knows effects by this interface alone; effect_list.cc lists them.

#include <mujoco/mujoco.h>

#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"
#include "sim/effects/effect_outputs.h"
#include "world/world.h"

namespace gloam {

class Snapshot;
struct LiveFields;

/// Events of one step that other effects, controllers and sensors ask for. Room is reserved
/// by Effect::reset, so that a step allocates nothing.
struct StepEvents {
  std::vector<ContactLoad> loads;
  std::vector<Footfall> footfalls;
};

/// A simulation as an effect finds it.
struct EffectContext {
  int64_t step;  ///< step that is being made, or at which the simulation stands
  mjModel& model;
  mjData& data;
  uint64_t& hash;      ///< hash of the simulation's state; effects add what decides their future
  StepEvents& events;  ///< events of the step that is being made, then of the last one
  const LiveFields* live;  ///< null = no field has been changed
  bool is_halved = false;  ///< mj_step1 is done and mj_step2 to come: inertia is known already
};

/// All calls come on the simulation's thread. Those of a step must not allocate, lock or throw.
class Effect {
 public:
  static constexpr int64_t kNever = std::numeric_limits<int64_t>::max();

  virtual ~Effect() = default;
  /// The same for all effects of one class: "water". A recompile hands over by it.
  virtual std::string_view kind() const = 0;

  /// The simulation begins: `data` has the poses of the initial state.
  virtual void reset(const EffectContext& at) = 0;
  /// In the middle of a run, after a recompile: goes on from `before`, the World before's effect of
  /// this kind, null = it had none. Instead of reset().
  virtual void take_over(const EffectContext& at, Effect* before) = 0;
  /// Whether it writes the poses of bodies itself: a replayed motion has them already.
  virtual bool moves_bodies() const { return false; }
  /// Options and masses of the model have been set anew.
  virtual void follow_model(mjModel&) {}
  /// Writes what of the state of `data` is the effect's own (mocap poses), as of at.step.
  virtual void write_state(int64_t, mjData*) const {}

  // One step, in this order.

  /// True if steps must be taken in halves, for the forces of this effect.
  virtual bool acts_on_bodies() const { return false; }
  /// Sets options of the model for a step from this state. Also before forward passes.
  virtual void set_options(const EffectContext&) {}
  /// Poses and velocities are known: adds forces to data.qfrc_applied, inertia to the model.
  virtual void apply_forces(const EffectContext&) {}
  /// Inertia is known, too: adds forces that depend on it, and loads to the events.
  virtual void apply_loads(const EffectContext&) {}
  /// The second half is done: adds to MuJoCo's sensors.
  virtual void update_sensors(const EffectContext&) {}
  /// After it, whether it went well or not: gives back what was changed in the model.
  virtual void end_step(mjModel&) {}
  /// The simulation stands at at.step; `data` has poses and contacts of the step before. Also after
  /// reset(), at step 0.
  virtual void advance(const EffectContext&) {}
  /// After the advance() of all effects: reads contacts and events.
  virtual void observe(const EffectContext&) {}

  // Ticks: solving on threads of the effect's own, at a rate of its own.

  /// Step of the next tick.
  virtual int64_t next_tick() const { return kNever; }
  /// The simulation stands at at.step == next_tick(): waits for what was to be done by now.
  virtual void tick(const EffectContext&) {}
  /// After the tick() of all effects: begins to solve, from this instant.
  virtual void start(const Snapshot&) {}

  /// Fills the effect's rows of what Snapshots of `step` hold.
  virtual void publish(int64_t, EffectOutputs*) {}
};

/// Parts that effects are made of. `data` has no state yet.
struct EffectParts {
  std::shared_ptr<const CompiledWorld> world;
  uint64_t seed;
  Rational timestep;
  mjModel& model;
  mjData& data;
};

using EffectList = std::vector<std::unique_ptr<Effect>>;

/// Makes one effect; null where the World has none of it.
using EffectMaker = Result<std::unique_ptr<Effect>> (*)(const EffectParts&);

/// effect_list.cc: the effects of a World, in the order in which they act.
Result<EffectList> make_effects(const EffectParts& parts);

}  // namespace gloam
