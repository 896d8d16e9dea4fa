// [[gas]], [[fire]] and [[smoke]] on the compiled model.

#include "world/effects/gas_description.h"

#include <gmock/gmock.h>

#include "scene/test/temp_folder.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

class Gas : public ::testing::Test {
 protected:
  Gas() {
    folder_.write("room.xml", R"(<mujoco><worldbody><geom type="plane" size="9 9 .1"/>
      <body name="cart" pos="1 2 0.5"><freejoint/><geom size=".1"/></body></worldbody></mujoco>)");
  }
  Result<World> compile(const std::string& text) {
    GLOAM_TRY(const Scene scene,
              load_scene(folder_.write("s.toml", "environment.file = \"room.xml\"\n" + text)));
    return World::compile(scene);
  }
  GasesDescription gases(const std::string& text) {
    const Result<World> world = compile(text);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return world.ok() ? world->compiled()->gases : GasesDescription{};
  }
  std::string error_of(const std::string& text) {
    const Result<World> world = compile(text);
    return world.ok() ? "" : world.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(Gas, HasTheBoxAndTheVoxelsAskedFor) {
  const GasesDescription d = gases(R"(
[[gas]]
name = "room"
position = [1, 2, 1.5]
size = [4, 3, 3]
voxel = 0.25
rate = 20
medium = "dust"
closed = ["-z", "+z"]
wind = [2, 0, 0]
)");
  ASSERT_EQ(d.gases.size(), 1u);
  const GasDescription& gas = d.gases[0];
  EXPECT_EQ(gas.nx, 16);
  EXPECT_EQ(gas.ny, 12);
  EXPECT_EQ(gas.nz, 12);
  EXPECT_FLOAT_EQ(gas.low.x, -1);
  EXPECT_FLOAT_EQ(gas.low.y, 0.5f);
  EXPECT_FLOAT_EQ(gas.low.z, 0);
  EXPECT_EQ(gas.rate, (Rational{20, 1}));
  EXPECT_EQ(gas.medium.name, "dust");
  EXPECT_TRUE(gas.open[0]);
  EXPECT_FALSE(gas.open[4]);
  EXPECT_FALSE(gas.open[5]);
  EXPECT_FLOAT_EQ(gas.wind->x, 2);
}

TEST_F(Gas, IsMadeAroundWhatSmokesWhereThereIsNone) {
  const GasesDescription d = gases("[[fire]]\nname = \"f\"\nposition = [3, 1, 0.4]\n");
  ASSERT_EQ(d.gases.size(), 1u);
  const GasDescription& gas = d.gases[0];
  const Vec3f middle = gas.low + gas.size() * 0.5f;
  EXPECT_NEAR(middle.x, 3, 0.1);
  EXPECT_NEAR(middle.y, 1, 0.1);
  EXPECT_LE(gas.low.z, 0);
  EXPECT_LE(int64_t{gas.nx} * gas.ny * gas.nz, 300000);
}

TEST_F(Gas, FollowsTheRoomsOfAGeneratedPlace) {
  const Result<Scene> scene = load_scene(folder_.write(
      "h.toml",
      "[environment.bedroom]\nseed = 2\n[[smoke]]\nname = \"s\"\nposition = [0, 0, 1]\n"));
  ASSERT_TRUE(scene.ok());
  const Result<World> world = World::compile(*scene);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const GasDescription& gas = world->compiled()->gases.gases.at(0);
  const Vec3f high = gas.low + gas.size();
  for (const Region& region : world->compiled()->regions) {
    EXPECT_LT(gas.low.x, region.low.x) << region.name;
    EXPECT_LT(gas.low.y, region.low.y) << region.name;
    EXPECT_LT(gas.low.z, region.low.z) << region.name;
    EXPECT_GT(high.x, region.high.x) << region.name;
    EXPECT_GT(high.y, region.high.y) << region.name;
    EXPECT_GT(high.z, region.high.z) << region.name;
  }
}

TEST_F(Gas, FiresGrowWithTheSquareOfTime) {
  const GasesDescription d = gases(R"(
[[fire]]
name = "f"
body = "cart"
power = 1e6
growth = "fast"
start = 10
stop = 400
)");
  const GasSourceDescription& fire = d.sources.at(0);
  EXPECT_EQ(fire.body, 1);
  EXPECT_EQ(fire.power_at(9.9), 0);
  EXPECT_NEAR(fire.power_at(110), 0.0469e3 * 1e4, 1);  // NFPA 72: 1055 kW after 150 s
  EXPECT_NEAR(fire.power_at(160), 1e6, 1);
  EXPECT_EQ(fire.power_at(400), 0);
  // Means over intervals, in which it begins, grows, has grown and ends, against sums.
  for (const auto& [from, to] : {std::pair{9.5, 10.5},
                                 {9.0, 9.5},
                                 {50.0, 50.1},
                                 {150.0, 170.0},
                                 {200.0, 200.1},
                                 {300.0, 500.0}}) {
    double sum = 0, on = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double t = from + (to - from) * (i + 0.5) / n;
      sum += static_cast<double>(fire.power_at(t)) / n;
      on += fire.is_on(t) ? 1.0 / n : 0;
    }
    EXPECT_NEAR(fire.mean_power(from, to), sum, 1 + 1e-4 * sum) << from;
    EXPECT_NEAR(fire.share_on(from, to), on, 2.0 / n) << from;
  }
}

TEST_F(Gas, IsAVolumeOfThePicture) {
  const Result<World> world = compile("[[smoke]]\nname = \"s\"\nposition = [0, 0, 1]\n");
  ASSERT_TRUE(world.ok());
  const Result<RenderDescription> d = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(d.ok());
  ASSERT_EQ(d->volumes.size(), 1u);
  EXPECT_EQ(d->volumes[0].field, 0);
  EXPECT_EQ(d->volumes[0].even_density, 0) << "smoke before any was made";
}

TEST_F(Gas, RefusesWhatCannotBe) {
  const std::string gas = "[[gas]]\nname = \"g\"\nposition = [0, 0, 1]\nsize = [2, 2, 2]\n";
  EXPECT_THAT(error_of(gas + "[[fire]]\nname = \"f\"\nposition = [5, 0, 1]\n"),
              testing::AllOf(HasSubstr("s.toml:6"), HasSubstr("fire 'f' is at (5, 0, 1)"),
                             HasSubstr("gas 'g' extends from (-1, -1, 0) to (1, 1, 2)")));
  EXPECT_THAT(error_of(gas + "voxel = 0.001\n"), HasSubstr("too many"));
  EXPECT_THAT(error_of(gas + "medium = \"smog\"\n"), HasSubstr("there is no medium 'smog'"));
  EXPECT_THAT(error_of(gas + "[[gas]]\nname = \"h\"\nposition = [1, 0, 1]\nsize = [2, 2, 2]\n"),
              HasSubstr("overlaps the box of gas 'g'"));
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\nsize = [2, 2, 2]\n"), HasSubstr("no position"));
  EXPECT_THAT(error_of("[[fire]]\nname = \"f\"\nbody = \"crat\"\n"), HasSubstr("'cart'"));
  EXPECT_THAT(error_of("[[fire]]\nname = \"f\"\npower = -1\n"), HasSubstr("'power' is -1"));
  EXPECT_THAT(error_of("[[smoke]]\nname = \"s\"\nstart = 5\nstop = 4\n"), HasSubstr("stops at 4"));
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\nclosed = [\"up\"]\n"), HasSubstr("'up'"));
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\nrate = 0\n"), HasSubstr("rate"));
}

