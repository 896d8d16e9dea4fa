// [[lidar]] of scene files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gloam/scene.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

class LidarToml : public ::testing::Test {
 protected:
  LidarToml() {
    folder_.write("robot.xml", "<mujoco><worldbody><body name='b'/></worldbody></mujoco>");
  }
  Result<Scene> load(const std::string& text) {
    return load_scene(folder_.write("scene.toml", "environment.file = \"robot.xml\"\n" + text));
  }
  std::string error_of(const std::string& lines) {
    const Result<Scene> scene = load("[[lidar]]\nname = \"l\"\n" + lines);
    return scene.ok() ? "" : scene.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(LidarToml, ReadsEveryOption) {
  const Result<Scene> scene = load(R"(
[[lidar]]
name = "roof"
body = "b"
position = [0, 0, 1]
orientation = [2, 0, 0, 0]
preset = "VLP-16"
pattern = "spinning"
rate = 20
elevations = [-10, 0, 10]
columns = 512
azimuth = [-90, 90]
clockwise = false
wavelength = 1550
min_range = 0.2
max_range = 50
range_at_10_percent = 0
divergence = [0.1, 0.2]
pulse_length = 0.4
footprint_rays = 9
returns = "dual"
most_returns = 2
noise = true
range_noise = 0.01
motion_keys = 10
deskew = true
truth = true
intensity = "signal"
outputs = ["ply", "npy"]
[[lidar.surface]]
material = "leaf*"
diffuse = 0.5
[[lidar.surface]]
material = "tape"
retro = 250
[[lidar]]
name = "wall"
pattern = "raster"
rows = 10
columns = 20
field_of_view = [60, 30]
[[lidar]]
name = "rose"
preset = "Mid-40"
points = 5000
)");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  ASSERT_EQ(scene->lidars.size(), 3u);
  const LidarOptions& roof = scene->lidars[0];
  EXPECT_EQ(roof.body, "b");
  EXPECT_EQ(roof.orientation, (Quat{1, 0, 0, 0}));
  EXPECT_EQ(roof.elevations->size(), 3u);
  EXPECT_EQ(*roof.rate, (Rational{20, 1}));
  EXPECT_EQ((*roof.azimuth)[1], 90);
  EXPECT_EQ(roof.clockwise, false);
  EXPECT_EQ((*roof.divergence)[1], 0.2);
  EXPECT_EQ(roof.outputs->size(), 2u);
  ASSERT_EQ(roof.surfaces.size(), 2u);
  EXPECT_EQ(roof.surfaces[0].diffuse, 0.5);
  EXPECT_EQ(roof.surfaces[1].retro, 250);
  EXPECT_FALSE(scene->lidars[1].outputs.has_value());
  EXPECT_EQ(scene->lidars[2].points, 5000);
}

TEST_F(LidarToml, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(error_of("preset = \"VLP-61\""), HasSubstr("VLP-16"));
  EXPECT_THAT(error_of("preset = \"VLP-61\""), HasSubstr("scene.toml:4"));
  EXPECT_THAT(error_of("wavelength = 1064"), HasSubstr("905 and 1550"));
  EXPECT_THAT(error_of("min_range = 5\nmax_range = 2"), HasSubstr("greater than"));
  EXPECT_THAT(error_of("azimuth = [90, -90]"), HasSubstr("from < to"));
  EXPECT_THAT(error_of("elevations = []"), HasSubstr("rings"));
  EXPECT_THAT(error_of("elevations = [91]"), HasSubstr("from -90 to 90"));
  EXPECT_THAT(error_of("footprint_rays = 33"), HasSubstr("from 1 to 32"));
  EXPECT_THAT(error_of("most_returns = 0"), HasSubstr("from 1 to 5"));
  EXPECT_THAT(error_of("returns = \"firts\""), HasSubstr("first"));
  EXPECT_THAT(error_of("rate = 0"), HasSubstr("rate"));
  EXPECT_THAT(error_of("columns = 0"), HasSubstr("columns"));
  EXPECT_THAT(error_of("pulse_length = 0"), HasSubstr("pulse_length"));
  EXPECT_THAT(error_of("divergence = [0.1]"), HasSubstr("2 numbers"));
  EXPECT_THAT(error_of("beam_size = [0.1]"), HasSubstr("2 numbers"));
  EXPECT_THAT(error_of("receiver_diameter = -1"), HasSubstr("receiver_diameter"));
  EXPECT_THAT(error_of("receiver_offset = 2"), HasSubstr("receiver_offset"));
  EXPECT_THAT(error_of("receiver_view = 0"), HasSubstr("receiver_view"));
  EXPECT_THAT(error_of("outputs = [\"las\"]"), HasSubstr("las"));
  EXPECT_THAT(error_of("[[lidar.surface]]\nretro = 3"), HasSubstr("'material' is missing"));
  EXPECT_THAT(error_of("[[lidar.surface]]\nmaterial = \"a\"\ndiffuse = 2"), HasSubstr("0 to 1"));
  EXPECT_THAT(error_of("beams = 3"), HasSubstr("unknown key 'beams'"));
  EXPECT_THAT(error_of("[[lidar]]\nname = \"l\""), HasSubstr("two lidars named 'l'"));
  EXPECT_THAT(load("[[lidar]]\nbody = \"b\"").error().to_string(), HasSubstr("'name' is missing"));
}

TEST_F(LidarToml, IsSetFromTheCommandLine) {
  Result<Scene> scene = load("[[lidar]]\nname = \"l\"\n");
  ASSERT_TRUE(scene.ok());
  EXPECT_TRUE(set_option(*scene, "lidar.l.max_range", "30").ok());
  EXPECT_EQ(scene->lidars[0].max_range, 30);
  EXPECT_FALSE(set_option(*scene, "lidar.k.max_range", "30").ok());
  EXPECT_FALSE(set_option(*scene, "lidar.l.max_range", "-1").ok());
}

}  // namespace
}  // namespace gloam
