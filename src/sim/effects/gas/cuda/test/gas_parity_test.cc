// What the card makes of a gas is what the CPU makes of it, and the same bits from run to run.

#include <cstring>

#include "sim/test/gas_room.h"

namespace gloam {
namespace {

const GasGrid kGrid{47, 36, 30, 0.1f, {-1, 2, 0}};
constexpr float kStep = 0.1f;  // [s]

/// A fire, a fan, two rotors whose discs overlap over ground that gives dust, and a block that
/// moves behind a wall with a door, in wind; `sealed`: and a chamber without an opening, with a
/// block that moves in it and a fire that goes out.
GasWalls walls_at(int n, bool sealed) {
  GasWalls walls(kGrid);
  add_sheet(&walls, 26, [](int j, int k) { return j > 10 && j < 20 && k < 18; });
  const int i = 30 + n / 4;
  add_solid(&walls, {i, 5, 3}, {i + 4, 12, 9}, {0.25f, 0, 0});
  if (!sealed) return walls;
  for (int a = 0; a < 3; ++a) {
    const int low[3] = {4, 20, 6}, high[3] = {18, 32, 20};
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    for (int u = low[b]; u < high[b]; ++u) {
      for (int v = low[c]; v < high[c]; ++v) {
        for (const int side : {low[a], high[a]}) {
          int at[3];
          at[a] = side, at[b] = u, at[c] = v;
          walls.closed[a][walls.face(a, at[0], at[1], at[2])] = 1;
        }
      }
    }
  }
  add_solid(&walls, {6 + n / 8, 24, 8}, {9 + n / 8, 28, 12}, {0.125f, 0, 0});
  return walls;
}

struct Room {
  std::unique_ptr<GasSolver> gas;
  bool sealed;
  int done = 0;
  double worst_divergence = 0;

  Room(GasDevice device, bool has_chamber) : sealed(has_chamber) {
    GasProperties p;
    p.open[4] = p.open[2] = false;
    p.dissipation = 0.01f;
    gas = std::move(GasSolver::create(kGrid, p, device)).value();
  }
  void advance(int steps) {
    GasSource sources[3] = {ball({0.1f, 3.2f, 0.4f}, 0.3f), ball({1.8f, 4.5f, 1}, 0.2f),
                            ball({0.4f, 4.9f, 1}, 0.2f)};
    sources[0].fuel = 0.01f;
    sources[1].blows = true;
    sources[1].velocity = {-1, 0.5f, 0.2f};
    sources[2].smoke = 0.001f;
    sources[2].heat = 2e3f;
    GasRotor rotors[2];
    rotors[0].hub = {2.5f, 3.5f, 1.2f}, rotors[0].axis = {0, 0, 1};
    rotors[0].radius = 0.3f, rotors[0].thrust = 4;
    rotors[1] = rotors[0];
    rotors[1].hub = {2.7f, 3.6f, 1.25f}, rotors[1].axis = {0.6f, 0, 0.8f};
    rotors[1].velocity = {0.2f, 0, 0};
    std::vector<GasEmission> dust;
    for (size_t cell = 300; cell < 500; cell += 3) dust.push_back({cell, 1e-6f});
    for (int end = done + steps; done < end; ++done) {
      gas->set_walls(walls_at(done, sealed));
      const float dt = done % 5 == 4 ? 0.7f * kStep : kStep;
      const GasStep step = gas->step(dt, sources, {0.5f, 0, 0}, rotors, dust);
      worst_divergence = std::max(worst_divergence, step.divergence_after / step.divergence_before);
    }
  }
  /// Velocities, scalars, heat release and the pressure's solution, one after the other.
  std::vector<float> fields() const {
    std::vector<std::byte> bytes;
    gas->save(&bytes);
    const size_t cells = size_t(kGrid.nx + 2) * size_t(kGrid.ny + 2) * size_t(kGrid.nz + 2);
    std::vector<float> out(9 * cells);
    std::memcpy(out.data(), bytes.data() + sizeof(uint64_t) + sizeof(GasGrid),
                out.size() * sizeof(float));
    return out;
  }
  double smoke_error() const {
    const GasBudget& b = gas->budget();
    return std::abs(gas->smoke_mass() + b.smoke_escaped + b.smoke_deposited + b.smoke_buried -
                    b.smoke_added) /
           b.smoke_added;
  }
};

class GasParity : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    const auto made = GasSolver::create(kGrid, GasProperties(), GasDevice::kCuda);
    if (!made.ok()) GTEST_SKIP() << made.error().to_string();
  }
};

std::string name_of(const testing::TestParamInfo<bool>& info) {
  return info.param ? "WithASealedChamber" : "OfAnOpenRoom";
}

