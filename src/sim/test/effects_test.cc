// Air that is solved for beside physics: in time with it, in its hash, in its Snapshots.

#include <numeric>

#include "same_hash.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

const char* const kRoom = R"(<mujoco>
  <option timestep="0.005"/>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <geom type="box" size="0.05 0.6 0.3" pos="0.5 0 0.3"/>
    <body name="burner" pos="0 0 1">
      <freejoint/>
      <geom type="box" size="0.1 0.1 0.05"/>
    </body>
  </worldbody>
</mujoco>)";

struct Air {
  float power = 20e3f;  // of a fire at the origin [W]
  std::string name = "air";
  Rational rate = {20, 1};
};

std::shared_ptr<CompiledWorld> world_with(const Air& air) {
  std::shared_ptr<CompiledWorld> world = world_from_mjcf(kRoom);
  GasDescription gas;
  gas.name = air.name;
  gas.low = {-1, -1, 0};
  gas.nx = gas.ny = gas.nz = 20;
  gas.voxel = 0.1f;
  gas.rate = air.rate;
  gas.fuel = {25e6f, 0.1f, 0.3f};
  gas.temperature = 293;
  std::fill(std::begin(gas.open), std::end(gas.open), true);
  world->gases.gases.push_back(gas);
  GasSourceDescription fire;
  fire.name = "fire";
  fire.X_BS.p = {0, 0, 0.3f};
  fire.half_size = {0.2f, 0.2f, 0.15f};
  fire.power = air.power;
  fire.stop = 1e9;
  world->gases.sources.push_back(fire);
  return world;
}

PoseFrame frame_of(const Snapshot& snapshot) {
  auto solver = *PoseSolver::create(snapshot.data().world);
  PoseFrame frame;
  EXPECT_TRUE(solver->solve(snapshot, frame).ok());
  return frame;
}

double smoke_in(const Snapshot& snapshot) {
  const PoseFrame frame = frame_of(snapshot);
  return std::accumulate(frame.fields[0].density->begin(), frame.fields[0].density->end(), 0.0);
}

uint64_t hash_after(const Air& air, int64_t steps, SimulatorOptions options, bool watched = false) {
  std::function<void(const Snapshot&)> look;
  if (watched) look = [](const Snapshot& snapshot) { frame_of(snapshot); };
  return hash_after_steps(make_simulator(world_with(air), std::move(options)), steps, look);
}

TEST(Effects, HashDoesNotDependOnThreadsPaceOrWatchers) {
  expect_one_hash(
      [](SimulatorOptions options, bool watched) { return hash_after({}, 200, options, watched); });
}

TEST(Effects, TheAirIsInTheHash) {
  const Air weak{.power = 20e3f}, strong{.power = 20.001e3f};
  // Until the first fields have joined nobody can tell; from then on the hash does.
  EXPECT_EQ(hash_after(weak, 9, {}), hash_after(strong, 9, {}));
  EXPECT_NE(hash_after(weak, 11, {}), hash_after(strong, 11, {}));
}

TEST(Effects, ASnapshotHasTheFieldOfItsOwnInstant) {
  auto sim = make_simulator(world_with({}), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(40).ok());
  const Snapshot at = sim->latest();
  ASSERT_TRUE(sim->step(5).ok());
  const Snapshot half = sim->latest();
  ASSERT_TRUE(sim->step(5).ok());
  const Snapshot next = sim->latest();
  const PoseFrame a = frame_of(at), b = frame_of(half), c = frame_of(next);
  ASSERT_EQ(a.fields.size(), 1u);
  bool differs = false;
  for (size_t i = 0; i < a.fields[0].density->size(); ++i) {
    const float x = (*a.fields[0].density)[i], y = (*b.fields[0].density)[i],
                z = (*c.fields[0].density)[i];
    EXPECT_NEAR(y, 0.5f * (x + z), 1e-6f * (x + z)) << "half way between two ticks, voxel " << i;
    differs |= x != z;
  }
  EXPECT_TRUE(differs) << "the fire made nothing between two ticks";
}

