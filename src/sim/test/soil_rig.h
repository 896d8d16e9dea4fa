#pragma once
// Beds of soil with something on them, for tests.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "sim/effects/soil/soil_effect.h"
#include "test_world.h"

namespace gloam {

inline SoilOptions bed_of(const std::string& kind, double edge = 1, double depth = 0.5) {
  SoilOptions o;
  o.name = "bed";
  o.kind = kind;
  o.size = {edge, edge};
  o.depth = depth;
  return o;
}

inline std::shared_ptr<CompiledWorld> world_with_soil(const std::string& bodies,
                                                      const SoilOptions& o,
                                                      const std::string& rest = {}) {
  auto world = world_from_mjcf(fmt::format(
      R"(<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>{}</worldbody>{}</mujoco>)",
      bodies, rest));
  Scene scene;
  scene.soils = {o};
  auto soils = describe_soils(scene, *world->model);
  EXPECT_TRUE(soils.ok()) << soils.error().to_string();
  world->soils = *soils;
  return world;
}

/// Bekker's law by hand.
struct Law {
  SoilStrength s;
  explicit Law(const std::string& kind) : s(soil_strength(kind)) {}
  double modulus(double b) const { return s.k_c / b + s.k_phi; }
  double pressure(double z, double b) const { return modulus(b) * std::pow(z, s.n); }
  double sinkage(double p, double b) const { return std::pow(p / modulus(b), 1 / s.n); }
};

struct OnSoil {
  std::unique_ptr<Simulator> sim;
  explicit OnSoil(std::shared_ptr<CompiledWorld> world)
      : sim(make_simulator(std::move(world), lockstep())) {
    sim->start();
  }
  void steps(int64_t count) { ASSERT_TRUE(sim->step(count).ok()); }
  void run(double seconds) { steps(std::lround(seconds / 0.002)); }
  double q(int joint, size_t i = 0) { return sim->latest()[Joint{joint}].qpos[i]; }
  double v(int joint, size_t i = 0) { return sim->latest()[Joint{joint}].qvel[i]; }
  /// Of the surface against rest, in the cell at (x, y) of a bed in the world's middle [m].
  double track(double x, double y) {
    const Snapshot now = sim->latest();
    const auto& field = now.data().effects.surfaces.at(0).field;
    if (field == nullptr) return 0;
    const SoilDescription& soil = now.data().world->soils[0];
    const auto i = static_cast<size_t>((x - soil.low_x()) / soil.dx);
    const auto j = static_cast<size_t>((y - soil.low_y()) / soil.dy);
    const size_t cell = j * static_cast<size_t>(soil.nx) + i;
    const double fallen = soil.share_of(cell) * soil.growth * now.time();
    return double{track_height(field->height[cell], static_cast<float>(fallen))};
  }
};

}  // namespace gloam