// A drone of two rotors, one of which leans, and what does not push.
class Rotors : public Gas {
 protected:
  Rotors() {
    folder_.write("room.xml", R"(<mujoco><worldbody><geom type="plane" size="9 9 .1"/>
      <site name="fan" pos="1 2 1" euler="0 90 0"/>
      <body name="drone" pos="0 0 1"><freejoint/><geom size=".1"/>
        <site name="left" pos="0 .2 0"/>
        <site name="right" pos="0 -.2 .1" euler="90 0 0"/>
        <geom name="blade" type="cylinder" size=".1 .01" pos="0 .2 0"/>
        <geom name="arm" type="capsule" fromto="0 0 0 0 .2 0" size=".01"/>
        <body name="hub" pos="0 -.2 .1"><joint name="blade_joint" axis="0 1 0"/>
          <geom name="spinning" type="box" size=".1 .01 .02"/></body></body></worldbody>
      <actuator><motor name="lift" site="left" gear="0 0 2 0 0 .1"/>
        <motor name="lean" site="right" gear="0 0 -1 0 0 0"/>
        <motor name="twist" site="left" gear="0 0 0 0 0 1"/>
        <motor name="hinge" joint="blade_joint"/></actuator></mujoco>)");
  }
  static std::string rotor(const std::string& keys) {
    return "[[rotor]]\nname = \"r\"\nradius = 0.1\n" + keys;
  }
  const std::string gas_ = "[[gas]]\nname = \"g\"\nposition = [0, 0, 1]\nsize = [4, 4, 2]\n";
};

