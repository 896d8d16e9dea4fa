// Steps per second of the gas solver: a fire in a furnished room with a doorway, through which
// something as large as a robot walks.
//   gas_rate [--steps N] [--threads N] [--device cpu|cuda] [--json]
// Walls: made by the CPU whatever the device.

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "bench/command_line.h"
#include "sim/effects/gas/gas_solver.h"

namespace gloam {
namespace {

struct Box {
  float low[3], high[3];  // [m]
};

/// Cells whose centres lie in the box become solid, with velocity vx along x.
void add(GasWalls* walls, const Box& b, float vx = 0) {
  const GasGrid& g = walls->grid;
  const auto inside = [&](int i, int a) {
    const float p = (float(i) + 0.5f) * g.voxel;
    return p > b.low[a] && p < b.high[a];
  };
  for (int k = 0; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        if (!inside(i, 0) || !inside(j, 1) || !inside(k, 2)) continue;
        walls->solid[walls->cell(i, j, k)] = 1;
        for (int side = 0; side < 2; ++side) {
          walls->closed[0][walls->face(0, i + side, j, k)] = 1;
          walls->velocity[0][walls->face(0, i + side, j, k)] = vx;
          walls->closed[1][walls->face(1, i, j + side, k)] = 1;
          walls->closed[2][walls->face(2, i, j, k + side)] = 1;
        }
      }
    }
  }
}

/// A room of 6 m x 9 m x 2.6 m inside of the box of 9.6 m x 9.6 m x 6.4 m, and what stands in it.
GasWalls house(const GasGrid& grid) {
  GasWalls walls(grid);
  const Box boxes[] = {
      {{0.3f, 0.3f, 0}, {6.3f, 0.5f, 2.8f}},
      {{0.3f, 9.1f, 0}, {6.3f, 9.3f, 2.8f}},
      {{0.3f, 0.3f, 0}, {0.5f, 9.3f, 2.8f}},
      {{0.3f, 0.3f, 2.6f}, {6.3f, 9.3f, 2.8f}},
      {{6.1f, 0.3f, 0}, {6.3f, 4.3f, 2.8f}},
      {{6.1f, 5.3f, 0}, {6.3f, 9.3f, 2.8f}},
      {{6.1f, 4.3f, 2.1f}, {6.3f, 5.3f, 2.8f}},
      {{1, 1, 0}, {3, 1.9f, 0.5f}},
      {{1, 1, 0.5f}, {3, 1.2f, 0.9f}},
      {{4, 6, 0.7f}, {5.2f, 7.6f, 0.8f}},
      {{4, 6, 0}, {4.1f, 6.1f, 0.7f}},
      {{5.1f, 7.5f, 0}, {5.2f, 7.6f, 0.7f}},
      {{0.5f, 4, 0}, {1, 5.5f, 2}},
      {{3, 8.5f, 0}, {5, 9.1f, 1.8f}},
      {{7.5f, 2, 0}, {8.5f, 3, 1}},
  };
  for (const Box& b : boxes) add(&walls, b);
  return walls;
}

Status run(int steps, int threads, GasDevice device, bool json) {
  set_thread_count(threads);
  const GasGrid grid{96, 96, 64, 0.1f, {0, 0, 0}};
  GasProperties properties;
  properties.open[4] = false;  // the floor
  GLOAM_TRY(auto solver, GasSolver::create(grid, properties, device));
  GasSource fire;
  fire.X_WS.p = {2, 1.5f, 0.6f};
  fire.box = true;
  fire.half_size = {0.5f, 0.3f, 0.1f};
  fire.fuel = 0.02f;  // 0.5 MW
  const GasWalls still = house(grid);
  const float dt = 0.1f, speed = 0.5f;
  double walls_s = 0, steps_s = 0, worst = 0;
  int iterations = 0, substeps = 0, transport = 0;
  const auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  for (int n = device == GasDevice::kCuda ? -2 : 0; n < steps; ++n) {
    if (n == 0) {  // a card's first steps load its kernels
      GLOAM_TRY(solver, GasSolver::create(grid, properties, device));
      walls_s = steps_s = worst = 0;
      iterations = substeps = transport = 0;
    }
    const float x = 8.0f - std::fmod(float(std::max(n, 0)) * dt * speed, 6.0f);
    GasWalls walls = still;
    add(&walls, {{x, 4.6f, 0.2f}, {x + 0.6f, 5, 0.6f}}, -speed);
    const double t0 = now();
    solver->set_walls(walls);
    const double t1 = now();
    const GasStep step = solver->step(dt, std::span(&fire, 1), {});
    walls_s += t1 - t0;
    steps_s += now() - t1;
    iterations += step.pressure_iterations;
    substeps += step.substeps;
    transport += step.transport_substeps;
    worst = std::max(worst, step.divergence_after / step.divergence_before);
  }
  const double rate = steps / (walls_s + steps_s);
  const double inside = solver->smoke_mass() + solver->budget().smoke_escaped;
  const std::string text =
      json ? "{{\"name\": \"gas_rate\", \"steps_per_s\": {:.2f}, \"threads\": {}, \"device\": "
             "\"{}\", "
             "\"walls_ms\": "
             "{:.2f}, \"step_ms\": {:.2f}, \"iterations_per_substep\": {:.2f}, "
             "\"substeps_per_step\": "
             "{:.2f}, \"transport_substeps_per_step\": {:.2f}, \"worst_divergence_ratio\": {:.2e}, "
             "\"smoke_error\": {:.2e}}}\n"
           : "{:.2f} steps/s on {} threads and {}: walls {:.2f} ms, step {:.2f} ms; {:.2f} "
             "iterations per "
             "substep, {:.2f} substeps, {:.2f} of transport; worst divergence ratio {:.2e}, smoke "
             "out of balance by {:.2e}\n";
  fmt::print(fmt::runtime(text), rate, threads, solver->device_name(), 1e3 * walls_s / steps,
             1e3 * steps_s / steps, double(iterations) / substeps, double(substeps) / steps,
             double(transport) / steps, worst, std::abs(inside / solver->budget().smoke_added - 1));
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::CommandLine line(argc, argv);
  int steps = 100, threads = 2;
  std::string device = "cpu";
  const bool json = line.flag("--json");
  line.value("--steps", &steps);
  line.value("--threads", &threads);
  line.value("--device", &device);
  const auto on = device == "cuda" ? gloam::GasDevice::kCuda : gloam::GasDevice::kCpu;
  return gloam::exit_code(gloam::run(steps, threads, on, json));
}