// The order of sums is the CPU's, and nothing is contracted: all bits are the same. Only the mean
// divergence of a sealed space is summed up in another order, in double precision.
TEST_P(GasParity, FieldsAreTheCpus) {
  Room cpu(GasDevice::kCpu, GetParam()), card(GasDevice::kCuda, GetParam());
  int steps = 0;
  for (const int more : {1, 4, 20}) {
    cpu.advance(more), card.advance(more);
    steps += more;
    const std::vector<float> a = cpu.fields(), b = card.fields();
    size_t different = 0;
    float most = 0, largest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      different += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
      most = std::max(most, std::abs(a[i] - b[i]));
      largest = std::max(largest, std::abs(a[i]));
    }
    printf("after %d steps on %s: %zu of %zu values differ, by at most %.2e of up to %.2f\n", steps,
           card.gas->device_name().c_str(), different, a.size(), double(most), double(largest));
    if (!GetParam()) {
      EXPECT_EQ(different, 0u) << "after " << steps << " steps";
    }
    // What a step's pressure may leave is 6e-5 of the divergence, which rounding is well below.
    if (steps == 1) {
      EXPECT_LE(most, 1e-5f * largest) << "after a step";
    }
  }
}

TEST_P(GasParity, FiveSecondsAreTheCpus) {
  Room cpu(GasDevice::kCpu, GetParam()), card(GasDevice::kCuda, GetParam());
  cpu.advance(53), card.advance(53);  // 5 s
  const GasBudget &a = cpu.gas->budget(), &b = card.gas->budget();
  EXPECT_NEAR(card.gas->smoke_mass(), cpu.gas->smoke_mass(), 0.01 * cpu.gas->smoke_mass()) << "kg";
  EXPECT_NEAR(card.gas->heat(), cpu.gas->heat(), 0.01 * cpu.gas->heat()) << "J";
  EXPECT_NEAR(b.fuel_burnt, a.fuel_burnt, 0.01 * a.fuel_burnt) << "kg";
  EXPECT_NEAR(b.heat_escaped, a.heat_escaped, 0.01 * a.heat_added) << "J";
  EXPECT_NEAR(b.smoke_deposited, a.smoke_deposited, 0.01 * a.smoke_deposited) << "kg";

  std::vector<float> smoke[2], kelvin[2];
  cpu.gas->read(&smoke[0], &kelvin[0]);
  card.gas->read(&smoke[1], &kelvin[1]);
  const size_t layer = size_t(kGrid.nx) * size_t(kGrid.ny);
  std::vector<double> profile[2];
  for (int n = 0; n < 2; ++n) {
    for (size_t k = 0; k < size_t(kGrid.nz); ++k) {
      double sum = 0;
      for (size_t i = 0; i < layer; ++i) sum += double(kelvin[n][k * layer + i]) - 293.0;
      profile[n].push_back(sum / double(layer));
    }
  }
  const double hottest = *std::max_element(profile[0].begin(), profile[0].end());
  for (size_t k = 0; k < profile[0].size(); ++k) {
    EXPECT_NEAR(profile[1][k], profile[0][k], 0.02 * hottest) << "K, mean of layer " << k;
  }
  EXPECT_LE(card.smoke_error(), 1e-6) << "of the smoke is out of balance";
  EXPECT_LE(card.worst_divergence, 1e-4) << "of the divergence is left";
  printf("on the card smoke is out of balance by %.1e (CPU %.1e), divergence left %.1e (%.1e)\n",
         card.smoke_error(), cpu.smoke_error(), card.worst_divergence, cpu.worst_divergence);
}

TEST_P(GasParity, RunsAreEqualBitForBit) {
  Room a(GasDevice::kCuda, GetParam()), b(GasDevice::kCuda, GetParam());
  a.advance(20), b.advance(20);
  EXPECT_EQ(a.gas->hash(), b.gas->hash());
}

TEST_P(GasParity, GoesOnFromWhatWasSavedOnEitherSide) {
  Room card(GasDevice::kCuda, GetParam());
  card.advance(9);
  std::vector<std::byte> bytes;
  card.gas->save(&bytes);
  Room again(GasDevice::kCuda, GetParam()), cpu(GasDevice::kCpu, GetParam());
  again.advance(2);
  again.done = cpu.done = card.done;
  ASSERT_TRUE(again.gas->restore(bytes).ok());
  ASSERT_TRUE(cpu.gas->restore(bytes).ok());
  EXPECT_EQ(cpu.gas->hash(), card.gas->hash());
  card.advance(5), again.advance(5);
  EXPECT_EQ(again.gas->hash(), card.gas->hash());
}

TEST_P(GasParity, WhatItIsAskedIsAnsweredAsOnTheCpu) {
  Room cpu(GasDevice::kCpu, GetParam()), card(GasDevice::kCuda, GetParam());
  std::vector<float> faces(kGrid.faces(0), 0.3f);
  cpu.gas->set_velocity(0, faces), card.gas->set_velocity(0, faces);
  EXPECT_EQ(card.gas->hash(), cpu.gas->hash());
  for (Room* room : {&cpu, &card}) room->gas->set_walls(walls_at(0, GetParam()));
  EXPECT_EQ(card.gas->hash(), cpu.gas->hash());
  cpu.advance(3), card.advance(3);
  for (const Vec3f p : {Vec3f{0, 3, 1}, Vec3f{2, 3.5f, 0.6f}, Vec3f{-2, 9, 1}}) {
    EXPECT_NEAR(length(card.gas->velocity_at(p) - cpu.gas->velocity_at(p)), 0, 1e-4) << "m/s";
  }
}

INSTANTIATE_TEST_SUITE_P(Rooms, GasParity, testing::Bool(), name_of);

}  // namespace
}  // namespace gloam