TEST_F(Rotors, AreWhereTheirThrustActs) {
  const GasesDescription d = gases(gas_ + rotor("actuator = \"lift\"\n") +
                                   "[[rotor]]\nname = \"s\"\nradius = 0.1\nactuator = \"lean\"\n"
                                   "[[rotor]]\nname = \"t\"\nradius = 0.3\nsite = \"fan\"\n"
                                   "thrust = 4\n");
  ASSERT_EQ(d.rotors.size(), 3u);
  const RotorDescription &left = d.rotors[0], &right = d.rotors[1], &fan = d.rotors[2];
  EXPECT_EQ(left.body, 1);
  EXPECT_FLOAT_EQ(left.p_B.y, 0.2f);
  EXPECT_FLOAT_EQ(left.axis_B.z, 1);
  EXPECT_FLOAT_EQ(left.thrust, 2) << "N for each unit of force: the gear";
  EXPECT_NEAR(right.axis_B.y, 1, 1e-6) << "against the site's z axis, which points to -y";
  EXPECT_FLOAT_EQ(right.thrust, 1);
  EXPECT_EQ(fan.body, 0);
  EXPECT_EQ(fan.actuator, -1);
  EXPECT_NEAR(fan.axis_B.x, 1, 1e-6);
  EXPECT_FLOAT_EQ(fan.thrust, 4);
}

TEST_F(Rotors, KnowTheirBladesFromWhatCarriesThem) {
  const Result<World> world = compile(gas_ + rotor("actuator = \"lift\"\n") +
                                      "[[rotor]]\nname = \"s\"\nradius = 0.1\n"
                                      "actuator = \"lean\"\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const auto& compiled = *world->compiled();
  const auto id = [&](const char* name) {
    return mj_name2id(compiled.model.get(), mjOBJ_GEOM, name);
  };
  EXPECT_EQ(compiled.gases.rotors[0].blades, std::vector<int>{id("blade")});
  EXPECT_EQ(compiled.gases.rotors[1].blades, std::vector<int>{id("spinning")});
}

TEST_F(Rotors, RefusesWhatCannotBe) {
  const auto refused = [&](const std::string& keys) { return error_of(gas_ + rotor(keys)); };
  EXPECT_THAT(refused("actuator = \"lft\"\n"),
              testing::AllOf(HasSubstr("s.toml:6"), HasSubstr("there is no actuator 'lft'"),
                             HasSubstr("'lift'")));
  EXPECT_THAT(refused("site = \"lef\"\nthrust = 1\n"), HasSubstr("there is no site 'lef'"));
  EXPECT_THAT(refused("actuator = \"twist\"\n"), HasSubstr("does not push a site"));
  EXPECT_THAT(refused("actuator = \"hinge\"\n"), HasSubstr("does not push a site"));
  EXPECT_THAT(refused(""), HasSubstr("neither an actuator nor a site"));
  EXPECT_THAT(refused("actuator = \"lift\"\nsite = \"left\"\n"),
              HasSubstr("both an actuator and a site"));
  EXPECT_THAT(refused("actuator = \"lift\"\nthrust = 2\n"),
              HasSubstr("a thrust in addition to its actuator's force"));
  EXPECT_THAT(refused("site = \"left\"\n"), HasSubstr("a site but no thrust"));
  EXPECT_THAT(refused("site = \"left\"\nthrust = 1e9\n"), HasSubstr("'thrust' is 1000000000"));
  EXPECT_THAT(error_of(gas_ + "[[rotor]]\nname = \"r\"\nactuator = \"lift\"\nradius = 0\n"),
              HasSubstr("'radius' is 0"));
  EXPECT_THAT(error_of(gas_ + "[[rotor]]\nname = \"r\"\nactuator = \"lift\"\n"),
              HasSubstr("radius"));
  EXPECT_THAT(refused("actuator = \"lift\"\n" + rotor("actuator = \"lift\"\n")),
              HasSubstr("rotor"));
  EXPECT_THAT(error_of(rotor("actuator = \"lift\"\n")), HasSubstr("there is no gas"));
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\nposition = [9, 9, 1]\nsize = [2, 2, 2]\n" +
                       rotor("site = \"fan\"\nthrust = 1\n")),
              HasSubstr("outside of any gas"));
}

