#pragma once
// One simulation without its thread: private options and mjData, the step, the hash of every step,
// live fields and what Commands left behind. Used by one thread at a time.

#include <array>
#include <optional>
#include <span>

#include "gloam/command.h"
#include "gloam/physics_memory.h"
#include "sim/commands/applied_inputs.h"
#include "sim/effects/effect.h"
#include "sim/loop/actuator_layer.h"
#include "sim/snapshots/snapshot_pool.h"
#include "sim/state/private_model.h"
#include "sim/state/state_layout.h"
#include "world/world.h"

namespace gloam {

struct StepperState;
class Motion;

class Stepper {
 public:
  ~Stepper();

  /// Stands at the initial state. The chain of hashes starts from `seed`.
  static Result<std::unique_ptr<Stepper>> create(std::shared_ptr<const CompiledWorld> world,
                                                 uint64_t seed, std::optional<double> timestep,
                                                 const DataMaker& make_data = {});

  /// Back to the initial state, live fields included. False and error() when MuJoCo refuses.
  bool reset();

  /// Models of the actuators of a robot, from the present instant on. Error: as begin() says.
  Status add_actuators(int robot, std::unique_ptr<ActuatorLayer> layer) {
    snapshot_ = {};
    return actuators_.add(robot, std::move(layer), model_, *data_);
  }

  /// Goes on at the step where `before`, of another World, stands, with the state of what remains.
  /// To be called once, before the first step. False and error() when MuJoCo refuses; `before` is
  /// as it was.
  bool take_over(const Stepper& before, const Correspondence& same);

  /// A copy of the instant; null where an effect has a state of its own, or MuJoCo refuses.
  std::unique_ptr<StepperState> save() const;
  /// Stands where a Stepper of the same World was saved. False and error() when MuJoCo refuses.
  bool restore(const StepperState& saved);
  /// From now on, before the first step, `motion` tells where bodies are: neither physics nor
  /// Commands. False and error() when it has no beginning.
  bool follow(std::unique_ptr<Motion> motion);
  bool follows() const { return motion_ != nullptr; }
  /// Stands where the motion is at `step`, in a new run; at step 0 where there are effects, which
  /// are solved from the beginning on. False and error() as follow().
  bool jump(int64_t step);
  /// Number of the run in Snapshots.
  void set_run(int64_t run);

  /// Applies one checked Command now. Velocity goals, controllers, trajectories and resets are the
  /// loop's.
  void apply(const Command& command);

  /// One physics step, bit-equal to mj_step on the same state. False when it failed: then it stands
  /// at the last good state and error() says why; only reset() goes on from there.
  bool step();

  bool failed() const { return failed_; }
  const Error& error() const { return error_; }
  /// Ends the run with this error, at its last good state. Returns false.
  bool fail(Error error);

  /// The present instant; made once, however often it is asked for. Allocates only when readers
  /// hold the whole pool.
  const Snapshot& snapshot();

  int64_t step_count() const { return step_; }
  double time() const { return state_[0]; }
  uint64_t hash() const { return hash_; }
  uint64_t seed() const { return seed_; }
  /// Readings of MuJoCo's sensors that the present snapshot has.
  std::span<const double> sensordata() const {
    return {own_sensors_ ? sensors_.data() : data_->sensordata, sensors_.size()};
  }
  const mjModel& model() const { return model_; }
  mjData& data() { return *data_; }
  PhysicsMemory memory() const;
  const CompiledWorld& world() const { return *world_; }
  const std::shared_ptr<const CompiledWorld>& shared_world() const { return world_; }
  SnapshotPool& pool() { return *pool_; }
  /// MuJoCo's warnings since creation, by mjtWarning.
  const std::array<int64_t, mjNWARNING>& warnings() const { return warnings_; }
  /// Most contacts seen in a step since creation.
  int most_contacts() const { return most_contacts_; }
  /// Of the last step: loads and footfalls that MuJoCo's contacts have not.
  const StepEvents& events() const { return events_; }
  /// Targets and trajectories of joints.
  JointInputs& joints() { return inputs_->joints(); }
  /// The effect of a kind, null where the World has none.
  const Effect* find_effect(std::string_view kind) const;

 private:
  Stepper() = default;
  void restore_last_good_state();
  bool stand_at_state();
  void change_live(const SetLiveField& change);
  bool stand_where_moved();
  bool begin_where_moved();
  bool step_along();
  bool set_live(const std::shared_ptr<const LiveFields>& live);
  bool own_the_field(LiveFieldId field);
  void take_model(const mjModel& model);
  Status own_all();
  bool own_for_constants();
  bool take_back_model();
  Status make_memory(const DataMaker& make_data);
  void count_diagnostics();
  EffectContext context(int64_t step);
  bool restart();
  void set_options();
  void step_in_halves();
  void tick_effects();
  int64_t next_tick() const;

  std::shared_ptr<const CompiledWorld> world_;
  std::optional<double> timestep_;
  uint64_t seed_ = 0;
  mjModel model_;  // options of its own; its arrays are the World's until a live field changes
  std::array<std::vector<std::byte>, kLiveFieldCount> own_fields_;  // of model_, where changed
  std::shared_ptr<PrivateModel> private_;  // model_'s arrays are its while owns_all_
  bool owns_all_ = false;                  // masses have changed, or data_ was given
  std::shared_ptr<mjData> data_;
  bool data_is_given_ = false;  // by a DataMaker: it is never exchanged
  StateReader reader_;          // of data_
  DataPtr scratch_;             // for mj_setConst; made on first use
  std::unique_ptr<AppliedInputs> inputs_;
  EffectList effects_;
  ActuatorLayers actuators_;
  std::unique_ptr<Motion> motion_;  // null = physics
  bool acts_on_bodies_ = false;     // one of them does
  StepEvents events_;
  std::shared_ptr<const LiveFields> live_;
  uint64_t live_changes_ = 0;  // since creation
  std::shared_ptr<SnapshotPool> pool_;

  int64_t since_ = 0;  // step from which the run is in this World
  int64_t run_ = -1;   // resets since the one that create() makes
  int64_t step_ = 0;
  uint64_t hash_ = 0;
  std::vector<double> state_;       // of the last good step
  std::vector<double> next_state_;  // being checked
  std::vector<double> applied_;     // copy of qfrc_applied (nv)
  std::vector<double> sensors_;     // where mjData's are not those of a step: at start and failure
  bool own_sensors_ = false;
  double sensor_stamp_ = 0;  // [s]
  Snapshot snapshot_;        // of this step, once made
  bool failed_ = false;
  Error error_;
  std::array<int64_t, mjNWARNING> warnings_{};
  std::array<int, mjNWARNING> warnings_seen_{};
  int most_contacts_ = 0;
};

}  // namespace gloam
