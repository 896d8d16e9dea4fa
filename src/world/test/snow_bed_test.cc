// Snow that [weather] lays as a bed: where it lies, how deep, and how it is seen.

#include <gmock/gmock.h>

#include <algorithm>

#include "scene/test/temp_folder.h"
#include "world/effects/soil_description.h"
#include "world/effects/visual_soil.h"
#include "world/world.h"

namespace gloam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SnowBed : public ::testing::Test {
 protected:
  SnowBed() {
    folder_.write("street.xml", R"(<mujoco><worldbody>
      <geom type="box" size="9 3 .1" pos="0 0 -.1" contype="0" conaffinity="0"/>
      <geom type="plane" size="30 30 .1"/>
      <geom type="box" size="1 1 .02" pos="0 0 2"/>
      <geom type="box" size=".2 .2 .2" pos="2 0 .2"/>
      <geom type="box" size=".2 .2 .1" pos="2 0 3" contype="0" conaffinity="0"/>
      <geom type="box" size="2 2 .5" pos="0 5 .5" euler="0 75 0"/>
      <body pos="-2 0 1"><freejoint/><geom type="box" size=".3 .3 .1"/></body>
      </worldbody></mujoco>)");
  }
  Result<World> bed(const std::string& weather, const std::string& more) {
    const std::string text = "environment.file = \"street.xml\"\n" + weather +
                             "[[soil]]\nname = \"a\"\nover_ground = true\nkind = \"snow\"\n" + more;
    GLOAM_TRY(const Scene scene, load_scene(folder_.write("s.toml", text)));
    return World::compile(scene);
  }
  TempFolder folder_;
};

// Snow over the plane at z = 0, from its middle outwards.
TEST_F(SnowBed, IsSeenWhereItIsThickEnoughToHideTheGround) {
  const auto heights_of = [this](const std::string& cover, double track) {
    const Result<World> world =
        bed("[weather]\nsnow_cover = " + cover + "\n", "position = [20, 0, 1]\nsize = [4, 4]\n");
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    const SoilDescription& soil = world->compiled()->soils.at(0);
    const std::vector<float> tracks(soil.cells(), static_cast<float>(track));
    std::vector<float> vertices, out;
    append_soil_vertices(soil, tracks, 0, &vertices);
    const auto nx = static_cast<size_t>(soil.nx) + 2;
    for (size_t i = nx / 2; i < nx; ++i) out.push_back(vertices[3 * (nx / 2 * nx + i) + 2]);
    return out;
  };
  const std::vector<float> deep = heights_of("0.12", 0);
  EXPECT_NEAR(deep.front(), 0.12, 1e-6);
  EXPECT_LT(deep.back(), -0.01) << "its border is under the ground";
  EXPECT_TRUE(std::is_sorted(deep.rbegin(), deep.rend())) << "and no step leads there";
  for (size_t i = 1; i < deep.size(); ++i) EXPECT_LT(deep[i - 1] - deep[i], 0.008f);
  EXPECT_NEAR(heights_of("0.12", -0.05).front(), 0.07, 1e-6);
  EXPECT_NEAR(heights_of("0.12", -0.13).front(), 0.003, 1e-6) << "a crust is left";
  for (const float z : heights_of("0.015", 0)) EXPECT_LT(z, 0);
}

// A road that is seen lies on the very ground that is felt.
TEST_F(SnowBed, IsWhatTheWeatherHasLetFall) {
  const std::string place = "position = [0, 0, 1]\nsize = [8, 4]\ncell = 0.05\n";
  const Result<World> world = bed("[weather]\nsnow_cover = 0.1\nsnow = 3.6\n", place);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const SoilDescription& soil = world->compiled()->soils.at(0);
  EXPECT_DOUBLE_EQ(soil.depth, 0.1);
  EXPECT_DOUBLE_EQ(soil.growth, 1e-5) << "ten times 3.6 mm/h";
  const auto cell_at = [&](double x, double y) {
    return static_cast<size_t>((y - soil.low_y()) / soil.dy) * static_cast<size_t>(soil.nx) +
           static_cast<size_t>((x - soil.low_x()) / soil.dx);
  };
  const auto depth_at = [&](double x, double y) { return soil.depth_of(cell_at(x, y), 0); };
  EXPECT_NEAR(depth_at(-2, 0), 0.1, 1e-6) << "what moves keeps nothing off";
  EXPECT_NEAR(soil.rest_of(cell_at(-2, 0)), 0.1, 1e-6);
  EXPECT_NEAR(soil.depth_of(cell_at(-2, 0), 0.05), 0.15, 1e-6);
  EXPECT_EQ(depth_at(0, 0), 0) << "under a roof";
  EXPECT_EQ(depth_at(0.9, 0.9), 0);
  EXPECT_NEAR(depth_at(1.3, 0), 0.1, 1e-6) << "beside it";
  EXPECT_EQ(depth_at(2, 0), 0) << "under what is seen and not felt";
  EXPECT_LT(depth_at(-3.97, 0), 0.005) << "it thins out to its edges";

  const std::string hill = "position = [0, 5, 9]\nsize = [6, 2]\ncell = 0.05\n";
  const Result<World> steep = bed("[weather]\nsnow_cover = 0.1\n", hill);
  ASSERT_TRUE(steep.ok()) << steep.error().to_string();
  const SoilDescription& slope = steep->compiled()->soils.at(0);
  const size_t middle = slope.cells() / 2 + static_cast<size_t>(slope.nx) / 2;
  EXPECT_GT(slope.level, 1) << "on top of it";
  EXPECT_EQ(slope.depth_of(middle, 0), 0) << "it slides off 75 degrees";

  const auto depth_of = [&](const std::string& weather, const std::string& more) {
    const Result<World> made = bed(weather, more);
    EXPECT_TRUE(made.ok()) << made.error().to_string();
    return made.ok() ? made->compiled()->soils.at(0).depth : -1;
  };
  EXPECT_EQ(depth_of("[weather]\nsnow_cover = 0.1\n", place + "depth = 0.3\n"), 0.3) << "given";
  EXPECT_EQ(depth_of("", place), 0.15) << "no weather";
  EXPECT_EQ(depth_of("[weather]\nrain = 1\n", place), 0.15) << "no snow in it";
  EXPECT_EQ(depth_of("[weather]\nsnow_cover = 0\n", place), 0) << "none by its own word";
  EXPECT_THAT(
      bed("[weather]\nsnow = 1\n", "position = [0, 0, 1]\nsize = [1, 1]\n").error().to_string(),
      AllOf(HasSubstr("s.toml:4"), HasSubstr("no snow falls on any of it")));
}

}  // namespace
}  // namespace gloam
