// Rotors in still air against momentum theory: what the air of an actuator disc gains.

#include <numbers>

#include "gas_room.h"

namespace gloam {
namespace {

constexpr float kThrust = 12, kRadius = 0.4f, kDensity = 1.204f;  // [N], [m], [kg/m³]

/// Thrust upwards.
GasRotor hovering(Vec3f hub) {
  GasRotor rotor;
  rotor.hub = hub;
  rotor.axis = {0, 0, 1};
  rotor.radius = kRadius;
  rotor.thrust = kThrust;
  return rotor;
}

GasProperties plain_air() {
  GasProperties p;
  p.ambient_temperature = 293;
  p.vorticity = 0;
  return p;
}

/// Of a horizontal plane.
struct Section {
  double momentum = 0;  ///< flow of it, all over the plane [N]
  double fastest = 0;   ///< [m/s]
};

Section section(const GasSolver& gas, float z) {
  Section out;
  const GasGrid& g = gas.grid();
  const double area = double(g.voxel) * double(g.voxel);
  for (int j = 0; j < g.ny; ++j) {
    for (int i = 0; i < g.nx; ++i) {
      const Vec3f p = g.low + Vec3f{float(i) + 0.5f, float(j) + 0.5f, 0} * g.voxel;
      const double w = -double(gas.velocity_at({p.x, p.y, z}).z);
      out.momentum += double(kDensity) * w * std::abs(w) * area;
      out.fastest = std::max(out.fastest, w);
    }
  }
  return out;
}

/// In 2 s, after 1 s.
void check_hover(float radius, double at_disc, double in_wake, double of_thrust) {
  const GasGrid grid{24, 24, 34, 0.1f, {-1.2f, -1.2f, 0}};
  auto gas = make_gas(grid, plain_air());
  GasRotor rotor = hovering({0, 0, 2.5f});
  rotor.radius = radius;
  const float v = std::sqrt(kThrust / (2 * kDensity * std::numbers::pi_v<float> * radius * radius));
  const int steps = 20, settle = 10;
  double disc = 0, wake = 0, momentum = 0;
  for (int n = 0; n < steps; ++n) {
    gas->step(0.1f, {}, {}, std::span(&rotor, 1));
    if (n < settle) continue;
    const Section below = section(*gas, 1.2f);
    const double share = 1.0 / (steps - settle);
    momentum += below.momentum * share, wake += below.fastest * share;
    for (int ring = 0; ring < 4; ++ring) {  // of equal areas
      const float r = radius * std::sqrt((float(ring) + 0.5f) / 4);
      for (int turn = 0; turn < 8; ++turn) {
        const float a = float(turn) * 0.25f * std::numbers::pi_v<float>;
        const Vec3f p{r * std::cos(a), r * std::sin(a), rotor.hub.z};
        disc -= double(gas->velocity_at(p).z) * share / 32;
      }
    }
  }
  printf(
      "radius %.1f m: %.2f m/s through the disc (theory %.2f), %.2f in the wake (%.2f), which "
      "carries %.1f N (%.0f)\n",
      double(radius), disc, double(v), wake, 2 * double(v), momentum, double(kThrust));
  EXPECT_NEAR(disc, double(v), at_disc * double(v)) << "m/s through the disc";
  EXPECT_NEAR(wake, 2 * double(v), in_wake * 2 * double(v)) << "m/s in the far wake";
  EXPECT_NEAR(momentum, double(kThrust), of_thrust * double(kThrust))
      << "N: the flow of momentum in the wake is the thrust";
}

TEST(GasRotor, AHoveringDiscInducesWhatMomentumTheorySays) {
  check_hover(0.4f, 0.25, 0.15, 0.15);
  check_hover(0.2f, 0.25, 0.25, 0.15);  // two voxels: its wake is wider and slower
}

TEST(GasRotor, ADiscGivesItsThrustToAirHoweverItLies) {
  const GasGrid grid{24, 24, 24, 0.1f, {-1.2f, -1.2f, -1.2f}};
  for (const Vec3f axis : {Vec3f{0, 0, 1}, Vec3f{0, 1, 0}, Vec3f{0.6f, 0, 0.8f}}) {
    for (const float radius : {0.02f, 0.13f, 0.4f}) {
      auto gas = make_gas(grid, plain_air());
      GasRotor rotor = hovering({0.03f, 0.01f, -0.02f});
      rotor.axis = axis, rotor.radius = radius, rotor.thrust = 0.1f;
      const float dt = 0.01f;
      gas->step(dt, {}, {}, std::span(&rotor, 1));
      // What is missing of the impulse went out through the open sides at once, as pressure.
      Vec3f sum{};
      for (int k = 0; k < grid.nz; ++k) {
        for (int j = 0; j < grid.ny; ++j) {
          for (int i = 0; i < grid.nx; ++i)
            sum += gas->velocity_at(
                grid.low + Vec3f{float(i) + .5f, float(j) + .5f, float(k) + .5f} * grid.voxel);
        }
      }
      const float mass = kDensity * grid.voxel * grid.voxel * grid.voxel;
      const Vec3f momentum = sum * mass;
      const float along = -dot(momentum, axis), impulse = rotor.thrust * dt;
      printf("axis (%.1f %.1f %.1f), radius %.2f m: %.3f of the impulse\n", double(axis.x),
             double(axis.y), double(axis.z), double(radius), double(along / impulse));
      EXPECT_GT(along, 0.95f * impulse) << "of " << impulse << " N s, radius " << radius;
      EXPECT_LT(along, 1.0f * impulse) << "of " << impulse << " N s, radius " << radius;
      EXPECT_LT(length(momentum + axis * along), 0.03f * impulse) << "N s went sideways";
    }
  }
}

TEST(GasRotor, NearTheGroundItsAirFlowsOutAlongTheFloor) {
  const GasGrid grid{40, 40, 20, 0.1f, {-2, -2, 0}};
  GasProperties p = plain_air();
  p.open[4] = false;
  auto gas = make_gas(grid, p);
  const GasRotor rotor = hovering({0, 0, 0.8f});
  for (int n = 0; n < 30; ++n) gas->step(0.1f, {}, {}, std::span(&rotor, 1));
  const float v =  // through the disc, far from any ground [m/s]
      std::sqrt(kThrust / (2 * kDensity * std::numbers::pi_v<float> * kRadius * kRadius));
  for (const Vec3f out : {Vec3f{1, 0, 0}, Vec3f{-1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, -1, 0}}) {
    const float low = dot(gas->velocity_at(out * 1.0f + Vec3f{0, 0, 0.05f}), out);
    const float high = dot(gas->velocity_at(out * 1.0f + Vec3f{0, 0, 1.0f}), out);
    printf("1 m from the axis: %.2f m/s outwards at 5 cm, %.2f at 1 m (v_i %.2f)\n", double(low),
           double(high), double(v));
    EXPECT_GT(low, 0.8f * v) << "m/s outwards along the floor";
    EXPECT_LT(high, 0.3f * v) << "m/s outwards above the wall jet";
  }
}

TEST(GasRotor, PushesSmokeAside) {
  const GasGrid grid{24, 24, 24, 0.1f, {-1.2f, -1.2f, 0}};
  const auto smoke_below = [&](float thrust) {
    auto gas = make_gas(grid, plain_air());
    GasSource layer;
    layer.box = true;
    layer.X_WS.p = {0, 0, 0.3f};
    layer.half_size = {1.2f, 1.2f, 0.3f};
    layer.smoke = 0.001f;
    gas->step(0.1f, std::span(&layer, 1), {});
    GasRotor rotor = hovering({0, 0, 1.6f});
    rotor.thrust = thrust;
    for (int n = 0; n < 15; ++n) gas->step(0.1f, {}, {}, std::span(&rotor, 1));
    std::vector<float> soot, kelvin;
    gas->read(&soot, &kelvin);
    return soot[GasWalls(grid).cell(12, 12, 3)];
  };
  EXPECT_LT(smoke_below(6), 0.05f * smoke_below(0)) << "kg/m3 are left under the rotor";
}

TEST(GasRotor, OutsideOfTheBoxOrInWallsItIsHarmless) {
  const GasGrid grid{12, 12, 12, 0.1f, {}};
  auto gas = make_gas(grid, plain_air());
  GasWalls walls(grid);
  add_solid(&walls, {2, 2, 2}, {10, 10, 10});
  gas->set_walls(walls);
  GasRotor rotor = hovering({0.6f, 0.6f, 0.6f});
  EXPECT_LT(gas->step(0.1f, {}, {}, std::span(&rotor, 1)).max_speed, 20.0f) << "m/s";
  rotor.hub = {5, 5, 5};
  gas = make_gas(grid, plain_air());
  EXPECT_EQ(gas->step(0.1f, {}, {}, std::span(&rotor, 1)).max_speed, 0) << "m/s";
  rotor.hub = {0.6f, 0.6f, 0.6f}, rotor.thrust = 1e5f;
  for (int n = 0; n < 3; ++n) {
    const GasStep step = gas->step(0.02f, {}, {}, std::span(&rotor, 1));
    ASSERT_TRUE(std::isfinite(step.max_speed)) << "m/s";
  }
}

TEST(GasEmission, WhatCellsAreGivenIsInTheBudget) {
  const GasGrid grid{12, 10, 8, 0.1f, {}};
  auto gas = make_gas(grid, closed_box());
  GasWalls walls(grid);
  add_solid(&walls, {0, 0, 0}, {2, 2, 2});
  gas->set_walls(walls);
  const std::vector<GasEmission> dust = {
      {walls.cell(1, 1, 1), 1}, {walls.cell(5, 4, 0), 2e-3f}, {walls.cell(11, 9, 7), 1e-3f}};
  for (int n = 0; n < 10; ++n) gas->step(0.1f, {}, {}, {}, dust);
  EXPECT_NEAR(gas->budget().smoke_added, 3e-3, 1e-9) << "kg: what is in a wall gives nothing";
  EXPECT_NEAR(gas->smoke_mass(), 3e-3, 1e-7) << "kg";
}

}  // namespace
}  // namespace gloam
