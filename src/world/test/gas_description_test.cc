// [[gas]], [[fire]] and [[smoke]] on the compiled model.

#include "world/gas_description.h"

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
                             HasSubstr("gas 'g' reaches from (-1, -1, 0) to (1, 1, 2)")));
  EXPECT_THAT(error_of(gas + "voxel = 0.001\n"), HasSubstr("too many"));
  EXPECT_THAT(error_of(gas + "medium = \"smog\"\n"), HasSubstr("there is no medium 'smog'"));
  EXPECT_THAT(error_of(gas + "[[gas]]\nname = \"h\"\nposition = [1, 0, 1]\nsize = [2, 2, 2]\n"),
              HasSubstr("overlaps that of gas 'g'"));
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\nsize = [2, 2, 2]\n"), HasSubstr("no position"));
  EXPECT_THAT(error_of("[[fire]]\nname = \"f\"\nbody = \"crat\"\n"), HasSubstr("'cart'"));
  EXPECT_THAT(error_of("[[fire]]\nname = \"f\"\npower = -1\n"), HasSubstr("'power' is -1"));
  EXPECT_THAT(error_of("[[smoke]]\nname = \"s\"\nstart = 5\nstop = 4\n"), HasSubstr("stops at 4"));
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\nclosed = [\"up\"]\n"), HasSubstr("'up'"));
  EXPECT_THAT(error_of("[[gas]]\nname = \"g\"\nrate = 0\n"), HasSubstr("rate"));
}

}  // namespace
}  // namespace gloam
