// Walls: the divergence that pressure leaves behind, and where smoke gets through.

#include "gas_room.h"

namespace gloam {
namespace {

constexpr double kBar = 1e-4;  // of the divergence's error may stay

double ratio(const GasStep& step) { return step.divergence_after / step.divergence_before; }

TEST(GasWalls, PressureLeavesLittleDivergenceFromRest) {
  const GasGrid grid{40, 36, 32, 0.1f, {}};
  GasProperties p;
  p.open[4] = false;
  auto gas = make_gas(grid, p);
  GasSource source = ball({2, 1.8f, 0.5f}, 0.3f);
  source.heat = 100e3f;
  for (int n = 0; n < 20; ++n) {
    const GasStep step = gas->step(0.1f, std::span(&source, 1), {});
    ASSERT_GT(step.divergence_before, 0);
    EXPECT_LE(ratio(step), kBar) << "in step " << n << " after " << step.pressure_iterations
                                 << " iterations";
  }
}

/// Two rooms with a wall of one face between them, a fire in one, a block that moves in the other.
void check_rooms(const GasProperties& properties, bool door, const char* what) {
  const GasGrid grid{41, 24, 25, 0.1f, {}};
  auto gas = make_gas(grid, properties);
  GasSource source = ball({0.9f, 1.2f, 0.5f}, 0.25f);
  source.heat = 80e3f;
  source.smoke = 0.001f;
  double worst = 0;
  int iterations = 0, substeps = 0;
  for (int n = 0; n < 60; ++n) {
    GasWalls walls(grid);
    add_sheet(&walls, 19, [door](int j, int k) { return door && j >= 8 && j < 17 && k < 20; });
    const int i = 24 + n / 6;
    add_solid(&walls, {i, 6, 0}, {i + 5, 12, 9}, {1.0f / 6, 0, 0});
    gas->set_walls(walls);
    const GasStep step = gas->step(0.1f, std::span(&source, 1), {});
    worst = std::max(worst, ratio(step));
    iterations += step.pressure_iterations;
    substeps += step.substeps;
  }
  printf("%s: worst divergence ratio %.2e, %.1f iterations\n", what, worst,
         double(iterations) / substeps);
  EXPECT_LE(worst, kBar) << "of the divergence is left: " << what;
}

TEST(GasWalls, PressureLeavesLittleDivergenceThroughADoorAndAroundWhatMoves) {
  GasProperties p;
  p.open[4] = false;
  check_rooms(p, true, "open box with a door");
  check_rooms(closed_box(), true, "closed box with a door");
}

TEST(GasWalls, PressureLeavesLittleDivergenceInSealedRooms) {
  check_rooms(closed_box(), false, "two sealed rooms, of which one has a moving block");
}

TEST(GasWalls, ClosedFacesMoveAsTheirWalls) {
  const GasGrid grid{16, 12, 12, 0.1f, {}};
  auto gas = make_gas(grid, GasProperties());
  GasWalls walls(grid);
  add_solid(&walls, {5, 4, 4}, {8, 8, 8}, {0.7f, 0, 0});
  gas->set_walls(walls);
  gas->step(0.1f, {}, {});
  EXPECT_FLOAT_EQ(gas->velocity_at({0.8f, 0.65f, 0.65f}).x, 0.7f) << "m/s at the wall's front";
  EXPECT_GT(gas->velocity_at({0.9f, 0.65f, 0.65f}).x, 0.2f) << "m/s: air goes ahead of it";
  EXPECT_LT(gas->velocity_at({0.65f, 0.95f, 0.65f}).x, 0.0f) << "m/s: and back around it";
}

/// Smoke in the room beyond a wall of one face after 10 s.
double smoke_beyond(const std::function<bool(int j, int k)>& hole, GasSolver** out = nullptr) {
  static std::unique_ptr<GasSolver> gas;
  const GasGrid grid{40, 20, 24, 0.1f, {}};
  gas = make_gas(grid, closed_box());
  GasWalls walls(grid);
  add_sheet(&walls, 19, hole);
  gas->set_walls(walls);
  GasSource source = ball({0.9f, 1, 0.5f}, 0.25f);
  source.heat = 50e3f;
  source.smoke = 0.001f;
  for (int n = 0; n < 100; ++n) gas->step(0.1f, std::span(&source, 1), {});
  std::vector<float> soot, kelvin;
  gas->read(&soot, &kelvin);
  double mass = 0;
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 19; i < grid.nx; ++i) mass += double(soot[walls.cell(i, j, k)]) * 1e-3;
    }
  }
  if (out) *out = gas.get();
  return mass;
}

TEST(GasWalls, SmokeStaysBehindAWallOfOneFaceAndLeavesByTheUpperPartOfADoor) {
  EXPECT_EQ(smoke_beyond([](int, int) { return false; }), 0) << "kg went through a closed wall";
  GasSolver* gas = nullptr;
  const auto door = [](int j, int k) { return j >= 6 && j < 14 && k < 20; };
  EXPECT_GT(smoke_beyond(door, &gas), 1e-3) << "kg of 10 g: a door lets smoke through";
  float above = 0, below = 0;  // mean over the door's width
  for (int j = 6; j < 14; ++j) {
    above += gas->velocity_at({1.9f, (float(j) + 0.5f) * 0.1f, 1.75f}).x / 8;
    below += gas->velocity_at({1.9f, (float(j) + 0.5f) * 0.1f, 0.25f}).x / 8;
  }
  EXPECT_GT(above, 0.1f) << "m/s: hot gas leaves above";
  EXPECT_LT(below, -0.05f) << "m/s: cold air comes in below";
}

TEST(GasWalls, WindCrossesTheBox) {
  const GasGrid grid{24, 12, 12, 0.25f, {}};
  auto gas = make_gas(grid, GasProperties());
  for (int n = 0; n < 200; ++n) gas->step(0.1f, {}, {2, -1, 0});
  const Vec3f v = gas->velocity_at({3, 1.5f, 1.5f});
  EXPECT_NEAR(v.x, 2, 0.2) << "m/s in the middle after 20 s";
  EXPECT_NEAR(v.y, -1, 0.2) << "m/s in the middle after 20 s";
  for (int n = 0; n < 400; ++n) gas->step(0.1f, {}, {});
  EXPECT_LT(length(gas->velocity_at({3, 1.5f, 1.5f})), 0.5f) << "m/s 40 s after the wind";
}

}  // namespace
}  // namespace gloam
