// Snow on what moves: what turns, brakes or is shaken loses it, what stands keeps it.

#include <fmt/format.h>

#include "same_hash.h"

namespace gloam {
namespace {

// A wheel on an axle across, a turntable, a crate that stands and a sledge that is driven.
const char* const kYard = R"(<mujoco><option timestep="0.002"/><worldbody>
  <geom type="plane" size="9 9 .1"/>
  <body name="wheel" pos="0 0 1"><joint name="wheel" axis="0 1 0"/>
    <geom type="cylinder" size=".3 .1" euler="90 0 0" contype="0" conaffinity="0"/></body>
  <body name="table" pos="2 0 1"><joint name="table" axis="0 0 1"/>
    <geom type="cylinder" size=".5 .02" contype="0" conaffinity="0"/></body>
  <body name="crate" pos="4 0 .2"><freejoint name="crate"/><geom type="box" size=".3 .3 .2"/></body>
  <body name="sledge" pos="0 3 .2"><joint name="sledge" type="slide" axis="1 0 0"/>
    <geom type="box" size=".3 .3 .2" contype="0" conaffinity="0" mass="1"/></body>
  </worldbody></mujoco>)";

enum YardBody { kWheel = 1, kTable, kCrate, kSledge };

std::shared_ptr<CompiledWorld> snowy(double cover, double snow = 0) {
  auto world = world_from_mjcf(kYard);
  world->scene.weather = WeatherOptions{.snow = snow, .snow_cover = cover};
  return world;
}

struct Yard {
  explicit Yard(std::shared_ptr<CompiledWorld> in)
      : world(std::move(in)), sim(make_simulator(world, lockstep())) {
    sim->start();
  }
  void spin(const char* joint, double speed, double angle = 0) {
    const int id = mj_name2id(world->model.get(), mjOBJ_JOINT, joint);
    ASSERT_TRUE(sim->post({.what = SetJointState{Joint{id}, {angle}, {speed}}}).ok());
  }
  void run(double seconds) { ASSERT_TRUE(sim->step(std::lround(seconds / 0.002)).ok()); }
  double left(YardBody body) const {
    const Snapshot now = sim->latest();
    const auto& left = now.data().effects.snow_left;
    return left == nullptr ? 1 : double{(*left)[size_t(body)]};
  }
  std::shared_ptr<CompiledWorld> world;
  std::unique_ptr<Simulator> sim;
};

TEST(SnowShedding, AWheelThatTurnsEndsBareAndWhatStandsKeepsItsSnow) {
  Yard yard(snowy(0.08));
  yard.spin("wheel", 1);
  yard.run(0.1);
  EXPECT_EQ(yard.left(kWheel), 1) << "by 6 degrees nothing slides";
  yard.run(3);
  EXPECT_LT(yard.left(kWheel), 0.02);
  EXPECT_EQ(yard.left(kCrate), 1);
  EXPECT_EQ(yard.left(kTable), 1) << "a disc that stands";
  yard.run(5);
  EXPECT_EQ(yard.left(kCrate), 1);
}

// The rim leaves the snow behind where w² r is more than g tan 15: w = 2.3 rad/s at 0.5 m.
TEST(SnowShedding, ALevelDiscThrowsItOffFromItsSpinOn) {
  Yard slow(snowy(0.08)), fast(snowy(0.08));
  slow.spin("table", 2);
  fast.spin("table", 2.6);
  slow.run(2), fast.run(2);
  EXPECT_EQ(slow.left(kTable), 1);
  EXPECT_LT(fast.left(kTable), 0.05);
}

TEST(SnowShedding, HardBrakingShedsAndAGentleStartDoesNot) {
  const auto pushed = [](double force) {  // [N] on 1 kg
    Yard yard(snowy(0.08));
    EXPECT_TRUE(yard.sim->post({.what = SetWrench{Body{kSledge}, {force, 0, 0}, {}}}).ok());
    yard.run(1.5);
    return yard.left(kSledge);
  };
  EXPECT_EQ(pushed(1.5), 1) << "1.5 m/s², 9 degrees";
  EXPECT_LT(pushed(8), 0.1) << "8 m/s², 39 degrees";
}

TEST(SnowShedding, NewSnowLiesAgainOnceItRestsHoweverItStands) {
  Yard yard(snowy(0.01, 720));  // 2 mm of snow a second
  yard.spin("wheel", 5);
  yard.run(2);
  EXPECT_LT(yard.left(kWheel), 0.1);
  yard.spin("wheel", 0, 1.2);
  yard.run(10);
  EXPECT_NEAR(yard.left(kWheel), 0.0185 / 0.034, 0.06) << "what fell in 9 of 12 s, of all";
  EXPECT_EQ(yard.left(kCrate), 1);
}

TEST(SnowShedding, WithoutSnowThereIsNoEffectAndNoCost) {
  Yard bare(snowy(0));
  bare.spin("wheel", 5);
  bare.run(1);
  EXPECT_EQ(bare.sim->latest().data().effects.snow_left, nullptr);
  Yard snow(snowy(0.08)), none(snowy(0));
  snow.spin("wheel", 5), none.spin("wheel", 5);
  snow.run(1), none.run(1);
  const auto a = snow.sim->latest().state(), b = none.sim->latest().state();
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << "it moves nothing";
}

TEST(SnowShedding, AResetBringsItBackAndARunIsTheSameHoweverItIsRun) {
  Yard yard(snowy(0.08));
  yard.spin("wheel", 5);
  yard.run(2);
  ASSERT_TRUE(yard.sim->reset().ok());
  EXPECT_EQ(yard.left(kWheel), 1);
  expect_one_hash([](SimulatorOptions options, bool watched) {
    std::function<void(const Snapshot&)> look;
    if (watched) look = [](const Snapshot&) {};
    return hash_after_steps(make_simulator(snowy(0.05, 100), std::move(options)), 600, look);
  });
}

}  // namespace
}  // namespace gloam
