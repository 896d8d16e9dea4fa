#include "sim/effects/gas/gas_solver.h"

#include <fmt/format.h>

#include <cmath>

#include "base/check.h"
#include "base/memory.h"
#include "sim/effects/gas/gas_state.h"
#include "sim/effects/gas/kernel/trace.h"

namespace gloam {
namespace {

/// Smoke of which 10 km take a tenth of the light: transport leaves traces everywhere, and what is
/// empty costs renderers nothing [kg/m³].
constexpr float kMinSmokeDensity = 1e-9f;
constexpr int kLeastCells = 4, kMostCells = gas::kLongestRow;  ///< along an axis

Error bad(std::string message, std::string hint) {
  return {ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

Status check(const GasGrid& g) {
  for (const int n : {g.nx, g.ny, g.nz}) {
    if (n < kLeastCells || n > kMostCells) {
      return bad(
          fmt::format("a gas grid cannot have {} x {} x {} cells: each number must be in [{}, {}]",
                      g.nx, g.ny, g.nz, kLeastCells, kMostCells),
          "change its size or the size of its voxels");
    }
  }
  if (!(g.voxel >= 1e-3f && g.voxel <= 100.0f)) {
    return bad(fmt::format("voxels must have a size in [0.001, 100] m, got {} m", g.voxel), "");
  }
  if (!std::isfinite(g.low.x) || !std::isfinite(g.low.y) || !std::isfinite(g.low.z)) {
    return bad("the corner of a gas grid is not finite", "");
  }
  if (g.cells() > (size_t(1) << 27)) {
    return bad(
        fmt::format("a gas grid of {} cells is too large; the limit is 134217728", g.cells()),
        "use larger voxels");
  }
  return {};
}

Status check(const GasProperties& p) {
  const struct {
    const char* name;
    float value, low, high;
  } ranges[] = {
      {"ambient_temperature", p.ambient_temperature, 200, 400},
      {"vorticity", p.vorticity, 0, 10},
      {"cooling", p.cooling, 0, 1e3f},
      {"dissipation", p.dissipation, 0, 1e3f},
      {"heat_of_combustion", p.heat_of_combustion, 1e6f, 2e8f},
      {"soot_yield", p.soot_yield, 0, 1},
      {"radiated", p.radiated, 0, 1},
      {"mixing_time", p.mixing_time, 1e-3f, 1e3f},
  };
  for (const auto& r : ranges) {
    if (!(r.value >= r.low && r.value <= r.high)) {
      return bad(
          fmt::format("{} = {} of a gas must be in [{}, {}]", r.name, r.value, r.low, r.high), "");
    }
  }
  return {};
}

uint64_t bytes_of(const GasGrid& g) {
  const uint64_t cells = uint64_t(g.nx + 2) * uint64_t(g.ny + 2) * uint64_t(g.nz + 2);
  return gas::Pressure::bytes(cells) + gas::Momentum::bytes(cells) + gas::Transport::bytes(cells) +
         cells * (9 * 4 + 16 + 7 + 4 + 4 + 12);
}

}  // namespace

GasSolver::State::State(const GasGrid& g, const GasProperties& p)
    : grid(g),
      properties(p),
      shape(gas::Shape::of(g.nx, g.ny, g.nz)),
      openings(shape, p.open),
      pressure(shape),
      momentum(shape),
      transport(shape),
      walls(g) {
  const size_t n = size_t(shape.size());
  for (gas::Field& f : velocity) f.assign(n, 0.0f);
  for (gas::Field& f : scalars) f.assign(n, 0.0f);
  burning.assign(n, 0.0f);
  heated.assign(n, 0.0f);
  depth.assign(n, 0);
  row_sums.resize(size_t(g.ny) * size_t(g.nz) * 4);
  row_most.resize(size_t(g.ny) * size_t(g.nz));
  use_walls();
}

double GasSolver::State::total(gas::Scalar scalar) {
  fetch(gas::field_of(scalar));
  const float* f = scalars[scalar].data();
  double sum = 0;
  for (int k = 0; k < shape.nz; ++k) {
    for (int j = 0; j < shape.ny; ++j) {
      sum += gas::row_sum(shape.at(0, j, k), shape.nx, [f](int c) { return f[c]; });
    }
  }
  return sum;
}

GasSolver::GasSolver(std::unique_ptr<State> state) : state_(std::move(state)) {}
GasSolver::~GasSolver() = default;

Result<std::unique_ptr<GasSolver>> GasSolver::create(const GasGrid& grid,
                                                     const GasProperties& properties,
                                                     GasDevice device) {
  GLOAM_TRY_STATUS(check(grid));
  GLOAM_TRY_STATUS(check(properties));
  GLOAM_TRY_STATUS(check_memory(
      bytes_of(grid), fmt::format("a gas grid of {} x {} x {} cells", grid.nx, grid.ny, grid.nz),
      "use larger voxels or a smaller box"));
  auto state = std::make_unique<State>(grid, properties);
  if (device == GasDevice::kCuda) {
    GLOAM_TRY(state->card, gas::CudaGas::make(grid, state->openings, state->pressure.multigrid(),
                                              state->fields()));
    state->use_walls();
  }
  return std::unique_ptr<GasSolver>(new GasSolver(std::move(state)));
}

void GasSolver::set_walls(const GasWalls& walls) { state_->take_walls(walls); }

void GasSolver::set_velocity(int axis, std::span<const float> faces) {
  State& state = *state_;
  state.fetch(gas::kVelocityFields);
  GLOAM_CHECK(axis >= 0 && axis < 3 && faces.size() == state.grid.faces(axis),
              "the velocities belong to another grid");
  const gas::Shape& s = state.shape;
  for (int k = 0; k < s.nz + (axis == 2); ++k) {
    for (int j = 0; j < s.ny + (axis == 1); ++j) {
      std::copy_n(faces.data() + state.walls.face(axis, 0, j, k), s.nx + (axis == 0),
                  state.velocity[axis].data() + s.at(0, j, k));
    }
  }
  if (state.card) state.card->upload(gas::kVelocityFields);
  state.use_walls();  // closed faces move as their walls
}

void GasSolver::read(std::vector<float>* density, std::vector<float>* temperature) const {
  state_->fetch(gas::field_of(gas::kHeat) | gas::field_of(gas::kSmoke));
  const State& state = *state_;
  const gas::Shape& s = state.shape;
  density->resize(state.grid.cells());
  temperature->resize(state.grid.cells());
  const float ambient = state.properties.ambient_temperature;
  gas::for_rows(s, [&](int j, int k) {
    const size_t from = size_t(s.at(0, j, k)), to = state.walls.cell(0, j, k);
    const float* smoke = &state.scalars[gas::kSmoke][from];
    float* shown = density->data() + to;
    for (int i = 0; i < s.nx; ++i) shown[i] = smoke[i] > kMinSmokeDensity ? smoke[i] : 0.0f;
    const float* heat = &state.scalars[gas::kHeat][from];
    float* kelvin = temperature->data() + to;
    for (int i = 0; i < s.nx; ++i) kelvin[i] = ambient / (1.0f - min(heat[i], 0.9f));
  });
}

void GasSolver::read_heat_release(std::vector<float>* power) const {
  state_->fetch(gas::kBurningField);
  const State& state = *state_;
  power->resize(state.grid.cells());
  gas::for_rows(state.shape, [&](int j, int k) {
    std::copy_n(state.burning.data() + state.shape.at(0, j, k), state.shape.nx,
                power->data() + state.walls.cell(0, j, k));
  });
}

void GasSolver::read_velocity(std::vector<float>* velocity) const {
  state_->fetch(gas::kVelocityFields);
  State& state = *state_;
  const gas::Shape& s = state.shape;
  const gas::Faces<const float> u = state.faces().read();
  velocity->resize(3 * state.grid.cells());
  gas::for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k);
    float* to = velocity->data() + 3 * state.walls.cell(0, j, k);
    for (int i = 0; i < s.nx; ++i, to += 3) {
      const Vec3f v = gas::centre_twice(s, u, begin + i) * 0.5f;
      to[0] = v.x, to[1] = v.y, to[2] = v.z;
    }
  });
}