TEST(Effects, AFireSmokesAndItsSmokeRises) {
  auto sim = make_simulator(world_with({}), lockstep());
  sim->start();
  EXPECT_EQ(smoke_in(sim->latest()), 0);
  ASSERT_TRUE(sim->step(800).ok());
  const PoseFrame frame = frame_of(sim->latest());
  const std::vector<float>& density = *frame.fields[0].density;
  double lowest = 0, highest = 0;  // of the smoke in layers of voxels
  for (size_t i = 0; i < 400; ++i) {
    lowest += density[i];
    highest += density[19 * 400 + i];
  }
  EXPECT_GT(highest, 0);
  EXPECT_GT(highest, 20 * lowest) << "smoke of a fire at 0.3 m does not rise to 1.95 m";
}

TEST(Effects, ResetRepeatsTheRun) {
  auto sim = make_simulator(world_with({}), lockstep());
  sim->start();
  const uint64_t first = sim->latest().hash();
  ASSERT_TRUE(sim->step(60).ok());
  const uint64_t last = sim->latest().hash();
  ASSERT_TRUE(sim->reset().ok());
  EXPECT_EQ(sim->latest().hash(), first);
  EXPECT_EQ(smoke_in(sim->latest()), 0);
  ASSERT_TRUE(sim->step(60).ok());
  EXPECT_EQ(sim->latest().hash(), last);
}

TEST(Effects, ARecompileKeepsTheAirOfTheSameName) {
  auto sim = make_simulator(world_with({}), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(63).ok());
  const double before = smoke_in(sim->latest());
  ASSERT_GT(before, 0);
  ASSERT_TRUE(sim->recompile(world_with({.power = 0}), {}).ok());
  EXPECT_DOUBLE_EQ(smoke_in(sim->latest()), before);
  ASSERT_TRUE(sim->step(40).ok());
  EXPECT_GT(smoke_in(sim->latest()), 0.5 * before) << "the smoke of the old World went";
  ASSERT_TRUE(sim->recompile(world_with({.name = "other"}), {}).ok());
  EXPECT_EQ(smoke_in(sim->latest()), 0) << "air of another name is clear";
  ASSERT_TRUE(sim->step(40).ok());
  EXPECT_GT(smoke_in(sim->latest()), 0);
}

TEST(Effects, ASimulationMayEndAtAnyStep) {
  for (const int steps : {0, 1, 10, 11}) {
    auto sim = make_simulator(world_with({}), lockstep());
    sim->start();
    ASSERT_TRUE(sim->step(steps).ok());
    const Snapshot last = sim->latest();
    sim.reset();
    EXPECT_GE(smoke_in(last), 0) << "a Snapshot outlives its simulation";
  }
}

// Where its smoke is along x [m].
double middle_of_smoke(const PoseFrame& frame) {
  double sum = 0, moment = 0;
  for (size_t i = 0; i < frame.fields[0].density->size(); ++i) {
    const double d = (*frame.fields[0].density)[i];
    sum += d;
    moment += d * (-0.95 + 0.1 * static_cast<double>(i % 20));
  }
  return moment / sum;
}

TEST(Effects, WindOfTheWeatherBlowsSmokeAwayUnlessTheGasHasItsOwn) {
  const auto after = [](double speed, std::optional<Vec3f> own) {
    auto world = world_with({});
    world->wind.speed = speed;
    world->gases.gases[0].wind = own;
    auto sim = make_simulator(world, lockstep());
    sim->start();
    EXPECT_TRUE(sim->step(600).ok());
    return middle_of_smoke(frame_of(sim->latest()));
  };
  const double still = after(0, {}), windy = after(4, {}), sheltered = after(4, Vec3f{});
  EXPECT_NEAR(still, sheltered, 0.01) << "but for the burner, which the wind pushes";
  EXPECT_GT(windy, still + 0.2) << "smoke drifts with the wind";
}

TEST(Effects, ARateAboveTheStepRateIsRefused) {
  const auto made = Simulator::create(world_with({.rate = {300, 1}}), {});
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().to_string().find("rate"), std::string::npos) << made.error().to_string();
}

}  // namespace
}  // namespace gloam
