#include "sim/effects/gas/gas_effect.h"

#include <algorithm>

#include "base/check.h"
#include "base/log.h"
#include "geometry/mesh/single.h"
#include "world/media/flame.h"

namespace gloam {
namespace {

GasGrid grid_of(const GasDescription& gas) { return {gas.nx, gas.ny, gas.nz, gas.voxel, gas.low}; }

GasProperties properties_of(const GasDescription& gas) {
  GasProperties properties;
  properties.ambient_temperature = gas.temperature;
  properties.vorticity = gas.vorticity;
  properties.cooling = gas.cooling;
  properties.dissipation = gas.settling;
  properties.heat_of_combustion = gas.fuel.heat_of_combustion;
  properties.soot_yield = gas.fuel.soot_yield;
  properties.radiated = gas.fuel.radiated;
  std::copy(std::begin(gas.open), std::end(gas.open), properties.open);
  return properties;
}

}  // namespace

Result<std::unique_ptr<GasEffect>> GasEffect::create(std::shared_ptr<const CompiledWorld> world,
                                                     size_t row, Rational timestep) {
  const GasDescription& gas = world->gases.gases[row];
  const auto placed = [&](Error error) {
    if (error.loc.line == 0) error.loc = gas.loc;
    return error;
  };
  Result<StepSchedule> schedule = StepSchedule::make(gas.rate, {0, 1}, timestep);
  if (!schedule.ok()) return placed(schedule.error());
  std::unique_ptr<GasEffect> effect(
      new GasEffect(std::move(world), row, *schedule, timestep.value()));
  const Status made = effect->make_solver();
  if (!made.ok()) return placed(made.error());
  Result<std::unique_ptr<GasObstacles>> obstacles =
      GasObstacles::create(effect->world_, grid_of(gas));
  if (!obstacles.ok()) return placed(obstacles.error());
  effect->obstacles_ = std::move(*obstacles);
  const GasesDescription& all = effect->world_->gases;
  if (!all.rotors.empty()) {
    GLOAM_TRY(effect->rotor_thrust_, RotorThrust::create(effect->world_));
  }
  if (!all.dusts.empty() && gas.medium.name == "dust") {
    effect->ground_dust_ = std::make_unique<GroundDust>(all.dusts, grid_of(gas));
    // Contacts lie a little below the ground.
    effect->contact_dust_ = std::make_unique<ContactDust>(
        *effect->world_, gas.low - Vec3f{0, 0, gas.voxel}, gas.low + gas.size());
  }
  effect->make_clear();
  effect->thread_ = std::thread([raw = effect.get()] { raw->run_thread(); });
  return effect;
}

GasEffect::GasEffect(std::shared_ptr<const CompiledWorld> world, size_t row, StepSchedule schedule,
                     double timestep)
    : world_(std::move(world)),
      row_(row),
      schedule_(schedule),
      timestep_(timestep),
      wind_(world_->wind) {}

GasEffect::~GasEffect() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wanted_.notify_one();
  if (thread_.joinable()) thread_.join();
}

Status GasEffect::make_solver() {
  GLOAM_TRY(solver_, GasSolver::create(grid_of(gas()), properties_of(gas())));
  return {};
}

/// The field of a solver that has not yet begun.
void GasEffect::make_clear() {
  const auto clear = std::make_shared<MediumField>();
  read_field(clear.get());
  now_ = coming_ = clear;
}

void GasEffect::reset() {
  coming_->wait();
  // There was memory for one before.
  const Status made = make_solver();
  GLOAM_CHECK(made.ok(), "cannot recreate the gas solver");
  walls_ = {};
  make_clear();
  tick_ = -1;
  if (contact_dust_ != nullptr) contact_dust_->reset();
}

void GasEffect::begin_at(int64_t step) {
  reset();
  tick_ = schedule_.first_at_or_after(step + 1) - 1;
}

bool GasEffect::continues(const GasEffect& before) const {
  const GasGrid a = grid_of(gas()), b = grid_of(before.gas());
  return gas().name == before.gas().name && schedule_ == before.schedule_ && a.nx == b.nx &&
         a.ny == b.ny && a.nz == b.nz && a.voxel == b.voxel && (a.low == b.low);
}

void GasEffect::take_over(GasEffect& before) {
  before.coming_->wait();
  coming_->wait();
  std::vector<std::byte> state;
  before.solver_->save(&state);
  const Status restored = solver_->restore(state);
  GLOAM_CHECK(restored.ok(), "cannot restore the state of a solver with the same grid");
  walls_ = {};
  tick_ = before.tick_;
  now_ = before.now_;
  coming_ = before.coming_;
}

uint64_t GasEffect::tick() {
  coming_->wait();
  now_ = coming_;
  ++tick_;
  return now_->digest();
}

void GasEffect::start(const Snapshot& now) {
  auto result = std::make_shared<MediumField>();
  coming_ = result;
  std::vector<DustDeposit> deposits;
  if (contact_dust_ != nullptr) deposits = contact_dust_->take();
  {
    const std::lock_guard lock(mutex_);
    work_ = now;
    deposits_ = std::move(deposits);
    result_ = std::move(result);
  }
  wanted_.notify_one();
}

