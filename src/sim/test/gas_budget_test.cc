// What goes in is inside or went out: smoke, heat and fuel, whatever walls and sources do.

#include "gas_room.h"

namespace gloam {
namespace {

GasSource fire(Vec3f at) {
  GasSource source = ball(at, 0.25f);
  source.fuel = 0.01f;
  source.smoke = 0.001f;
  source.heat = 5e3f;
  return source;
}

/// A block of 6 x 6 x 6 cells that goes to and fro along x.
void add_moving_block(GasWalls* walls, float time, float speed) {
  const float way = 1.0f;  // [m]
  const float phase = std::fmod(time * speed, 2 * way);
  const bool back = phase > way;
  const float x = 0.5f + (back ? 2 * way - phase : phase);
  const int i = int(x / walls->grid.voxel);
  add_solid(walls, {i, 8, 2}, {i + 6, 14, 8}, {back ? -speed : speed, 0, 0});
}

TEST(GasBudget, ClosedRoomKeepsItsSmokeForAMinuteWhileSomethingMoves) {
  const GasGrid grid{28, 22, 20, 0.1f, {}};
  GasProperties p = closed_box();
  auto gas = make_gas(grid, p);
  const GasSource source = fire({0.3f, 0.3f, 0.3f});
  double given = 0;
  for (int n = 0; n < 600; ++n) {
    GasWalls walls(grid);
    add_moving_block(&walls, float(n) * 0.1f, 0.5f);
    gas->set_walls(walls);
    gas->step(0.1f, n < 50 ? std::span(&source, 1) : std::span<const GasSource>(), {});
    if (n == 50) given = gas->smoke_mass();
  }
  const double error = gas->smoke_mass() / gas->budget().smoke_added - 1;
  printf("smoke after 60 s in a closed room: %.6f kg of %.6f kg, off by %.2g\n", gas->smoke_mass(),
         gas->budget().smoke_added, error);
  EXPECT_GT(given, 0.005) << "kg: there was smoke to lose";
  EXPECT_LT(std::abs(error), 1e-4) << "of the smoke came or went by itself";
  EXPECT_EQ(gas->budget().smoke_buried, 0) << "kg were caught in a block that leaves room around";
  EXPECT_EQ(gas->budget().smoke_escaped, 0) << "kg went through closed sides";
}

TEST(GasBudget, ClosesWithOpenSides) {
  const GasGrid grid{24, 20, 22, 0.1f, {}};
  GasProperties p;
  p.open[4] = false;
  p.dissipation = 0.01f;
  auto gas = make_gas(grid, p);
  const GasSource source = fire({1.2f, 1, 0.4f});
  for (int n = 0; n < 150; ++n) {
    GasWalls walls(grid);
    add_moving_block(&walls, float(n) * 0.1f, 0.5f);
    gas->set_walls(walls);
    gas->step(0.1f, std::span(&source, 1), {1, 0, 0});
  }
  const GasBudget& b = gas->budget();
  EXPECT_GT(b.smoke_escaped, 0.3 * b.smoke_added) << "kg: much should have left by now";
  EXPECT_NEAR(gas->smoke_mass() + b.smoke_escaped + b.smoke_deposited + b.smoke_buried,
              b.smoke_added, 1e-4 * b.smoke_added)
      << "kg of smoke";
  EXPECT_NEAR(gas->fuel_mass() + b.fuel_escaped + b.fuel_burnt + b.fuel_buried, b.fuel_added,
              1e-4 * b.fuel_added)
      << "kg of fuel";
  EXPECT_NEAR(gas->heat() + b.heat_escaped + b.heat_lost + b.heat_buried, b.heat_added,
              1e-4 * b.heat_added)
      << "J of heat";
}

TEST(GasBudget, AFireInASealedRoomGoesOutForWantOfAir) {
  const GasGrid grid{16, 16, 16, 0.1f, {}};
  auto gas = make_gas(grid, closed_box());
  GasSource source = ball({0.8f, 0.8f, 0.3f}, 0.25f);
  source.fuel = 0.02f;
  double half = 0;
  for (int n = 0; n < 600; ++n) {
    gas->step(0.1f, std::span(&source, 1), {});
    if (n == 300) half = gas->budget().fuel_burnt;
  }
  // 4.1 m³ of air, at 3.04 MJ per kg of it.
  const double most = 4.096 * 1.204 * 3.04e6 / 25e6;
  // Heat that a sealed room can not give off by flowing out thins the air that is left.
  EXPECT_GT(gas->budget().fuel_burnt, 0.2 * most) << "kg: it should use up much of the air";
  EXPECT_LT(gas->budget().fuel_burnt, most) << "kg: there is no air for more";
  EXPECT_LT(gas->budget().fuel_burnt - half, 0.05 * most) << "kg burnt in the second half";
}

TEST(GasBudget, AbsurdSourcesStayWithinBounds) {
  const GasGrid grid{12, 12, 12, 0.1f, {}};
  for (const bool open : {true, false}) {
    auto gas = make_gas(grid, open ? GasProperties() : closed_box());
    GasSource source = ball({0.65f, 0.65f, 0.65f}, 0.01f);
    source.heat = 1e9f;
    source.fuel = 1e3f;
    source.smoke = 1e3f;
    source.blows = true;
    source.velocity = {1e4f, -1e4f, 1e4f};
    std::vector<float> soot, kelvin;
    for (int n = 0; n < 3; ++n) {
      const GasStep step = gas->step(1.0f, std::span(&source, 1), {0, 0, 0});
      gas->read(&soot, &kelvin);
      ASSERT_TRUE(std::isfinite(step.max_speed)) << "m/s";
      for (size_t c = 0; c < soot.size(); ++c) {
        ASSERT_TRUE(std::isfinite(soot[c]) && soot[c] >= 0) << soot[c] << " kg/m3 of soot";
        ASSERT_TRUE(kelvin[c] >= 292.9f && kelvin[c] < 2931) << kelvin[c] << " K";
      }
    }
    EXPECT_GT(gas->budget().heat_lost, 1e8) << "J: nothing can hold all that heat";
  }
}

TEST(GasBudget, WhatAWallCoversIsPushedAsideAndWhatItFreesIsFilled) {
  const GasGrid grid{20, 8, 8, 0.1f, {}};
  auto gas = make_gas(grid, closed_box());
  GasSource source;
  source.box = true;
  source.X_WS.p = {1, 0.4f, 0.4f};
  source.half_size = {1, 0.4f, 0.4f};
  source.smoke = 0.01f;
  gas->step(0.1f, std::span(&source, 1), {});
  const double mass = gas->smoke_mass();
  GasWalls walls(grid);
  add_solid(&walls, {4, 0, 0}, {12, 8, 8});  // from wall to wall, at once
  gas->set_walls(walls);
  EXPECT_NEAR(gas->smoke_mass(), mass, 1e-6 * mass) << "kg after 8 of 20 layers were covered";
  std::vector<float> soot, kelvin;
  gas->read(&soot, &kelvin);
  EXPECT_EQ(soot[walls.cell(8, 4, 4)], 0) << "kg/m3 inside of the wall";
  EXPECT_GT(soot[walls.cell(3, 4, 4)], 4 * soot[walls.cell(1, 4, 4)]) << "it was pushed here";
  gas->set_walls(GasWalls(grid));
  EXPECT_NEAR(gas->smoke_mass(), mass, 1e-6 * mass) << "kg after the wall is gone";
  gas->read(&soot, &kelvin);
  EXPECT_GT(soot[walls.cell(4, 4, 4)], 0) << "the freed cell took from its neighbour";
  // With nowhere to go it is buried, and said to be.
  GasWalls all(grid);
  add_solid(&all, {0, 0, 0}, {20, 8, 8});
  gas->set_walls(all);
  EXPECT_EQ(gas->smoke_mass(), 0);
  EXPECT_NEAR(gas->budget().smoke_buried, mass, 1e-6 * mass);
}

}  // namespace
}  // namespace gloam
