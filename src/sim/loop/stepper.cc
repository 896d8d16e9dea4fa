#include "sim/loop/stepper.h"

#include <algorithm>

#include "base/hash.h"
#include "scene/files/mujoco_guard.h"
#include "sim/commands/live_fields.h"
#include "sim/loop/divergence.h"
#include "sim/loop/step_schedule.h"
#include "sim/state/initial_state.h"
#include "sim/state/state_layout.h"
#include "sim/state/state_transfer.h"

namespace gloam {
namespace {
constexpr int kFirstSlots = 8;

// With the poses of bodies and nothing that follows from them.
void place_at_beginning(const CompiledWorld& world, const mjModel& model, mjData* data) {
  reset_to_initial_state(world, model, *data);
  mj_kinematics(&model, data);
  mj_comPos(&model, data);
}

// Whether mj_step1 and mj_step2 are mj_step, also when inertia grows in between: no solver has made
// a matrix of it yet, and nobody sleeps whom a force has to wake.
bool has_halves(const mjModel& m) {
  return m.opt.integrator != mjINT_RK4 && m.opt.solver != mjSOL_PGS &&
         m.opt.noslip_iterations == 0 && m.nflex == 0 && (m.opt.enableflags & mjENBL_SLEEP) == 0;
}

}  // namespace

Result<std::unique_ptr<Stepper>> Stepper::create(std::shared_ptr<const CompiledWorld> world,
                                                 uint64_t seed, std::optional<double> timestep) {
  std::unique_ptr<Stepper> stepper(new Stepper);
  stepper->world_ = world;
  stepper->seed_ = seed;
  stepper->timestep_ = timestep;
  stepper->take_model(*world->model);
  const mjModel* model = &stepper->model_;
  mjData* data = nullptr;
  GLOAM_TRY_STATUS(guarded([&] { data = mj_makeData(model); }));
  stepper->data_.reset(data);
  stepper->reader_ = StateReader(*model, *data);
  stepper->inputs_ = std::make_unique<AppliedInputs>(*model);
  stepper->state_.resize(static_cast<size_t>(state_size(*model)));
  stepper->next_state_.resize(stepper->state_.size());
  stepper->applied_.resize(static_cast<size_t>(model->nv));
  stepper->sensors_.resize(static_cast<size_t>(model->nsensordata));
  stepper->pool_ = SnapshotPool::create(world, kFirstSlots);
  const Rational step_time = exact_rational(model->opt.timestep);
  GLOAM_TRY(stepper->effects_, Effects::create(world, step_time));
  if (!world->waters.empty()) stepper->water_ = WaterEffect::create(world, step_time);
  if (!world->soils.empty()) stepper->soil_ = SoilEffect::create(world, *model);
  if (world->wind.blows()) {
    stepper->wind_ = std::make_unique<WindOnBodies>(*world, step_time);
    const mjOption& own = world->model->opt;
    if (own.density == 0 && own.viscosity == 0 && has_halves(*model) && AirDrag::can_be(*model))
      stepper->drag_ = std::make_unique<AirDrag>(*model);
  }
  GLOAM_TRY_STATUS(stepper->make_agents());
  if (!stepper->reset()) return stepper->error();
  return stepper;
}

Status Stepper::make_agents() {
  if (world_->agents.empty()) return {};
  const mjModel* model = &model_;
  mjData* data = data_.get();
  GLOAM_TRY_STATUS(guarded([&] { place_at_beginning(*world_, *model, data); }));
  GLOAM_TRY(agents_,
            Agents::create(world_, seed_, exact_rational(model_.opt.timestep), model_, *data_));
  return {};
}

// Refers to the arrays of `model`, meshes of 70 MB among them; the options are copied and changed.
void Stepper::take_model(const mjModel& model) {
  model_ = model;
  owns_all_ = false;
  model_.opt.disableflags |= mjDSBL_AUTORESET;
  if (timestep_) model_.opt.timestep = *timestep_;
  if (world_->wind.blows()) give_air(&model_.opt);
  if (drag_ != nullptr) drag_->measure(model_);
}

// Live fields are written into the arrays: not into those that all simulations of the World share.
// Masses alone need all arrays, which takes tens of milliseconds where there are large meshes.
bool Stepper::own_the_field(LiveFieldId field) {
  const bool is_owned = live_ != nullptr && !live_->values[static_cast<size_t>(field)].empty();
  if (owns_all_ || is_owned) return true;
  if (field != LiveFieldId::kBodyMass) {
    own_live_field(field, model_, &own_fields_[static_cast<size_t>(field)]);
    return true;
  }
  mjModel* copy = own_model_.get();
  const bool ok = try_mujoco([&] { copy = mj_copyModel(copy, world_->model.get()); });
  if (!ok || copy == nullptr) return fail({ErrorKind::kInput, mujoco_error_message()});
  if (own_model_ == nullptr) own_model_.reset(copy);
  take_model(*copy);
  owns_all_ = true;
  for (int f = 0; live_ != nullptr && f < kLiveFieldCount; ++f) {  // what changed before
    const std::vector<float>& values = live_->values[static_cast<size_t>(f)];
    if (values.empty()) continue;
    const Status written = write_live_field(*world_->model, static_cast<LiveFieldId>(f), values,
                                            model_, scratch_.get());
    if (!written) return fail(written.error());
  }
  return true;
}

// A Command that sets the wind takes the weather's place until the next reset.
void Stepper::blow(const double* qpos) {
  const auto field = static_cast<size_t>(LiveFieldId::kWind);
  if (wind_ == nullptr || (live_ != nullptr && !live_->values[field].empty())) return;
  wind_->blow(step_, qpos, &model_.opt);
}

bool Stepper::reset() {
  failed_ = false;
  if (live_ != nullptr) {
    live_.reset();
    take_model(*world_->model);
  }
  step_ = 0;
  inputs_->reset();
  // Sensors and the warm start of the solver are computed by a forward pass. The sensors are
  // wanted, but a bare mj_step loop starts cold, so the state is made anew after it.
  const mjModel* model = &model_;
  mjData* data = data_.get();
  bool ok = true;
  if (agents_ != nullptr) {
    ok = try_mujoco([&] { place_at_beginning(*world_, *model, data); });
    agents_->reset(*model, *data);
  }
  const Agents* agents = agents_.get();
  ok = ok && try_mujoco([&] {
         reset_to_initial_state(*world_, *model, *data);
         if (agents != nullptr) agents->write(0, data);
         blow(data->qpos);
         mj_forward(model, data);
         mju_copy(sensors_.data(), data->sensordata, static_cast<int>(model->nsensordata));
         reset_to_initial_state(*world_, *model, *data);
         if (agents != nullptr) agents->write(0, data);
         mj_kinematics(model,
                       data);  // so that controllers and hooks see poses before the first step
         mj_comPos(model, data);
         mj_getState(model, data, state_.data(), mjSTATE_INTEGRATION);
       });
  ++run_;
  snapshot_ = {};
  own_sensors_ = true;
  sensor_stamp_ = state_[0];
  warnings_seen_.fill(0);
  hash_ = hash_span<double>(state_, hash_bytes(&seed_, sizeof(seed_)));
  if (water_ != nullptr) water_->reset();
  if (soil_ != nullptr) soil_->reset();
  if (agents_ != nullptr) hash_ = agents_->advance(0, *model, data, hash_);
  if (effects_ != nullptr) {
    effects_->reset();
    tick_effects();
  }
  if (!ok) return fail({ErrorKind::kInput, mujoco_error_message()});
  return true;
}

// Snapshots of this step on hold the fields of this instant and those that are begun here.
void Stepper::tick_effects() {
  hash_ = effects_->tick(step_, hash_);
  snapshot_ = {};
  effects_->start(snapshot());
}

bool Stepper::take_over(const Stepper& before, const Correspondence& same) {
  run_ = before.run_;
  step_ = before.step_;
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
  if (agents_ != nullptr) {
    agents_->take_over(step_, before.agents_.get(), model_, *data_);
    agents_->write(step_, data_.get());
  }
  mj_getState(&model_, data_.get(), state_.data(), mjSTATE_INTEGRATION);
  hash_ = hash_span<double>(state_, hash_);
  if (water_ != nullptr) water_->take_over(step_, before.water_.get());
  if (soil_ != nullptr) soil_->take_over(before.soil_.get());
  if (effects_ != nullptr) effects_->take_over(step_, before.effects_.get());
  return stand_at_state() || fail({ErrorKind::kInput, mujoco_error_message()});
}

void Stepper::apply(const Command& command) {
  mjData& data = *data_;
  std::visit(
      [&](const auto& what) {
        using T = std::decay_t<decltype(what)>;
        if constexpr (std::is_same_v<T, SetLiveField>) {
          change_live(what);
        } else if constexpr (!std::is_same_v<T, SetVelocityGoal> && !std::is_same_v<T, ResetSim>) {
          inputs_->apply(model_, data, what);
        }
      },
      command.what);
}

// The one Command that allocates: a new version of the fields, and an array when one first changes.
void Stepper::change_live(const SetLiveField& change) {
  if (change.field == LiveFieldId::kBodyMass && scratch_ == nullptr) {
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
  if (drag_ != nullptr) drag_->measure(model_);
}

// What acts on bodies needs poses, velocities and inertias of the present. They are what the first
// half of a step computes; where a step has no halves they are computed for this alone.
void Stepper::step_with_effects() {
  mjModel* m = &model_;
  mjData* d = data_.get();
  const bool halved = has_halves(*m);
  if (halved) {
    if (drag_ != nullptr) m->opt.density = m->opt.viscosity = 0;  // MuJoCo leaves drag to it
    mj_step1(m, d);
    if (drag_ != nullptr) give_air(&m->opt);
  } else {
    mj_kinematics(m, d);
    mj_comPos(m, d);
    mj_comVel(m, d);
  }
  std::copy_n(d->qfrc_applied, m->nv, applied_.begin());  // what others apply stays as it is
  if (drag_ != nullptr) drag_->push(*m, *d);
  if (effects_ != nullptr) effects_->begin_step(step_, *m, *d);
  const bool wet = water_ != nullptr && water_->begin_step(step_, *m, *d, &hash_);
  if (!halved) {  // with the water that bodies carry along
    mj_makeM(m, d);
    mj_factorM(m, d);
  } else if (wet) {
    water_->add_masses(*m, *d);
  }
  if (soil_ != nullptr) hash_ = soil_->begin_step(step_, *m, *d, hash_);
  halved ? mj_step2(m, d) : mj_step(m, d);
  if (soil_ != nullptr) soil_->feel(*m, *d);
  std::copy(applied_.begin(), applied_.end(), d->qfrc_applied);
}

bool Stepper::step() {
  if (failed_) return false;
  const mjModel* model = &model_;
  mjData* data = data_.get();
  blow(data->qpos);
  AppliedInputs* inputs = inputs_.get();
  const bool ok = try_mujoco([=, this] {
    inputs->before_step(*model, *data);
    if (effects_ == nullptr && water_ == nullptr && soil_ == nullptr && drag_ == nullptr) {
      mj_step(model, data);
    } else {
      step_with_effects();
    }
  });
  if (water_ != nullptr) water_->end_step(model_);
  if (drag_ != nullptr) give_air(&model_.opt);
  if (!ok) {
    Error error{ErrorKind::kDiverged, mujoco_error_message()};
    error.message +=
        " (in step " + std::to_string(step_) + ", from t = " + std::to_string(time()) + " s)";
    return fail(std::move(error));
  }
  count_diagnostics();
  uint64_t hash = hash_;
  if (agents_ != nullptr) hash = agents_->advance(step_ + 1, *model, data, hash);
  if (effects_ != nullptr) effects_->gather(*model, *data, soil_reactions(), agents_.get());
  reader_.read(next_state_.data());
  if (!is_sound(*model, *data, next_state_)) {
    return fail(describe_divergence(*model, *data, next_state_, step_, time()));
  }
  sensor_stamp_ = state_[0];
  own_sensors_ = false;
  state_.swap(next_state_);
  ++step_;
  hash_ = hash_span<double>(state_, hash);
  snapshot_ = {};
  if (effects_ != nullptr && step_ == effects_->next_tick()) tick_effects();
  return true;
}

bool Stepper::fail(Error error) {
  failed_ = true;
  error_ = std::move(error);
  restore_last_good_state();
  return false;
}

// mjData is in an unknown state: make it anew. If even that is refused the state vector and the
// Snapshot made from it are still good.
void Stepper::restore_last_good_state() {
  const mjModel* model = &model_;
  mjData* data = nullptr;
  if (!try_mujoco([&] { data = mj_makeData(model); }) || data == nullptr) return;
  data_.reset(data);
  reader_ = StateReader(*model, *data);
  std::fill(sensors_.begin(), sensors_.end(), 0.0);
  static_cast<void>(stand_at_state());
}

// Makes mjData that of state_, with the sensors of this very instant, and with poses for the
// controllers and hooks of the next step. False when MuJoCo refuses.
bool Stepper::stand_at_state() {
  snapshot_ = {};
  own_sensors_ = true;
  sensor_stamp_ = state_[0];
  const mjModel* model = &model_;
  mjData* data = data_.get();
  return try_mujoco([&] {
    mj_setState(model, data, state_.data(), mjSTATE_INTEGRATION);
    blow(data->qpos);
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
      out.step = step_;
      out.time = time();
      out.timestep = model_.opt.timestep;
      out.hash = hash_;
      out.live = live_;
      if (effects_ != nullptr) effects_->fill(step_, &out.fields);
      if (water_ != nullptr) water_->fill(step_, &out.heights);
      if (soil_ != nullptr) soil_->fill(&out.tracks);
      out.sensor_stamp = sensor_stamp_;
      std::copy(state_.begin(), state_.end(), out.state.begin());
      const double* sensors = own_sensors_ ? sensors_.data() : data_->sensordata;
      std::copy_n(sensors, out.sensordata.size(), out.sensordata.begin());
    });
  }
  return snapshot_;
}

}  // namespace gloam
