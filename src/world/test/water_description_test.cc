// [[water]] and the wind of [weather] in scene files.

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "scene/test/temp_folder.h"
#include "world/effects/visual_water.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Water : public ::testing::Test {
 protected:
  Water() {
    folder_.write("basin.xml", R"(<mujoco><worldbody>
      <geom type="plane" size="9 9 .1" pos="0 0 -2"/></worldbody></mujoco>)");
  }
  Result<World> compile(const std::string& text) {
    GLOAM_TRY(const Scene scene,
              load_scene(folder_.write("s.toml", "environment.file = \"basin.xml\"\n" + text)));
    return World::compile(scene);
  }
  std::string error_of(const std::string& text) {
    const Result<World> world = compile(text);
    return world.ok() ? "" : world.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(Water, IsWhatItsTableSays) {
  const Result<World> world = compile(R"(
[[water]]
name = "pool"
position = [1, 2, -0.1]
size = [5, 3]
depth = 1.5
wave_height = 0.1
wave_period = 1.4
clarity = 4
)");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const WaterDescription& water = world->compiled()->waters.at(0);
  EXPECT_EQ(water.name, "pool");
  EXPECT_DOUBLE_EQ(water.low_x(), -1.5);
  EXPECT_DOUBLE_EQ(water.low_y(), 0.5);
  EXPECT_DOUBLE_EQ(water.level, -0.1);
  EXPECT_GT(water.waves.size(), 20u);
  EXPECT_EQ(water.ripples.nx, 125);
  EXPECT_DOUBLE_EQ(water.ripples.dx * water.ripples.nx, 5);
  const Result<RenderDescription> seen = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(seen.ok());
  ASSERT_EQ(seen->deformables.size(), 1u);
  EXPECT_LT(seen->deformables[0].rest.triangle_count(), 200000u);
  EXPECT_EQ(seen->deformables[0].rest.positions.size(), static_cast<size_t>(water_vertices(water)));
  const MaterialDescription& look =
      seen->materials[static_cast<size_t>(seen->instances.back().material)];
  EXPECT_EQ(look.transmission_weight, 1);
  EXPECT_NEAR(-std::log(look.transmission_color.y), 1.7 / 4, 1e-5) << "1.7 over Secchi's depth";
  EXPECT_LT(look.transmission_color.x, look.transmission_color.z) << "red goes first";
}

TEST_F(Water, StillWaterIsTwoTriangles) {
  const Result<World> world =
      compile("[[water]]\nname = \"pond\"\nripples = false\nposition = [0, 0, 0]\nsize = [4, 4]\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  EXPECT_EQ(world->compiled()->waters[0].mesh, (WaterGrid{1, 1, 4, 4}));
  EXPECT_EQ(world->compiled()->waters[0].ripples.nx, 0);
}

TEST_F(Water, WindRoughensWhatWavesDoNot) {
  const auto slopes = [&](const std::string& text) {
    const Result<World> world = compile("[[water]]\nname = \"pond\"\nwave_period = 1\n" + text);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return world.ok() ? world->compiled()->waters[0].short_slopes : -1;
  };
  constexpr double kOfSea = 0.003 + 0.00512 * 5;  // Cox and Munk 1954
  EXPECT_EQ(slopes(""), 0);
  EXPECT_EQ(slopes("[weather]\nwind = 0\n"), 0);
  EXPECT_DOUBLE_EQ(slopes("[weather]\nwind = 5\n"), kOfSea);
  const double beside_waves = slopes("wave_height = 0.04\n[weather]\nwind = 5\n");
  // 40 waves of k >= k of the peak have at least its slope: k² times the variance of the height.
  const double k = 4 * std::numbers::pi * std::numbers::pi / 9.81;
  EXPECT_LT(beside_waves, kOfSea - 0.8 * k * k * 0.01 * 0.01);
  EXPECT_GT(beside_waves, 0.5 * kOfSea);
  EXPECT_EQ(slopes("wave_height = 0.2\n[weather]\nwind = 1\n"), 0) << "steep waves leave none";

  const Result<World> world = compile("[[water]]\nname = \"pond\"\n[weather]\nwind = 5\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Result<RenderDescription> seen = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(seen.ok());
  const auto row = static_cast<size_t>(seen->instances.back().material);
  EXPECT_NEAR(std::pow(seen->materials[row].roughness, 4), kOfSea, 1e-6);
}

TEST_F(Water, RefusesWhatWaterCannotDo) {
  EXPECT_THAT(error_of("[[water]]\nname = \"flat\"\ndepth = 0\n"),
              AllOf(HasSubstr("s.toml:4"), HasSubstr("'depth' is 0")));
  EXPECT_THAT(error_of("[[water]]\nname = \"a\"\n[[water]]\nname = \"a\"\n"),
              HasSubstr("two waters named 'a'"));
  EXPECT_THAT(
      error_of("[[water]]\nname = \"a\"\n[[water]]\nname = \"b\"\nposition = [3, 0, 0.5]\n"),
      AllOf(HasSubstr("'b'"), HasSubstr("overlaps the box of water 'a'"), HasSubstr(":4:")));
  EXPECT_EQ(error_of("[[water]]\nname = \"a\"\n[[water]]\nname = \"b\"\nposition = [4, 0, 0]\n"),
            "");
  EXPECT_EQ(error_of("[[water]]\nname = \"a\"\n[[water]]\nname = \"b\"\nposition = [0, 0, 1]\n"),
            "");
  // Deep water: 1.56 T² long, and a seventh as high at most.
  EXPECT_THAT(error_of("[[water]]\nname = \"a\"\nsize = [50, 50]\ndepth = 20\nwave_height = 0.9\n"
                       "wave_period = 2\n"),
              AllOf(HasSubstr("would break"), HasSubstr("0.88"), HasSubstr("wave_period")));
  EXPECT_EQ(error_of("[[water]]\nname = \"a\"\nsize = [50, 50]\ndepth = 20\nwave_height = 0.8\n"
                     "wave_period = 2\n"),
            "");
  EXPECT_THAT(
      error_of("[[water]]\nname = \"a\"\ndepth = 0.1\nwave_height = 0.2\nwave_period = 5\n"),
      HasSubstr("would break"))
      << "higher than shallow water carries";
  EXPECT_THAT(error_of("[[water]]\nname = \"a\"\nwave_hight = 1\n"), HasSubstr("wave_height"));
}

TEST_F(Water, WindComesFromItsAzimuth) {
  const auto wind = [&](const std::string& text) {
    const Result<World> world = compile(text);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return world.ok() ? world->compiled()->wind : WindDescription{};
  };
  const WindDescription west = wind("[weather]\nwind = 8\n");
  EXPECT_EQ(west.speed, 8);
  EXPECT_NEAR(west.gusts, 1.2, 1e-12);
  EXPECT_NEAR(west.along_x, 1, 1e-12) << "from the west it blows to the east, +X";
  EXPECT_NEAR(west.along_y, 0, 1e-12);
  const WindDescription north = wind("[weather]\nwind = 8\nwind_from = 0\ngusts = 0\n");
  EXPECT_NEAR(north.along_y, -1, 1e-12);
  EXPECT_EQ(north.gusts, 0);
  // North turned counter-clockwise by 90 degrees is -X: wind from there blows to +X.
  const WindDescription turned = wind(
      "[weather]\nwind = 8\nwind_from = 0\n[sky]\nnorth = 90\n"
      "sun_elevation = 40\n");
  EXPECT_NEAR(turned.along_x, 1, 1e-12);
  EXPECT_FALSE(wind("[weather]\nrain = 1\n").blows());
}

TEST_F(Water, GeneratedBuildingsAreStill) {
  const auto blows = [&](const std::string& place) {
    const Result<Scene> scene =
        load_scene(folder_.write("t.toml", place + "[weather]\nwind = 8\n"));
    EXPECT_TRUE(scene.ok()) << scene.error().to_string();
    return describe_wind(*scene, *scene->weather).blows();
  };
  EXPECT_FALSE(blows("[environment.house]\nseed = 1\n"));
  EXPECT_TRUE(blows("[environment.terrain]\nseed = 1\n"));
}

}  // namespace
}  // namespace gloam
