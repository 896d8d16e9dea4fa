// One step of the gas: sources, burning, velocity, pressure, transport.

#include <cmath>

#include "base/check.h"
#include "sim/effects/gas/gas_state.h"
#include "sim/effects/gas/sources.h"
#include "sim/effects/gas/stirring.h"

namespace gloam {
namespace {

constexpr float kLongestSubstep = 0.1f;  ///< buoyancy is explicit: well below its period [s]
constexpr float kVoxelsPerSubstep = 3;   ///< distance that air may move
constexpr int kMostSubsteps = 1000;

/// Amounts that a source gives in a substep: of kHeat, kSmoke, kFuel, times cells.
struct Given {
  float heat, smoke, fuel;
};

/// Velocity at which a source drives air [m/s].
Vec3f driven_at(const GasSource& source) {
  const float fast = length(source.velocity);
  return source.velocity * (fast > gas::kFastestSource ? gas::kFastestSource / fast : 1);
}

float fraction_in(float rate, float dt) { return 1.0f - std::exp(-rate * dt); }

}  // namespace

float GasSolver::State::max_speed() {
  if (card) return card->max_speed();
  const gas::Faces<const float> u = faces().read();
  gas::for_rows(shape, [&](int j, int k) {
    const int begin = shape.at(0, j, k), end = begin + shape.nx;
    float lanes[16] = {};
    const auto at = [&](int c) { return gas::speed_squared(shape, u, c); };
    int c = begin;
    for (; c + 16 <= end; c += 16) {
      for (int l = 0; l < 16; ++l) lanes[l] = max(lanes[l], at(c + l));
    }
    for (; c < end; ++c) lanes[0] = max(lanes[0], at(c));
    row_most[size_t(k * shape.ny + j)] = *std::max_element(lanes, lanes + 16);
  });
  return std::sqrt(*std::max_element(row_most.begin(), row_most.end()));
}

GasStep GasSolver::step(float dt, std::span<const GasSource> sources, Vec3f wind,
                        std::span<const GasRotor> rotors, std::span<const GasEmission> emissions) {
  State& state = *state_;
  GLOAM_CHECK(dt > 0 && std::isfinite(dt), "the time step must be positive and finite");
  float speed = std::max(state.max_speed(), length(wind));
  for (const GasSource& source : sources) {
    if (source.blows)
      speed = std::max(speed, std::min(length(source.velocity), gas::kFastestSource));
  }
  for (const GasRotor& rotor : rotors) {
    const float far = gas::far_wake_speed(rotor, state.grid.voxel, state.ambient_density());
    speed = std::max(speed, std::min(far, gas::kFastestSource));
  }
  GasStep step;
  const float by_time = std::ceil(dt / kLongestSubstep - 1e-3f);
  const float by_speed = std::ceil(dt * speed / (kVoxelsPerSubstep * state.grid.voxel));
  step.substeps = int(std::clamp(std::max(by_time, by_speed), 1.0f, float(kMostSubsteps)));
  for (int n = 0; n < step.substeps; ++n) {
    const float part = dt / float(step.substeps);
    state.find_additions(part, (float(n) + 0.5f) * part, rotors, emissions);
    if (state.card) {
      state.substep_on_card(part, sources, wind, &step);
    } else {
      state.substep(part, sources, wind, &step);
    }
  }
  step.max_speed = state.max_speed();
  // Cells were counted in each substep.
  step.source_cells_blocked /= step.substeps;
  step.sources_blocked /= step.substeps;
  return step;
}

void GasSolver::State::substep(float dt, std::span<const GasSource> sources, Vec3f wind,
                               GasStep* step) {
  const gas::Faces<const float> open = pressure.open();
  std::fill(heated.begin(), heated.end(), 0.0f);
  feed(dt, sources, step, [&](const GasSource&, const Given& all, int c, float share) {
    heated[size_t(c)] += all.heat * share;
    scalars[gas::kSmoke][size_t(c)] += all.smoke * share;
    scalars[gas::kFuel][size_t(c)] += all.fuel * share;
  });
  add(3, 3 + gas::kScalars);
  burn(dt);
  if (last_dt > 0 && last_dt != dt) {  // pressure times dt is what the solution holds
    for (float& x : pressure.solution()) x *= dt / last_dt;
  }
  last_dt = dt;
  const auto lift_half = [&] {
    momentum.lift(open, faces(), scalars[gas::kHeat].data(), scalars[gas::kSmoke].data(),
                  ambient_density(), 0.5f * dt, uint32_t(parity));
  };
  momentum.trace(openings, open, faces().read(), grid.voxel, dt);
  pressure.push(faces(), momentum.smoothness());
  lift_half();
  momentum.carry(openings, open, velocity, grid.voxel, dt, wind);
  lift_half();
  if (properties.vorticity > 0) momentum.confine(open, faces(), properties.vorticity, dt);
  blow(sources);
  add(0, 3);
  const gas::Projection projection =
      pressure.project(openings, faces(), heated.data(), grid.voxel, dt);
  double escaped[gas::kScalars] = {};
  const int transport_substeps =
      transport.carry(open, faces().read(), scalars, grid.voxel, dt, &parity, escaped);
  account_motion(projection, transport_substeps, escaped, step);
}

void GasSolver::State::substep_on_card(float dt, std::span<const GasSource> sources, Vec3f wind,
                                       GasStep* step) {
  gifts.clear();
  gift_cells.clear();
  const GasSource* last = nullptr;
  feed(dt, sources, step, [&](const GasSource& source, const Given& all, int c, float share) {
    if (&source != last) {
      gifts.push_back({0, all.heat * share, all.smoke * share, all.fuel * share, source.blows,
                       driven_at(source)});
      last = &source;
    }
    ++gifts.back().cells;
    gift_cells.push_back(c);
  });
  const float rescale = last_dt > 0 ? dt / last_dt : 1.0f;
  last_dt = dt;
  const gas::CudaGas::Outcome out =
      card->substep({dt, rescale, wind, ambient_density(), properties.vorticity, rates(dt),
                     properties.heat_of_combustion / dt},
                    gifts, gift_cells, additions, &parity);
  stale = gas::kAllFields;
  account_reaction(out.reaction);
  account_motion(out.projection, out.transport_substeps, out.escaped, step);
}

void GasSolver::State::account_motion(const gas::Projection& projection, int transport_substeps,
                                      const double (&escaped)[gas::kScalars], GasStep* step) {
  step->pressure_iterations += projection.iterations;
  step->transport_substeps += transport_substeps;
  const auto ratio = [](double after, double before) { return before > 0 ? after / before : 0; };
  if (ratio(projection.after, projection.before) >=
      ratio(step->divergence_after, step->divergence_before)) {
    step->divergence_before = projection.before;
    step->divergence_after = projection.after;
  }
  budget.heat_escaped += escaped[gas::kHeat] * cell_volume() * double(heat_unit());
  budget.smoke_escaped += escaped[gas::kSmoke] * cell_volume();
  budget.fuel_escaped += escaped[gas::kFuel] * cell_volume();
}

/// Calls give(source, what it gives in all, cell, the cell's fraction).
template <class F>
void GasSolver::State::feed(float dt, std::span<const GasSource> sources, GasStep* step, F&& give) {
  const double volume = cell_volume();
  for (const GasSource& source : sources) {
    const double time = double(dt);
    const Given all{float(double(source.heat) * time / (volume * double(heat_unit()))),
                    float(double(source.smoke) * time / volume),
                    float(double(source.fuel) * time / volume)};
    const bool given = gas::for_cells_of(source, grid, openings, &step->source_cells_blocked,
                                         [&](int c, float share) { give(source, all, c, share); });
    if (!given) {
      ++step->sources_blocked;
      continue;
    }
    budget.heat_added += double(source.heat) * time;
    budget.smoke_added += double(source.smoke) * time;
    budget.fuel_added += double(source.fuel) * time;
  }
}

gas::ReactionRates GasSolver::State::rates(float dt) const {
  const GasProperties& p = properties;
  gas::ReactionRates r;
  r.density = ambient_density();
  r.heat_unit = heat_unit();
  r.hottest = 1.0f - p.ambient_temperature / gas::kHottest;
  r.burn = fraction_in(1.0f / p.mixing_time, dt);
  r.heat_per_fuel = p.heat_of_combustion * (1.0f - p.radiated) / r.heat_unit;
  r.air_per_fuel = p.heat_of_combustion / gas::kHeatPerAir;
  r.soot_yield = p.soot_yield;
  r.cool = fraction_in(p.cooling, dt);
  r.settle = fraction_in(p.dissipation, dt);
  return r;
}

void GasSolver::State::burn(float dt) {
  const gas::ReactionRates r = rates(dt);
  const float power = properties.heat_of_combustion / dt;
  gas::for_rows(shape, [&](int j, int k) {
    const int begin = shape.at(0, j, k);
    double* sums = &row_sums[size_t(k * shape.ny + j) * 4];
    float lanes[4][16] = {};
    float *heat = &scalars[gas::kHeat][size_t(begin)],
          *smoke = &scalars[gas::kSmoke][size_t(begin)],
          *fuel = &scalars[gas::kFuel][size_t(begin)],
          *spent = &scalars[gas::kSpent][size_t(begin)], *more = &heated[size_t(begin)],
          *watts = &burning[size_t(begin)];
    for (int i = 0; i < shape.nx; i += 16) {
      const int width = std::min(16, shape.nx - i);
      GLOAM_IVDEP
      for (int l = 0; l < width; ++l) {
        const gas::Reaction out =
            gas::react(r, heat + i + l, smoke + i + l, fuel + i + l, spent + i + l, more + i + l);
        watts[i + l] = out.burnt * power;
        lanes[0][l] += out.heat_made, lanes[1][l] += out.heat_lost;
        lanes[2][l] += out.burnt, lanes[3][l] += out.settled;
      }
    }
    for (int n = 0; n < 4; ++n) {
      sums[n] = 0;
      for (const float lane : lanes[n]) sums[n] += double(lane);
    }
  });
  double sums[4] = {};
  for (size_t i = 0; i < row_sums.size(); ++i) sums[i % 4] += row_sums[i];
  account_reaction(sums);
}

/// Sums over cells of heat made, heat lost, fuel burnt and smoke settled.
void GasSolver::State::account_reaction(const double (&sums)[4]) {
  const double volume = cell_volume();
  budget.heat_added += sums[0] * volume * double(heat_unit());
  budget.heat_lost += sums[1] * volume * double(heat_unit());
  budget.fuel_burnt += sums[2] * volume;
  budget.smoke_added += sums[2] * volume * double(properties.soot_yield);
  budget.smoke_deposited += sums[3] * volume;
}

void GasSolver::State::blow(std::span<const GasSource> sources) {
  const gas::Faces<const float> open = pressure.open();
  for (const GasSource& source : sources) {
    if (!source.blows) continue;
    const Vec3f v = driven_at(source);
    int blocked = 0;
    gas::for_cells_of(source, grid, openings, &blocked, [&](int c, float) {
      for (int a = 0; a < 3; ++a) {
        for (const int face : {c, c + shape.stride(a)}) {
          if (open[a][face] > 0.0f) velocity[a][size_t(face)] = v[a];
        }
      }
    });
  }
}

}  // namespace gloam