FieldWindow GasEffect::window(int64_t step) const {
  if (tick_ < 0) return {now_, coming_, 0};
  const int64_t from = schedule_.step_of(tick_), to = schedule_.step_of(tick_ + 1);
  return {now_, coming_, static_cast<float>(step - from) / static_cast<float>(to - from)};
}

void GasEffect::observe(const mjModel& model, const mjData& data, const StepEvents& events) {
  if (contact_dust_ != nullptr) contact_dust_->gather(model, data, events);
}

// ---- its own thread ----

void GasEffect::run_thread() {
  while (true) {
    Snapshot now;
    std::vector<DustDeposit> deposits;
    std::shared_ptr<MediumField> result;
    {
      std::unique_lock lock(mutex_);
      wanted_.wait(lock, [this] { return quit_ || work_; });
      if (!work_) return;  // running work is finished first: Snapshots may outlive the simulation
      now = std::move(work_);
      work_ = {};
      deposits.swap(deposits_);
      result = std::move(result_);
    }
    solve(now, deposits);
    now = {};
    read_field(result.get());
  }
}

/// Finishes it with what the solver stands at.
void GasEffect::read_field(MediumField* to) const {
  std::vector<float> density, temperature, velocity;
  solver_->read(&density, &temperature);
  const auto shared = [](std::vector<float>&& values) {
    return std::make_shared<const std::vector<float>>(std::move(values));
  };
  VolumeGrid flame, moves;
  if (gas().flame_absorption > 0) {
    std::vector<float> power;
    solver_->read_heat_release(&power);
    for (size_t c = 0; c < power.size(); ++c) {
      // Smoke within flames is left out: the radiated fraction of the heat has passed it.
      density[c] *= 1 - min(power[c] * (1 / kFlameHeatRelease), 1.0f);
      power[c] *= gas().flame_absorption;
    }
    flame = shared(std::move(power));
  }
  if (world_->model->nv > 0 || has_probe(*world_, "gas_velocity")) {
    solver_->read_velocity(&velocity);
    moves = shared(std::move(velocity));
  }
  to->finish(shared(std::move(density)), shared(std::move(temperature)), std::move(flame),
             std::move(moves), solver_->hash());
}

void GasEffect::solve(const Snapshot& now, std::span<const DustDeposit> deposits) {
  const bool first = walls_.solid.empty();
  // MuJoCo took this state when it stepped to it; where it does not now, walls stay as they were.
  if (obstacles_->solve(now, &walls_).ok() && (first || obstacles_->changed()))
    solver_->set_walls(walls_);
  const int64_t steps = schedule_.step_of(tick_ + 1) - schedule_.step_of(tick_);
  const double interval = static_cast<double>(steps) * timestep_;
  find_sources(now.time(), now.time() + interval);
  if (rotor_thrust_ != nullptr && !rotor_thrust_->solve(now, &rotors_).ok()) rotors_.clear();
  std::span<const GasEmission> dust;
  if (ground_dust_ != nullptr)
    dust = ground_dust_->find(*solver_, obstacles_->still(), walls_, !gas().open[4], deposits,
                              interval);
  const GasStep step =
      solver_->step(static_cast<float>(interval), sources_, wind(now.time()), rotors_, dust);
  warn_of_blocked(step);
}

/// Sources give in each interval what is theirs in it, from whichever instant they are on.
void GasEffect::find_sources(double from, double to) {
  sources_.clear();
  for (const GasSourceDescription& in : world_->gases.sources) {
    const float share = in.share_on(from, to);
    if (!(share > 0)) continue;
    GasSource out;
    const Affine3f X_WB = obstacles_->X_WB(in.body);
    out.X_WS = X_WB * in.X_BS;
    out.box = true;
    out.half_size = in.half_size;
    out.fuel = in.mean_power(from, to) / gas().fuel.heat_of_combustion;
    out.smoke = in.smoke * share;
    out.heat = in.heat * share;
    out.blows = in.jet.has_value();
    if (in.jet) out.velocity = transform_vector(X_WB, *in.jet);
    sources_.push_back(out);
  }
}

/// Wind of the air around: the gas's own, else the weather's at the height of its middle.
Vec3f GasEffect::wind(double time) const {
  if (gas().wind) return *gas().wind;
  const Vec3 v = wind_.at(time, double{gas().low.z} + 0.5 * double{gas().size().z});
  return to_vec3f(v);
}

void GasEffect::warn_of_blocked(const GasStep& step) {
  if (step.sources_blocked == 0 || warned_ || world_->gases.gases.size() > 1) return;
  warned_ = true;
  log_warning(
      "gas '{}': {} of its fires and smokes are inside a solid or outside of the gas and emit "
      "nothing",
      gas().name, step.sources_blocked);
}

}  // namespace gloam
