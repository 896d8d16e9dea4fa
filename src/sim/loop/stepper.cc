#include "sim/loop/stepper.h"

#include <algorithm>
#include <new>

#include "base/hash.h"
#include "scene/files/mujoco_guard.h"
#include "sim/commands/live_fields.h"
#include "sim/loop/divergence.h"
#include "sim/loop/motion.h"
#include "sim/loop/step_halves.h"
#include "sim/loop/step_schedule.h"
#include "sim/state/initial_state.h"
#include "sim/state/state_layout.h"
#include "sim/state/state_transfer.h"
#include "world/model_memory.h"

namespace gloam {
namespace {
constexpr int kFirstSlots = 8;

Error no_memory_for_a_model() {
  return {ErrorKind::kInput, "out of memory for a copy of the model"};
}

}  // namespace

Result<std::unique_ptr<Stepper>> Stepper::create(std::shared_ptr<const CompiledWorld> world,
                                                 uint64_t seed, std::optional<double> timestep,
                                                 const DataMaker& make_data) {
  std::unique_ptr<Stepper> stepper(new Stepper);
  stepper->world_ = world;
  stepper->seed_ = seed;
  stepper->timestep_ = timestep;
  GLOAM_TRY_STATUS(stepper->make_memory(make_data));
  mjModel* model = &stepper->model_;
  mjData* data = stepper->data_.get();
  stepper->reader_ = StateReader(*model, *data);
  stepper->inputs_ = std::make_unique<AppliedInputs>(*world, *model);
  stepper->state_.resize(static_cast<size_t>(state_size(*model)));
  stepper->next_state_.resize(stepper->state_.size());
  stepper->applied_.resize(static_cast<size_t>(model->nv));
  stepper->sensors_.resize(static_cast<size_t>(model->nsensordata));
  stepper->pool_ = SnapshotPool::create(world, kFirstSlots);
  const Rational step_time = exact_rational(model->opt.timestep);
  GLOAM_TRY(stepper->effects_, make_effects({world, seed, step_time, *model, *data}));
  for (const auto& effect : stepper->effects_) stepper->acts_on_bodies_ |= effect->acts_on_bodies();
  if (!stepper->reset()) return stepper->error();
  return stepper;
}

Stepper::~Stepper() = default;

Status Stepper::make_memory(const DataMaker& make_data) {
  data_is_given_ = static_cast<bool>(make_data);
  if (!data_is_given_) {
    take_model(*world_->model);
    data_ = gloam::make_data(model_);
    return {};
  }
  GLOAM_TRY_STATUS(own_all());
  data_ = make_data({private_, &private_->model()});
  if (data_ == nullptr) return Error{ErrorKind::kInput, "out of memory for the physics state"};
  return {};
}

PhysicsMemory Stepper::memory() const {
  if (owns_all_) {
    private_->model().opt = model_.opt;  // which live fields and the weather change
    return {{private_, &private_->model()}, data_};
  }
  return {{world_, world_->model.get()}, data_};
}

const Effect* Stepper::find_effect(std::string_view kind) const {
  for (const auto& effect : effects_)
    if (effect->kind() == kind) return effect.get();
  return nullptr;
}

EffectContext Stepper::context(int64_t step) {
  return {step, model_, *data_, hash_, events_, live_.get()};
}

// Refers to the arrays of `model`, meshes of 70 MB among them; the options are copied and changed.
void Stepper::take_model(const mjModel& model) {
  model_ = model;
  owns_all_ = false;
  model_.opt.disableflags |= mjDSBL_AUTORESET;
  if (timestep_) model_.opt.timestep = *timestep_;
  for (const auto& effect : effects_) effect->follow_model(model_);
}

// From now on model_'s arrays that may change are this simulation's own, as the World has them.
Status Stepper::own_all() {
  try {
    if (private_ == nullptr) {
      private_ = std::make_shared<PrivateModel>(world_);
    } else {
      private_->renew();
    }
  } catch (const std::bad_alloc&) {
    return no_memory_for_a_model();
  }
  take_model(private_->model());
  owns_all_ = true;
  return {};
}

// The model as the World has it: without what live fields have changed.
bool Stepper::take_back_model() {
  if (!data_is_given_) {
    take_model(*world_->model);
    return true;
  }
  const Status owned = own_all();
  return owned.ok() || fail(owned.error());
}

// Live fields are written into the arrays: not into those that all simulations of the World share.
bool Stepper::own_the_field(LiveFieldId field) {
  if (derives_constants(field)) return own_for_constants();
  const bool is_owned = live_ != nullptr && !live_->values[static_cast<size_t>(field)].empty();
  if (!owns_all_ && !is_owned)
    own_live_field(field, model_, &own_fields_[static_cast<size_t>(field)]);
  return true;
}

// MuJoCo derives values all over the model from masses and armatures.
bool Stepper::own_for_constants() {
  const bool owned_all = owns_all_;
  if (!owned_all) {
    const Status owned = own_all();
    if (!owned.ok()) return fail(owned.error());
  }
  try {
    private_->own_bounds();
  } catch (const std::bad_alloc&) {
    return fail(no_memory_for_a_model());
  }
  model_.bvh_aabb = private_->model().bvh_aabb;
  if (owned_all) return true;
  for (int f = 0; live_ != nullptr && f < kLiveFieldCount; ++f) {  // what changed before
    const std::vector<double>& values = live_->values[static_cast<size_t>(f)];
    if (values.empty()) continue;
    const Status written = write_live_field(*world_->model, static_cast<LiveFieldId>(f), values,
                                            model_, scratch_.get());
    if (!written) return fail(written.error());
  }
  return true;
}

// For a step, or a forward pass, from the state of data_.
void Stepper::set_options() {
  for (const auto& effect : effects_) effect->set_options(context(step_));
}

bool Stepper::reset() {
  failed_ = false;
  if (live_ != nullptr) {
    live_.reset();
    if (!take_back_model()) return false;
  }
  step_ = since_ = 0;
  inputs_->reset();
  const bool ok = restart();
  ++run_;
  snapshot_ = {};
  own_sensors_ = true;
  sensor_stamp_ = state_[0];
  warnings_seen_.fill(0);
  hash_ = hash_span<double>(state_, hash_bytes(&seed_, sizeof(seed_)));
  actuators_.reset(model_, *data_);
  for (const auto& effect : effects_) effect->advance(context(0));
  if (next_tick() == 0) tick_effects();
  if (!ok) return fail({ErrorKind::kInput, mujoco_error_message()});
  return true;
}

// Sensors and the warm start of the solver are computed by a forward pass. The sensors are wanted,
// but a bare mj_step loop starts cold, so the state is restored after it.
bool Stepper::restart() {
  const mjModel* model = &model_;
  mjData* data = data_.get();
  events_.loads.clear();
  events_.footfalls.clear();
  if (!effects_.empty() && !try_mujoco([&] { place_at_initial_state(*world_, *model, data); }))
    return false;
  for (const auto& effect : effects_) effect->reset(context(0));
  const auto begin = [&] {
    reset_to_initial_state(*world_, *model, *data);
    for (const auto& effect : effects_) effect->write_state(0, data);
  };
  return try_mujoco([&] {
    begin();
    set_options();
    mj_forward(model, data);
    mju_copy(sensors_.data(), data->sensordata, static_cast<int>(model->nsensordata));
    begin();
    mj_kinematics(model, data);  // so that controllers and hooks see poses before the first step
    mj_comPos(model, data);
    mj_getState(model, data, state_.data(), mjSTATE_INTEGRATION);
  });
}

int64_t Stepper::next_tick() const {
  int64_t next = Effect::kNever;
  for (const auto& effect : effects_) next = std::min(next, effect->next_tick());
  return next;
}

// Snapshots of this step on hold the fields of this instant and those that are begun here.
void Stepper::tick_effects() {
  for (const auto& effect : effects_)
    if (effect->next_tick() == step_) effect->tick(context(step_));
  snapshot_ = {};
  const Snapshot& now = snapshot();
  for (const auto& effect : effects_) effect->start(now);
}

bool Stepper::take_over(const Stepper& before, const Correspondence& same) {
  run_ = before.run_;
  step_ = since_ = before.step_;
  hash_ = before.hash_;
  live_changes_ = before.live_changes_;
  warnings_ = before.warnings_;
  most_contacts_ = before.most_contacts_;
  inputs_->take_over(*before.inputs_, same);
  if (before.live_ != nullptr) {
    for (const SetLiveField& change : remaining_live_fields(same, *before.live_)) {
      change_live(change);
      if (failed_) return false;
    }
  }
  transfer_state(same, *before.data_, *data_);
  for (const auto& effect : effects_) {
    effect->take_over(context(step_), const_cast<Effect*>(before.find_effect(effect->kind())));
    effect->write_state(step_, data_.get());
  }
  actuators_.take_over(before.actuators_, same, model_, *data_);
  mj_getState(&model_, data_.get(), state_.data(), mjSTATE_INTEGRATION);
  hash_ = hash_span<double>(state_, hash_);
  return stand_at_state() || fail({ErrorKind::kInput, mujoco_error_message()});
}

void Stepper::apply(const Command& command) {
  mjData& data = *data_;
  std::visit(
      [&](const auto& what) {
        using T = std::decay_t<decltype(what)>;
        if constexpr (std::is_same_v<T, SetLiveField>) {
          change_live(what);
        } else if constexpr (requires { inputs_->apply(model_, data, what); }) {
          inputs_->apply(model_, data, what);
        }
      },
      command.what);
}

// The one Command that allocates: a new version of the fields, and an array when one first changes.
void Stepper::change_live(const SetLiveField& change) {
  if (derives_constants(change.field) && scratch_ == nullptr) {
    mjData* scratch = nullptr;
    const mjModel* model = &model_;
    if (!try_mujoco([&] { scratch = mj_makeData(model); })) {
      fail({ErrorKind::kInput, mujoco_error_message()});
      return;
    }
    scratch_.reset(scratch);
  }
  if (!own_the_field(change.field)) return;
  live_ = change_live_field(*world_->model, live_.get(), change, ++live_changes_);
  const uint64_t digest = live_fields_digest(*live_);
  hash_ = hash_bytes(&digest, sizeof(digest), hash_);
  const Status written =
      write_live_field(*world_->model, change.field,
                       live_->values[static_cast<size_t>(change.field)], model_, scratch_.get());
  if (!written) fail(written.error());
  for (const auto& effect : effects_) effect->follow_model(model_);
}

// Forces of effects need poses, velocities and inertias of the present, which the first half of a
// step computes. Where a step has no halves they are computed for this alone.
void Stepper::step_in_halves() {
  mjModel* m = &model_;
  mjData* d = data_.get();
  EffectContext at = context(step_);
  at.is_halved = has_halves(*m);
  if (at.is_halved) {
    mj_step1(m, d);
  } else {
    mj_kinematics(m, d);
    mj_comPos(m, d);
    mj_comVel(m, d);
  }
  std::copy_n(d->qfrc_applied, m->nv, applied_.begin());  // others' forces stay as they are
  for (const auto& effect : effects_) effect->apply_forces(at);
  if (!at.is_halved) {
    mj_makeM(m, d);
    mj_factorM(m, d);
  }
  for (const auto& effect : effects_) effect->apply_loads(at);
  at.is_halved ? mj_step2(m, d) : mj_step(m, d);
  for (const auto& effect : effects_) effect->update_sensors(at);
  std::copy(applied_.begin(), applied_.end(), d->qfrc_applied);
}

bool Stepper::step() {
  if (failed_) return false;
  if (motion_ != nullptr) return step_along();
  const mjModel* model = &model_;
  mjData* data = data_.get();
  events_.loads.clear();
  events_.footfalls.clear();
  set_options();
  AppliedInputs* inputs = inputs_.get();
  bool actuated = true;
  const bool ok = try_mujoco([=, this, &actuated] {
    inputs->before_step(*model, *data);
    actuated = actuators_.apply(&model_, data);
    if (!actuated) return;
    if (acts_on_bodies_)
      step_in_halves();
    else
      mj_step(model, data);
  });
  actuators_.release(&model_, data);
  for (const auto& effect : effects_) effect->end_step(model_);
  if (ok && !actuated) return fail(actuators_.error());
  if (!ok) {
    Error error{ErrorKind::kDiverged, mujoco_error_message()};
    error.message +=
        " (in step " + std::to_string(step_) + ", from t = " + std::to_string(time()) + " s)";
    return fail(std::move(error));
  }
  count_diagnostics();
  const uint64_t good_hash = hash_;
  for (const auto& effect : effects_) effect->advance(context(step_ + 1));
  for (const auto& effect : effects_) effect->observe(context(step_ + 1));
  reader_.read(next_state_.data());
  if (!is_sound(*model, *data, next_state_)) {
    hash_ = good_hash;
    return fail(describe_divergence(*model, *data, next_state_, step_, time()));
  }
  sensor_stamp_ = state_[0];
  own_sensors_ = false;
  state_.swap(next_state_);
  ++step_;
  hash_ = actuators_.hash(hash_span<double>(state_, hash_));
  snapshot_ = {};
  if (step_ == next_tick()) tick_effects();
  return true;
}

bool Stepper::fail(Error error) {
  failed_ = true;
  error_ = std::move(error);
  restore_last_good_state();
  return false;
}

// mjData is in an unknown state: make it anew, or where it was given, clear it. If even that is
// refused the state vector and the Snapshot made from it are still good.
void Stepper::restore_last_good_state() {
  const mjModel* model = &model_;
  mjData* data = nullptr;
  if (data_is_given_) {
    data = data_.get();
    if (!try_mujoco([&] { mj_resetData(model, data); })) return;
  } else {
    if (!try_mujoco([&] { data = mj_makeData(model); }) || data == nullptr) return;
    data_ = {data, DataDeleter()};
  }
  reader_ = StateReader(*model, *data);
  std::fill(sensors_.begin(), sensors_.end(), 0.0);
  static_cast<void>(stand_at_state());
}

// Makes mjData that of state_, with the sensors of this very instant, and with poses for the
// controllers and hooks of the next step. False when MuJoCo fails.
bool Stepper::stand_at_state() {
  snapshot_ = {};
  own_sensors_ = true;
  sensor_stamp_ = state_[0];
  const mjModel* model = &model_;
  mjData* data = data_.get();
  return try_mujoco([&] {
    mj_setState(model, data, state_.data(), mjSTATE_INTEGRATION);
    set_options();
    mj_forward(model, data);
    mju_copy(sensors_.data(), data->sensordata, static_cast<int>(model->nsensordata));
    mj_setState(model, data, state_.data(), mjSTATE_INTEGRATION);
    mj_kinematics(model, data);
    mj_comPos(model, data);
  });
}

void Stepper::count_diagnostics() {
  for (int i = 0; i < mjNWARNING; ++i) {
    const int number = data_->warning[i].number;
    warnings_[static_cast<size_t>(i)] += number - warnings_seen_[static_cast<size_t>(i)];
    warnings_seen_[static_cast<size_t>(i)] = number;
  }
  most_contacts_ = std::max(most_contacts_, data_->ncon);
}

const Snapshot& Stepper::snapshot() {
  if (!snapshot_) {
    snapshot_ = pool_->make([this](SnapshotData& out) {
      out.run = run_;
      out.world_since = since_;
      out.step = step_;
      out.time = time();
      out.timestep = model_.opt.timestep;
      out.hash = hash_;
      out.live = live_;
      for (const auto& effect : effects_) effect->publish(step_, &out.effects);
      for (size_t joint = 0; joint < out.trajectories.size(); ++joint)
        out.trajectories[joint] = inputs_->joints().trajectory(joint);
      out.effects.loads.assign(events_.loads.begin(), events_.loads.end());
      actuators_.publish(&out.actuators);
      out.sensor_stamp = sensor_stamp_;
      out.warnings = warnings_seen_;
      std::copy(state_.begin(), state_.end(), out.state.begin());
      const double* sensors = own_sensors_ ? sensors_.data() : data_->sensordata;
      std::copy_n(sensors, out.sensordata.size(), out.sensordata.begin());
    });
  }
  return snapshot_;
}

}  // namespace gloam
