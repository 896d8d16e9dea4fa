// Rain, snow and haze of [weather] as sensors of a World meet them, whatever stands in the place.

#include <fmt/format.h>

#include <cmath>
#include <mutex>

#include "runtime/test/probe_rig.h"
#include "world/media/medium_description.h"
#include "world/weather/particle_set.h"

namespace gloam {
namespace {

const char* const kFloor = "<geom type='plane' size='0 0 1'/>";
const char* const kTarget = "<geom type='box' size='.1 10 10' pos='67.1 0 5'/>";
const char* const kTower = "<geom type='box' size='1 1 1.5' pos='-6 4 1.5'/>";

/// Signal of the wall 67 m ahead of a LiDAR.
double wall_signal(const std::string& weather, const std::string& bodies) {
  const TempFolder folder;
  const World world = probe_world(folder, R"(
[[lidar]]
name = "scan"
position = [0, 0, 2]
pattern = "raster"
rows = 1
columns = 16
field_of_view = [0.5, 0.5]
range_at_10_percent = 300
receiver_diameter = 0
intensity = "signal"
returns = "last"
noise = false
rate = 10
)" + weather,
                                  bodies);
  const auto simulation = simulate(world);
  std::mutex mutex;
  double sum = 0;
  size_t count = 0;
  auto stream =
      simulation->open_lidar({"scan", true}, [&](const std::shared_ptr<const LidarScan>& scan) {
        const std::lock_guard lock(mutex);
        for (size_t i = 0; i < scan->size(); ++i) {
          if (std::fabs(scan->range[i] - 67) > 0.5f) continue;
          sum += static_cast<double>(scan->intensity[i]);
          ++count;
        }
      });
  EXPECT_TRUE(stream.ok());
  EXPECT_TRUE(simulation->run_until(60).ok());
  stream->reset();
  EXPECT_GT(count, 0u);
  return sum / static_cast<double>(count);
}

TEST(WeatherExtent, ABoxDoesNotTakeTheRainAway) {
  const double clear = wall_signal("", std::string(kFloor) + kTarget);
  for (const double rate : {10.0, 50.0}) {
    const auto extinction = static_cast<double>(rain_particles(rate).extinction());
    const double law = std::exp(-2 * extinction * 67);
    for (const std::string tower : {"", kTower}) {
      const double wet = wall_signal(fmt::format("[weather]\nwetness = 0\nrain = {}\n", rate),
                                     kFloor + tower + kTarget);
      std::printf("%.0f mm/h%s: T2 = %.3f, law %.3f\n", rate, tower.empty() ? "" : ", a box",
                  wet / clear, law);
      // Bands of water differ a little from the geometric law of all large drops.
      EXPECT_NEAR(wet / clear / law, 1, 0.03);
    }
  }
}

/// Visibility [m] at heights over z = 0.
std::vector<double> visibility_at(const std::string& weather, const std::string& bodies,
                                  const std::vector<double>& heights) {
  std::string text = weather;
  std::vector<std::string> names;
  for (const double z : heights) {
    names.push_back(fmt::format("at{}", names.size()));
    text += fmt::format(
        "[[probe]]\nname = \"{}\"\nquantity = \"visibility\"\nposition = [30, 20, {}]\n",
        names.back(), z);
  }
  const TempFolder folder;
  std::vector<double> out;
  for (const auto& read : read_probes(probe_world(folder, text, bodies), names, 0.1))
    out.push_back(read.empty() ? -1 : read.back().values[0]);
  return out;
}

TEST(WeatherExtent, HazeThinsFromTheGroundAsItsScaleHeightSays) {
  const std::vector<double> heights = {0.2, 2, 8, 20};
  for (const std::string floor :
       {"<geom type='plane' size='0 0 1'/>", "<geom type='plane' size='400 400 1'/>",
        "<geom type='plane' size='50 50 1'/>"}) {
    for (const std::string tower : {"", kTower}) {
      const auto read =
          visibility_at("[weather]\nvisibility = 300\nmedium = \"haze\"\nscale_height = 10\n",
                        floor + tower, heights);
      for (size_t i = 0; i < heights.size(); ++i)
        EXPECT_NEAR(read[i] / (300 * std::exp(heights[i] / 10)), 1, 0.02) << floor << heights[i];
    }
  }
}

TEST(WeatherExtent, FogIsEvenWhateverStandsInIt) {
  for (const std::string tower : {"", kTower}) {
    const auto read = visibility_at("[weather]\nvisibility = 80\n", kFloor + tower, {0.5, 14});
    EXPECT_NEAR(read[0], 80, 0.1);
    EXPECT_NEAR(read[1], 80, 0.1);
  }
}

}  // namespace
}  // namespace gloam
