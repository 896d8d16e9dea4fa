// [camera.imager] and its kin, rigs and [[sensor]]s in scene files.

#include <gtest/gtest.h>

#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

Status read(const std::string& text, Scene* scene) {
  GLOAM_TRY_STATUS(read_scene_toml(text, "a.toml", scene));
  return validate_scene(*scene);
}

std::string message(const std::string& text) {
  Scene scene;
  const Status status = read(text, &scene);
  return status.ok() ? std::string() : status.error().to_string();
}

TEST(ImagerToml, NothingIsOnUnlessItIsThere) {
  Scene scene;
  ASSERT_TRUE(read("[[camera]]\nname = \"a\"\n", &scene).ok());
  const CameraSensing& none = scene.cameras[0].sensing;
  EXPECT_FALSE(none.imager || none.timing || none.stereo_depth || none.events || none.thermal);
  ASSERT_TRUE(read("[[camera]]\nname = \"a\"\n[camera.imager.pixel]\n", &scene).ok());
  const ImagerOptions& imager = *scene.cameras[0].sensing.imager;
  EXPECT_FALSE(imager.pixel->shot_noise);
  EXPECT_EQ(imager.pixel->read_noise + imager.pixel->prnu + imager.pixel->dsnu +
                imager.pixel->dark_current + imager.pixel->bits,
            0);
  EXPECT_EQ(imager.mosaic, "none");
  EXPECT_EQ(imager.jpeg, 0);
}

TEST(ImagerToml, ReadsEveryTable) {
  Scene scene;
  const Status status = read(R"(
[[camera]]
name = "a"
[camera.imager]
mosaic = "rggb"
white_balance = [2, 1, 1.5]
exposure = { f_number = 4, shutter = 0.002, iso = 800 }
vignetting = { cos4 = true, polynomial = [-0.1, 0, 0] }
pixel = { shot_noise = true, read_noise = 2.5, bits = 12, black_level = 64 }
[camera.timing]
phase = "1/60"
drop = 0.01
[camera.stereo_depth]
preset = "d435"
noise = 0.1
[camera.events]
threshold = 0.15
[camera.thermal]
netd = 0.05
[[stereo]]
name = "eyes"
baseline = 0.12
position = [1, 0, 1]
look_at = [0, 0, 0]
[[rgbd]]
name = "head"
imager = { jpeg = 90 }
[[sensor]]
match = "*_gyro"
preset = "bmi088_gyro"
rate = 400
[[temperature]]
body = "motor*"
temperature = 340
)",
                             &scene);
  ASSERT_TRUE(status.ok()) << status.error().to_string();
  const CameraSensing& s = scene.cameras[0].sensing;
  EXPECT_EQ(s.imager->exposure->iso, 800);
  EXPECT_EQ(s.timing->phase, (Rational{1, 60}));
  EXPECT_EQ(s.stereo_depth->noise, 0.1);
  EXPECT_FALSE(s.stereo_depth->edge_loss.has_value());
  EXPECT_EQ(scene.stereo[0].baseline, 0.12);
  EXPECT_EQ(scene.rgbd[0].sensing.imager->jpeg, 90);
  EXPECT_EQ(scene.rgbd[0].depth.preset, "d435");
  EXPECT_EQ(scene.sensors[0].rate, (Rational{400, 1}));
  EXPECT_EQ(scene.temperatures[0].temperature, 340);
  EXPECT_TRUE(set_option(scene, "camera.a.imager.exposure.iso", "1600").ok());
  EXPECT_EQ(scene.cameras[0].sensing.imager->exposure->iso, 1600);
  EXPECT_TRUE(set_option(scene, "stereo.eyes.baseline", "0.2").ok());
  EXPECT_EQ(scene.stereo[0].baseline, 0.2);
}

TEST(ImagerToml, MistakesNameTheirPlace) {
  const auto camera = [](const std::string& rest) { return "[[camera]]\nname = \"a\"\n" + rest; };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {camera("[camera.imager]\nmosaic = \"rgbg\"\n"), "a.toml:4"},
      {camera("[camera.imager]\njpeg = 101\n"), "from 0 to 100"},
      {camera("[camera.imager]\nwhite_balance = [0.5, 1, 1]\n"), "white_balance"},
      {camera("[camera.imager.pixel]\nbits = 17\n"), "a.toml:4"},
      {camera("[camera.imager.pixel]\nbits = 8\nblack_level = 200\n"), "black_level"},
      {camera("[camera.imager.pixel]\nblack_level = 64\n"), "set 'bits'"},
      {camera("[camera.imager.pixel]\nread_nose = 1\n"), "read_noise"},
      {camera("[camera.imager.exposure]\nshutter = 0\n"), "shutter"},
      {camera("[camera.imager.auto_exposure]\nmin_ev100 = 9\nmax_ev100 = 3\n"), "greater than"},
      {camera("[camera.timing]\ndrop = 1.5\n"), "drop"},
      {camera("[camera.timing]\nphase = -1\n"), "phase"},
      {camera("[camera.timing]\njitter = nan\n"), "jitter"},
      {camera("[camera.stereo_depth]\nnoise = 0.1\n"), "baseline"},
      {camera("[camera.stereo_depth]\nbaseline = 0.0\n"), "no disparity"},
      {camera("[camera.stereo_depth]\npreset = \"d453\"\n"), "d435"},
      {camera("[camera.stereo_depth]\nbaseline = 1\nmin_range = 3\nmax_range = 2\n"), "less than"},
      {camera("[camera.events]\nthreshold = 0\n"), "threshold"},
      {camera("[camera.thermal]\nmin = 400\nmax = 300\n"), "less than"},
      {"[[stereo]]\nbaseline = 0.1\n", "'name' is missing"},
      {"[[stereo]]\nname = \"a\"\nbaseline = -0.1\n", "baseline"},
      {"[[stereo]]\nname = \"a\"\n[[stereo]]\nname = \"a\"\n", "two stereo rigs"},
      {"[[rgbd]]\nname = \"a\"\nlook_at = [0, 0, 0]\n", "looks at its own position"},
      {"[[rgbd]]\nname = \"a\"\nlook_at = [1, 0, 0]\norientation = [1, 0, 0, 0]\n", "both"},
      {"[[sensor]]\nrate = 100\n", "'match' is missing"},
      {"[[sensor]]\nmatch = \"x\"\nrate = 0\n", "rate"},
      {"[[sensor]]\nmatch = \"x\"\nnoise = -1\n", "noise"},
      {"[[temperature]]\nemissivity = 2\n", "emissivity"},
  };
  for (const auto& [text, word] : cases) {
    const std::string said = message(text);
    EXPECT_NE(said.find(word), std::string::npos) << text << "\nsays: " << said;
    EXPECT_NE(said.find("a.toml:"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace gloam
