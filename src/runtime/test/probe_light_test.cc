// Probes of light at a place, and of what a camera makes of it.

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "runtime/test/probe_rig.h"
#include "world/world.h"

namespace gloam {
namespace {

// E = I cos / r² of a lamp of 100 cd, 3 m up.
TEST(LightProbes, IlluminanceIsThatOfALamp) {
  const TempFolder folder;
  const World world = probe_world(folder, R"(
[[light]]
name = "lamp"
type = "point"
position = [0, 0, 3]
intensity = 100
[[probe]]
name = "under"
quantity = "illuminance"
position = [0, 0, 1]
[[probe]]
name = "aside"
quantity = "illuminance"
position = [2, 0, 1]
[[probe]]
name = "tilted"
quantity = "illuminance"
position = [2, 0, 1]
normal = [-2, 0, 2]
[[probe]]
name = "below"
quantity = "illuminance"
position = [0, 0, 1]
normal = [0, 0, -1]
[[probe]]
name = "on_its_side"
quantity = "illuminance"
body = "box"
position = [0, 0, 0.2]
)",
                                  "<body name='box' pos='-2 0 1' euler='0 45 0'>"
                                  "<geom type='box' size='.1 .1 .1'/></body>");
  const auto read = read_probes(world, {"under", "aside", "tilted", "below", "on_its_side"}, 0.1);
  const auto last = [&](size_t i) { return read[i].back().values[0]; };
  EXPECT_NEAR(last(0), 25, 0.25);
  EXPECT_NEAR(last(1), 100 / 8.0 * std::sqrt(0.5), 0.1);
  EXPECT_NEAR(last(2), 100 / 8.0, 0.13);
  EXPECT_NEAR(last(3), 0, 1e-6);
  // Its +Z points at the lamp, from 0.2 m nearer.
  const double r = std::sqrt(8.0) - 0.2;
  EXPECT_NEAR(last(4), 100 / (r * r), 0.15);
}

const char* const kSun = R"(
[sky]
sun_elevation = 30
sun_azimuth = 180
[[camera]]
name = "south"
position = [0, 0, 1]
look_at = [0, -5, 1]
fovy = 90
width = 300
height = 200
[[camera]]
name = "north"
position = [0, 0, 1]
look_at = [0, 5, 1]
[[probe]]
name = "sun"
quantity = "sun_disc"
camera = "south"
[[probe]]
name = "behind"
quantity = "sun_disc"
camera = "north"
)";

std::vector<double> sun_seen(const std::string& bodies, const std::string& probe = "sun") {
  const TempFolder folder;
  return read_probe(probe_world(folder, kSun, bodies), probe, 0.1).back().values;
}

TEST(LightProbes, TheSunsDiscIsWhereALensSeesIt) {
  // 100 px are a focal length: 30° up from the middle.
  const double v = 100 - 100 * std::tan(30 * M_PI / 180);
  const std::vector<double> open = sun_seen("");
  EXPECT_NEAR(open[0], 150, 1e-3);
  EXPECT_NEAR(open[1], v, 0.01);
  EXPECT_EQ(open[2], 1);
  EXPECT_EQ(open[3], 1);
  const std::vector<double> behind = sun_seen("", "behind");
  EXPECT_TRUE(std::isnan(behind[0]));
  EXPECT_EQ(behind[2], 0);
  EXPECT_EQ(behind[3], 0);
}

// A wall 40 m away whose top edge runs through the middle of the disc, and one that hides all.
TEST(LightProbes, AWallHidesWhatItCoversOfTheSun) {
  const auto wall = [](double top) {
    return fmt::format("<geom type='box' size='40 .01 {}' pos='0 -40.01 {}'/>", top / 2, top / 2);
  };
  const double edge = 1 + 40 * std::tan(30 * M_PI / 180);
  const std::vector<double> half = sun_seen(wall(edge));
  EXPECT_EQ(half[2], 1) << "it is in the picture";
  EXPECT_NEAR(half[3], 0.5, 0.03);
  EXPECT_EQ(sun_seen(wall(edge + 1))[3], 0);
  EXPECT_EQ(sun_seen(wall(edge - 1))[3], 1);
}

// A lamp of a hundredfold light goes on after a quarter of a second.
TEST(LightProbes, ExposureIsWhatPicturesAreShownWith) {
  const TempFolder folder;
  const World world = probe_world(folder, R"(
[[camera]]
name = "auto"
position = [0, -2, 1]
look_at = [0, 0, 1]
rate = 25
width = 32
height = 24
[camera.imager.auto_exposure]
time_constant = 0.2
max_shutter = 0.01
max_iso = 6400
[[camera]]
name = "fixed"
position = [0, -2, 1]
look_at = [0, 0, 1]
imager.exposure = { f_number = 4, shutter = 0.01, iso = 200 }
[[light]]
name = "lamp"
type = "point"
position = [0, -1, 2]
intensity = 2000
[light.schedule]
keys = [ { time = 0, level = 0.01 }, { time = 0.25, level = 0.01 }, { time = 0.251, level = 1 } ]
[[probe]]
name = "ev"
quantity = "exposure"
camera = "auto"
rate = 25
[[probe]]
name = "own"
quantity = "exposure"
camera = "fixed"
)",
                                  "<geom type='box' size='3 .1 3' pos='0 .1 0'/>");
  auto simulation = simulate(world);
  std::map<int64_t, double> shown, read;
  double own = 0;
  CameraRequest request;
  request.camera = "auto";
  request.outputs = {"rgb"};
  request.render = {.tier = RenderTier::kDirect, .spp = 1, .denoise = false};
  request.required = true;
  auto camera = simulation->open_camera(
      request, [&](const std::shared_ptr<const CameraFrame>& f) { shown[f->step] = f->ev100; });
  auto probe = simulation->open_sensor(
      {"ev", true}, [&](const SensorMessage& m) { read[m.step] = m.values.at(0); });
  auto fixed =
      simulation->open_sensor({"own", true}, [&](const SensorMessage& m) { own = m.values.at(0); });
  ASSERT_TRUE(camera.ok() && probe.ok() && fixed.ok());
  ASSERT_TRUE(simulation->run_until(300).ok());
  (*camera)->flush();
  (*probe)->flush();
  (*fixed)->flush();
  ASSERT_EQ(read.size(), 16u);
  for (const auto& [step, ev100] : shown) EXPECT_EQ(read.at(step), ev100) << step;
  EXPECT_GE(shown.size(), 15u);
  EXPECT_GT(read.at(300) - read.at(100), 2) << "the lamp";
  EXPECT_DOUBLE_EQ(own, std::log2(16 / 0.01 * 100 / 200));
}

}  // namespace
}  // namespace gloam