double GasSolver::smoke_mass() const { return state_->total(gas::kSmoke) * state_->cell_volume(); }
double GasSolver::fuel_mass() const { return state_->total(gas::kFuel) * state_->cell_volume(); }
double GasSolver::heat() const {
  return state_->total(gas::kHeat) * state_->cell_volume() * double(state_->heat_unit());
}
const GasBudget& GasSolver::budget() const { return state_->budget; }
const GasGrid& GasSolver::grid() const { return state_->grid; }
const GasProperties& GasSolver::properties() const { return state_->properties; }

std::string GasSolver::device_name() const {
  return state_->card ? state_->card->device_name() : "CPU";
}

Vec3f GasSolver::velocity_at(Vec3f p_W) const {
  state_->fetch(gas::kVelocityFields);
  const State& state = *state_;
  const Vec3f p = (p_W - state.grid.low) / state.grid.voxel;
  const auto along = [&](int a) {
    const gas::Between at = gas::place(state.shape, a, p.x - (a == 0 ? 0.0f : 0.5f),
                                       p.y - (a == 1 ? 0.0f : 0.5f), p.z - (a == 2 ? 0.0f : 0.5f));
    return gas::interpolate(state.shape, state.velocity[a].data(), at);
  };
  return {along(0), along(1), along(2)};
}

}  // namespace gloam