TEST_F(Gas, OfDustIsMadeWhereGroundIsDusty) {
  const GasesDescription d = gases(R"(
[[dust]]
name = "yard"
position = [3, 1, 0]
size = [4, 4, 1]
silt = 0.2
clay = 0.1
threshold = 0.4
)");
  ASSERT_EQ(d.gases.size(), 1u);
  EXPECT_EQ(d.gases[0].medium.name, "dust");
  EXPECT_NEAR((d.gases[0].low + d.gases[0].size() * 0.5f).x, 3, 0.1);
  EXPECT_NEAR(d.gases[0].low.z, 0, 0.01);
  ASSERT_EQ(d.dusts.size(), 1u);
  EXPECT_TRUE(d.dusts[0].holds({1.5f, 1, 0.4f}));
  EXPECT_FALSE(d.dusts[0].holds({5.5f, 1, 0}));
  EXPECT_FLOAT_EQ(d.dusts[0].silt, 0.2f);
  EXPECT_FLOAT_EQ(d.dusts[0].clay, 0.1f);
  EXPECT_FLOAT_EQ(d.dusts[0].threshold, 0.4f);
  EXPECT_TRUE(gases("[[dust]]\nname = \"all\"\n").dusts[0].holds({500, 1, -3}));
}

TEST_F(Gas, RefusesDustThatCannotBe) {
  const std::string dust = "[[dust]]\nname = \"d\"\n";
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\n" + dust),
              testing::AllOf(HasSubstr("s.toml:4"), HasSubstr("no gas that carries dust"),
                             HasSubstr("medium = \"dust\"")));
  EXPECT_EQ(error_of("[[gas]]\nname = \"g\"\nmedium = \"dust\"\n" + dust), "");
  EXPECT_THAT(error_of(dust + "size = [1, 1, 1]\n"), HasSubstr("no position"));
  EXPECT_THAT(error_of(dust + "position = [1, 1, 1]\n"), HasSubstr("no size"));
  EXPECT_THAT(error_of(dust + "position = [0, 0, 0]\nsize = [1, 0, 1]\n"), HasSubstr("size"));
  EXPECT_THAT(error_of(dust + "silt = 1.5\n"), HasSubstr("'silt' is 1.5"));
  EXPECT_THAT(error_of(dust + "clay = 0.3\n"), HasSubstr("'clay' is 0.3"));
  EXPECT_THAT(error_of(dust + "threshold = 0\n"), HasSubstr("'threshold' is 0"));
  EXPECT_THAT(error_of(dust + dust), HasSubstr("dust"));
}

}  // namespace
}  // namespace gloam
